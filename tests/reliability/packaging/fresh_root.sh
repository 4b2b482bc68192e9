#!/usr/bin/env bash
# fresh_root.sh RELEASE: the Debian package on an empty Debian of this release (bookworm, trixie), made by debootstrap
# from the mirror that apt has here: it is installed with what it depends on, and packs, runs and reports the small case.
# The package of another release than this machine's is made on an empty one, too. Needs root, and 2 GB in TMPDIR or
# /tmp, 6 GB to make the package. Runs with CALENDEM_HEAVY=1. Exit status 0 passed, 1 failed, 77 skipped.
set -euo pipefail
release=$1
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
top=$(cd "$here/../../.." && pwd)
skip() { echo "skipped: $*"; exit 77; }
[ "${CALENDEM_HEAVY:-0}" = 1 ] || skip "packaging.fresh_$release runs with tools/test --all"
[ "$(id -u)" -eq 0 ] || skip "only root can make another root"
for tool in debootstrap dpkg-deb dpkg-shlibdeps file; do command -v $tool >/dev/null || skip "no $tool"; done
unshare --mount --pid --fork true 2>/dev/null || skip "no right to mount"
own=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)
# shellcheck disable=SC2016 # a field of apt's
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' "Codename: $own" 'Component: main' | sed -n 1p)
[ -n "$mirror" ] || skip "apt has no mirror here"
if [ -z "${CALENDEM_FRESH_ROOT:-}" ]; then # all that follows in namespaces: nothing stays mounted or goes on when this ends
  CALENDEM_FRESH_ROOT=$(mktemp -d)
  export CALENDEM_FRESH_ROOT
  unshare --mount --pid --fork --kill-child --mount-proc bash "${BASH_SOURCE[0]}" "$release" </dev/null &
  inner=$!
  trap 'kill -KILL $inner 2>/dev/null || true; rm -rf "$CALENDEM_FRESH_ROOT"' EXIT
  trap 'exit 1' INT TERM
  wait $inner
  exit
fi
work=$CALENDEM_FRESH_ROOT

stage() { # NAME COMMAND...
  local begin=$SECONDS
  echo "== $1, load $(cut -d' ' -f1 /proc/loadavg)"
  "${@:2}" >"$work/log" 2>&1 || { tail -n 30 "$work/log"; echo "FAILED: $1"; exit 1; }
  echo "   $((SECONDS - begin)) s"
}
# The source tree is at its own path in it, to be read.
in_root() { # ROOT SCRIPT
  # shellcheck disable=SC2016 # expanded by the shell inside
  unshare --mount bash -euc 'root=$1 top=$2
    mkdir -p "$root$top"
    mount --bind "$top" "$root$top"
    mount -o remount,bind,ro "$root$top"
    mount -t proc proc "$root/proc"
    mount -t tmpfs tmpfs "$root/dev/shm"
    exec chroot "$root" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
      bash -euc "$3"' - "$1" "$top" "$2"
}
make_package() { # in a copy of the tree, by the root's own compiler
  cp -a "$work/fresh" "$work/builder"
  mkdir "$work/builder/src"
  tar -C "$top" --exclude='./build*' --exclude=./.git -c . | tar -C "$work/builder/src" -x
  in_root "$work/builder" /src/tools/packaging/make-deb
  mv "$work"/builder/src/build/package/calendem_*.deb "$work"
  rm -rf "$work/builder"
}
make_package_here() {
  "$top/tools/packaging/make-deb" --no-install-dependencies
  cp "$top"/build/package/calendem_*.deb "$work"
}

echo "== an empty $release"
if ! debootstrap --variant=minbase "$release" "$work/fresh" "$mirror" >"$work/log" 2>&1; then
  tail -n 3 "$work/log"
  ! grep -qE 'E: (Failed getting release file|No such script)' "$work/log" || skip "no $release for debootstrap"
  echo "FAILED: an empty $release"
  exit 1
fi
if [ "$release" = "$own" ]; then stage "the package" make_package_here
else stage "the package, on an empty $release" make_package; fi
mv "$work"/calendem_*.deb "$work/fresh/calendem.deb"
stage "installed" in_root "$work/fresh" 'apt-get update && apt-get -o Dpkg::Use-Pty=0 install -y --no-install-recommends /calendem.deb'
stage "the small case" in_root "$work/fresh" "bash '$here/packaging_test.sh' prefix /usr"
tail -n 5 "$work/log"
