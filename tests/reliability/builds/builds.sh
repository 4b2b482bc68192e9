#!/usr/bin/env bash
# builds.sh sanitize|portable|second_source WORK: the suite on another build of a copy of the tree. Runs with
# CALENDEM_HEAVY=1; second_source also needs CALENDEM_SECOND_SOURCE, a tree of the public git HEAD.
set -euo pipefail
case=$1 work=$2
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
[ "${CALENDEM_HEAVY:-0}" = 1 ] || { echo "skipped: builds.$case runs with tools/test --all"; exit 77; }
unset CALENDEM_HEAVY
options=(--no-install-dependencies)
case $case in
  sanitize) options+=(--sanitize) ;;
  portable) options+=(--portable) ;;
  second_source)
    [ -n "${CALENDEM_SECOND_SOURCE:-}" ] ||
      { echo "skipped: no second host source; give its folder as CALENDEM_SECOND_SOURCE"; exit 77; }
    options+=(--source "$CALENDEM_SECOND_SOURCE") ;;
esac
rm -rf "$work"
mkdir -p "$work"
(cd "$top" && git ls-files -z --cached --others --exclude-standard | tar --null -cf - -T -) | tar -xf - -C "$work"
"$work/tools/test" "${options[@]}" -L 'unit|verification|regression' -E paraview
[ "$case" != sanitize ] || # also beside the host's styles, between runs and at their ends; undefined behaviour ends a run
  UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1 "$work/tools/test" "${options[@]}" \
    -R '^(host_styles|between_runs|lost_bonds|same_physics)\.'
