#!/usr/bin/env bash
# diagnose_cases.sh CALENDEM WORK [CASE ...]: every case (or those named) as a change from `before`; WORK/results.csv has
# name,cause,amount,claim,answer. Two cases at a time; half a minute each.
set -euo pipefail
calendem=$1 work=$2
shift 2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
mkdir -p "$work"
cp "$here/../bank/electrode.toml" "$work/electrode.toml"
experiment() { # name t80 p80 t150 p150: its experiment file
  cat <<TOML
[experiment]
name = "$1"
electrode = "electrode.toml"
measured_on = "simulation"
sample_diameter_mm = 0.011284
TOML
  local pressure=80 thickness=$2 porosity=$3
  for _ in 1 2; do
    cp "$here/curves/${1}_$pressure.csv" "$work/"
    cat <<TOML

[[condition]]
id = "p$pressure"
control = "pressure"
max_pressure_MPa = { value = $pressure, sd_relative = 0.02 }
thickness_at_max_um = { value = $thickness, sd = 0.2 }
porosity_after_percent = { value = $porosity, sd = 0.4 }
curve = "${1}_$pressure.csv"
curve_sd_um = 0.05
TOML
    pressure=150 thickness=$4 porosity=$5
  done
}
diagnose() { # name
  "$calendem" diagnose "$work/$1.toml" --before "$work/before.toml" --bank "$here/../bank/bank.toml" --no-rerun --jobs 1 \
    -o "$work/$1" >"$work/$1.log" 2>&1 || { cat "$work/$1.log" >&2; return 1; }
}
mapfile -t rows < <(tail -n +2 "$here/cases.csv")
names=()
for row in "${rows[@]}"; do
  IFS=, read -r name cause amount t80 p80 t150 p150 _ <<<"$row"
  experiment "$name" "$t80" "$p80" "$t150" "$p150" >"$work/$name.toml"
  [ "$name" = before ] && continue
  [ $# -eq 0 ] || [[ " $* " == *" $name "* ]] || continue
  names+=("$name,$cause,$amount")
done
running=()
for case in "${names[@]}"; do
  diagnose "${case%%,*}" &
  running+=($!)
  [ "${#running[@]}" -lt 2 ] || { wait "${running[0]}"; running=("${running[@]:1}"); }
done
for pid in "${running[@]}"; do wait "$pid"; done
word_of() { sed -n "s/^ *\"$2\": \"\(.*\)\",\{0,1\}$/\1/p" "$work/$1/gap.json" | head -1; }
echo "name,cause,amount,claim,answer" >"$work/results.csv"
for case in "${names[@]}"; do
  name=${case%%,*}
  echo "$case,$(word_of "$name" claim),$(word_of "$name" answer)" >>"$work/results.csv"
done
