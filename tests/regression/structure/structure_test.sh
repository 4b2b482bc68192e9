#!/usr/bin/env bash
# One case of measured shapes and existing structures on a small cell: structure_test.sh CASE BIN WORK
set -euo pipefail
case=$1 bin=$2 work=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if [ "$(id -u)" -eq 0 ]; then export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; fi
fail() { echo "FAILED: $*" >&2; exit 1; }

mkdir -p "$work"
cp "$here"/*.toml "$work/"
case $case in
  image_to_electrode) # tomogram -> shapes -> electrode; the library alone gives the same electrode
    "$bin/calendem" tomogram "$work/tomogram.toml" -o "$work/image.mhd"
    "$bin/calendem" validate "$work/electrode.toml"
    rm -rf "$work/from_image" "$work/from_library"
    "$bin/calendem" pack "$work/electrode.toml" -o "$work/from_image" --ranks 1
    sed 's|^image = .*|library = "from_image/shapes"|' "$work/electrode.toml" >"$work/library.toml"
    "$bin/calendem" pack "$work/library.toml" -o "$work/from_library" --ranks 1
    cmp "$work/from_image/electrode.data" "$work/from_library/electrode.data" ||
      fail "image and library gave different electrodes"
    grep -q '"D50"' "$work/from_image/electrode.json" || fail "no measured sizes in electrode.json" ;;
esac
