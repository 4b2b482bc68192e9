#!/usr/bin/env bash
# fuzz.sh TARGET WORK [SECONDS]: libFuzzer with address and undefined-behaviour sanitizers on one reader (see
# CMakeLists.txt), from the corpus kept here; what it finds is left in WORK/TARGET. fuzz.sh build WORK comes first: it
# makes WORK/readers, which has all readers but that of label images. That one goes on into VTK, whose own code is not
# instrumented: only what ends the process shows. Runs with CALENDEM_HEAVY=1.
set -euo pipefail
target=$1 seconds=${3:-60}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
core=$(cd "$here/../../../tools/calendem" && pwd)
mkdir -p "$2"
work=$(cd "$2" && pwd)
cd "$core"
# The readers, and what they are linked with: whole parts of the program, and single files of others.
parts=(base effects electrode)
sources=(press/press_{export,curve}.cpp simulate/study_file.cpp bank/{bank_file,design,runs}.cpp
  inference/{numerics,quantities}.cpp)
image_sources=(electrode/structure/{data_rows,image_header,label_image,numpy_image,png_image,tiff_image,vti_header}.cpp
  base/{image_series,messages,provenance}.cpp)
for source in "${parts[@]}" "${sources[@]}" "${image_sources[@]}"; do # said by every run of the tests, not only by --all
  [ -e "$source" ] || { echo "FAILED: $core/$source, which is to be built here, is not there" >&2; exit 1; }
done
[ "${CALENDEM_HEAVY:-0}" = 1 ] || { echo "skipped: fuzz.$target runs with tools/test --all"; exit 77; }
command -v clang++ >/dev/null || { echo "skipped: no clang++ (Debian: clang, libclang-rt-14-dev)"; exit 77; }
# -fno-sanitize=unreachable: toml++ states what it assumes with __builtin_unreachable, which UBSan takes for a fault.
options=(-std=c++17 -g -O1 -DNDEBUG "-fsanitize=fuzzer,address,undefined" -fno-sanitize=unreachable
  -fno-sanitize-recover=undefined -DCALENDEM_VERSION='"fuzz"'
  -I "$core" -I "$core/../../src_plugin" -I /usr/include/eigen3)

vtk=$(find /usr/include -maxdepth 1 -name 'vtk-9*' | head -n 1) # the Debian package; its suffix is that of the libraries
[ -n "$vtk" ] || { echo "skipped: no headers of VTK in /usr/include"; exit 77; }
itk=$(find /usr/include -maxdepth 1 -name 'ITK-5*' | head -n 1)
[ -n "$itk" ] || { echo "skipped: no headers of ITK in /usr/include"; exit 77; }
# ITK's templates add offsets to null pointers, which UBSan takes for a fault of the reader that has them.
printf '[undefined]\nsrc:%s/*\n' "$itk" >"$work/of_others"
options+=(-isystem "$vtk" -isystem "$itk" "-fsanitize-ignorelist=$work/of_others")
libraries=("-lITKCommon${itk##*/ITK}" "-litkvnl${itk##*/ITK}" "-litkvnl_algo${itk##*/ITK}" "-litksys${itk##*/ITK}" -lfmt -lcrypto -lz -ltiff -lpng -lminizip)
for name in IOImage IOXML ImagingMorphological ImagingGeneral FiltersCore CommonExecutionModel CommonDataModel CommonMath CommonMisc \
  CommonCore sys; do
  libraries+=("-lvtk$name${vtk##*/vtk}")
done

build_readers() {
  local part source size all objects=()
  rm -rf "$work/objects"
  mkdir -p "$work/objects"
  for part in "${parts[@]}"; do # in batches, as the program is built (tools/calendem/CMakeLists.txt)
    mapfile -t all < <(find "$part" -name '*.cpp' | LC_ALL=C sort)
    size=$(((${#all[@]} - 1) / ((${#all[@]} + 16) / 17) + 1))
    printf '#include "%s"\n' "${all[@]}" | split -l "$size" -d --additional-suffix=.cpp - "$work/objects/${part}_"
  done
  for source in "$work/objects"/*.cpp "${sources[@]}" "$here/fuzz_target.cpp"; do
    while [ "$(jobs -rp | wc -l)" -ge "$(nproc)" ]; do wait -n; done
    objects+=("$work/objects/${source//\//_}.o")
    clang++ "${options[@]}" -c "$source" -o "${objects[-1]}" &
  done
  wait
  for source in "${objects[@]}"; do [ -f "$source" ] || exit 1; done # the compiler has said why
  clang++ "${options[@]}" "${objects[@]}" "${libraries[@]}" -lnlopt -o "$work/readers"
}
build_label_image() {
  clang++ "${options[@]}" "$here/fuzz_image.cpp" "${image_sources[@]}" "${libraries[@]}" -o "$work/label_image_reader"
}
program=$work/readers
case $target in
  build) build_readers; exit ;;
  label_image) build_label_image; program=$work/label_image_reader ;;
esac
mkdir -p "$work/$target/corpus"
cd "$work/$target"
cp "$here/corpus/${target%_}"/* corpus/
FUZZ_FOLDER=$(mktemp -d -p /dev/shm calendem_fuzz.XXXXXX)
export FUZZ_FOLDER FUZZ_TARGET=$target FUZZ_BANK=$core/../../input_scripts/cases/films/bank.toml
trap 'rm -rf "$FUZZ_FOLDER"' EXIT
"$program" -max_total_time="$seconds" -max_len=8192 -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 corpus \
  >"$target.log" 2>&1 ||
  { tail -n 40 "$target.log"; echo "FAILED: the input that did it is in $work/$target" >&2; exit 1; }
grep -E 'number_of_executed_units|new_units_added' "$target.log"
