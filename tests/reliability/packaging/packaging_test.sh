#!/usr/bin/env bash
# packaging_test.sh installed|copied_clone|deb BUILD: one case; prefix PREFIX: of what is installed there. Exit status 0 passed, 1 failed, 77 skipped.
set -euo pipefail
case=$1 build=$2
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
packaging=$top/tools/packaging
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if [ "$(id -u)" -eq 0 ]; then export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; fi
fail() { echo "FAILED: $*"; exit 1; }
has() { command -v "$1" >/dev/null; }

# The small case from a copy of the installed example, with nothing else: bin/ and share/ in PREFIX.
runs_from() { # PREFIX
  local version calendem=$1/bin/calendem examples=$1/share/calendem/input_scripts/cases
  version=$(sed -n 's/^project(Calendem VERSION \([0-9.]*\).*/\1/p' "$top/CMakeLists.txt")
  [ "$("$calendem" --version)" = "$version" ] || fail "--version is not $version"
  for program in "$1"/bin/*; do [ -d "$program" ] || ! grep -qF "$top/" "$program" || fail "$program names the source tree"; done
  "$calendem" validate "$examples"/demo/*.toml "$examples"/small/*.toml || fail "the installed examples are not valid"
  cp -r "$examples/small" "$work/small"
  cd "$work/small"
  "$calendem" pack electrode.toml -o electrode --ranks 1
  "$calendem" run case.toml -o out --ranks 1
  "$calendem" report out
  awk -F, 'NR > 1 && $0 ~ /[0-9]/ { n++ } END { exit !(n > 20) }' out/curve.csv || fail "curve.csv has too few rows"
  grep -qF "include $1/share/calendem/input_scripts/in.compression" out/log.liggghts ||
    fail "the run did not use the installed scripts"
  ! grep -lrF "$top/" out || fail "these files name the source tree"
}
case $case in
  prefix) runs_from "$build" ;;
  installed)
    cmake --install "$build" --prefix "$work/prefix" >"$work/install.log" || { cat "$work/install.log"; exit 1; }
    mv "$work/prefix" "$work/moved" # an installation may be moved
    runs_from "$work/moved" ;;
  copied_clone) # a built clone that is moved or copied uses its own scripts, not those of the first
    mkdir -p "$work/clone/build"
    cp -r "$build/share" "$work/clone/build"
    cp -r "$top/input_scripts" "$work/clone"
    install -D "$build/bin/calendem" "$work/clone/build/bin/calendem"
    "$work/clone/build/bin/calendem" --help | grep -F "$work/clone/input_scripts/cases" || fail "a copy uses the scripts of $top" ;;
  deb)
    [ "${CALENDEM_HEAVY:-0}" = 1 ] || { echo "skipped: packaging.deb runs with tools/test --all"; exit 77; }
    for tool in dpkg-deb dpkg-shlibdeps file; do has $tool || { echo "skipped: no $tool"; exit 77; }; done
    "$packaging/make-deb" --no-install-dependencies | tee "$work/log"
    deb=$(tail -n 1 "$work/log")
    dpkg-deb --field "$deb" Depends | tee "$work/depends"
    for package in openmpi-bin libvtk9 libopenmpi libfmt libnlopt libssl libtiff libinsighttoolkit; do
      grep -q "$package" "$work/depends" || fail "the package does not depend on $package"
    done
    dpkg-deb --extract "$deb" "$work/root"
    [ ! -e "$work/root/usr/bin/liggghts" ] || fail "usr/bin/liggghts belongs to Debian's package of that name"
    ! grep -q -e -march=native "$top/build/package/compile_commands.json" || fail "the package is tuned for this machine"
    runs_from "$work/root/usr" ;;
esac
