#!/usr/bin/env bash
# half_speed.sh BIN WORK: the demo's electrode at its speed, once more with one coordinate moved by
# 1e-12 um (the noise floor), and at half the speed. Runs with CALENDEM_HEAVY=1.
set -euo pipefail
bin=$1 work=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
scripts=$(cd "$here/../../../input_scripts" && pwd)
[ "${CALENDEM_HEAVY:-0}" = 1 ] || { echo "skipped: quasi_static.half_speed runs with tools/test --all"; exit 77; }
fail() { echo "FAILED: $*" >&2; exit 1; }
rms() { awk -v above=5 -v window=0.5 -f "$here/rms_difference.awk" "$work/full/curve.csv" "$work/$1/curve.csv"; }

mkdir -p "$work"
"$bin/calendem" pack "$scripts/cases/studies/electrode.toml" -o "$work/electrode" --force
rm -rf "$work/moved_electrode"
cp -r "$work/electrode" "$work/moved_electrode"
awk '/^Atoms/ { atoms = 1 } atoms && $1 == 1 && NF == 7 { $5 = sprintf("%.17g", $5 + 1e-12) } { print }' \
  "$work/electrode/electrode.data" >"$work/moved_electrode/electrode.data"
cmp -s "$work/electrode/electrode.data" "$work/moved_electrode/electrode.data" && fail "nothing was moved"
printf 'electrode = "electrode"\n[platen]\nmax_pressure_MPa = 150\n' >"$work/full.toml"
printf 'electrode = "moved_electrode"\n[platen]\nmax_pressure_MPa = 150\n' >"$work/moved.toml"
printf 'electrode = "electrode"\n[platen]\nmax_pressure_MPa = 150\nspeed_m_s = 0.5\ntouch_speed_m_s = 0.5\n' \
  >"$work/half.toml"
for name in full moved half; do
  "$bin/calendem" run "$work/$name.toml" -o "$work/$name" --ranks 1 --force &
done
wait
noise=$(rms moved) half=$(rms half)
echo "noise floor: $noise"
echo "half speed:  $half"
# The points of a jagged curve hang together over about 2 um, so some 8 of them are independent: the 97.5 %
# point of F(8, 8) is 4.43, the ratio of two root mean squares of the same noise stays below its root.
awk -v a="${half%% *}" -v b="${noise%% *}" 'BEGIN { exit !(a <= 2.1 * b) }' ||
  fail "halving the speed changes the curve by more than its noise"
