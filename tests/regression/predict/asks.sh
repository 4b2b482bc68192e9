#!/usr/bin/env bash
# asks.sh BIN CASES WORK [ASKS]: design asked about materials that it cannot see. For each ask a material, in which each of
# the bank's effects acts or does not, and three films are drawn; two films are pressed in the simulation, three pressures
# each, and serve as measurements; `design` chooses a pressure, then a gap, for a porosity of the third; that film is
# pressed to the one and rolled to the other, on three other packings. All hits together are beside the mean probability
# that was stated; the hits of each ask beside the probability that was assured of it, which four of five materials are to
# reach. Three films show thirds only: an ask of which 0.6 is assured passes with two hits of three, as
# it does at a true 0.5 half of the time. Runs with CALENDEM_HEAVY=1: some 12 runs of 10 to 20 s for each of 20 asks.
set -euo pipefail
bin=$1 cases=$2 work=$3 asks=${4:-20}
[ "${CALENDEM_HEAVY:-0}" = 1 ] || { echo "skipped: predict.asks runs with tools/test --all"; exit 77; }
fail() { echo "FAILED: $*" >&2; exit 1; }
rm -rf "$work"
mkdir -p "$work"
cd "$work"
cp "$cases/films/electrode.toml" .
cat >case.toml <<'END'
# As the bank's runs, to one pressure.
electrode = "of the bank"
[platen]
max_pressure_MPa = 150
touch_speed_m_s = 8
speed_m_s = 8
release_speed_m_s = 8
[effects.cbd_plasticity]
beyond_cohesion = 1
[output]
vtk_every_us = 1000
restart_every_us = 1000
END
within=1.5 # points of porosity, one and a half standard deviations of one packing of so small a cell

# number E_cbd,yield_cbd,strength,friction,collapse porosity_A carbon_A porosity_B carbon_B porosity_C carbon_C
# target; an effect's key within the bank's range, or what switches it off
awk -v n="$asks" 'BEGIN { srand(20)
  for (k = 1; k <= n; ++k) {
    material = sprintf("%.4g,%.4g,%.4g,%.4g,%.4g", 1.6 * 2.5 ^ rand(), 0.12 * 4.1 ^ rand(), 400 * (1500 / 400) ^ rand(),
      rand() < 0.8 ? 0.05 + 0.55 * rand() : 0.001, rand() < 0.2 ? 5 * 60 ^ rand() : 0)
    printf "%d %s %.4g %.4g %.4g %.4g %.4g %.4g %.4g\n", k, material, 42 + 9 * rand(), 1.5 + 2 * rand(), 42 + 9 * rand(),
      1.5 + 2 * rand(), 42 + 9 * rand(), 1.5 + 2 * rand(), 0.66 + 0.16 * rand() } }' >asks.txt # the target is a share of the porosity before

study() { # NAME ROWS CONTROL KEY: a study of rows "material porosity carbon KEY seed"
  {
    printf '[study]\nname = "%s"\nrecipe = "electrode.toml"\ncase = "case.toml"\nkeep = "tables"\n' "$1"
    printf '[[vary]]\nkeys = ["case.material.cbd.youngs_modulus_GPa", "case.effects.cbd_plasticity.yield_pressure_GPa", '
    printf '"case.bond.tensile_strength_MPa", "case.bond.shear_strength_MPa", '
    printf '"case.material.am.friction", "case.material.cbd.friction", "case.effects.cbd_collapse.yield_pressure_MPa", '
    printf '"recipe.coating.porosity_total_percent", '
    printf '"recipe.composition.carbon_weight_percent", "recipe.composition.binder_weight_percent", '
    printf '"case.platen.%s", "recipe.seed", "case.platen.control"]\nvalues = [\n' "$4"
    awk -v control="$3" '{ split($1, m, ",")
      print "[" m[1] ", " m[2] ", " m[3] ", " m[3] ", " m[4] ", " m[4] ", " m[5] ", " $2 ", " $3 ", " $3 ", " $4 ", " $5 ", \"" control "\"]," }' "$2"
    echo ']'
  } >"$1.toml"
  local status=0
  "$bin/calendem" study "$1.toml" -o "$1" --jobs "$(nproc)" >"$1.log" 2>&1 || status=$?
  case $status in 0 | 3 | 4) ;; *) tail "$1.log"; fail "study $1" ;; esac # 3: some runs stopped; 4: a packing failed its checks
}
# Prints from study.csv the porosity after relaxation of each run, percent; - of one that stopped, as where the packing jams: it is
# no reading, and no hit.
porosities() {
  awk -F, 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k == "porosity_after_relaxation") at = k; next }
    { print $at == "" ? "-" : 100 * $at }' "$1/study.csv"
}

while read -r k material pa ca pb cb _; do
  for p in 30 80 200; do
    echo "$material $pa $ca $p $((1000 + k))"
    echo "$material $pb $cb $p $((2000 + k))"
  done
done <asks.txt >measured.txt
study measured measured.txt pressure max_pressure_MPa
porosities measured | awk '$1 == "-" { ++n } END { exit n > NR / 10 }' || fail "more than a tenth of the measured runs stopped"
porosities measured | paste -d' ' measured.txt - >readings.txt

film() { # NAME POROSITY CARBON
  sed "s/^porosity_total_percent.*/porosity_total_percent = $2/; s/^name.*/name = \"$1\"/" electrode.toml
  printf '\n[composition]\ncarbon_weight_percent = %s\nbinder_weight_percent = %s\n' "$3" "$3"
}
while read -r k _ pa ca pb cb pc cc target; do
  mkdir -p "ask$k"
  film "film a" "$pa" "$ca" >"ask$k/a.toml"
  film "film b" "$pb" "$cb" >"ask$k/b.toml"
  film "film c" "$pc" "$cc" >"ask$k/c.toml"
  for f in a b; do
    printf '[experiment]\nname = "film %s"\nelectrode = "%s.toml"\n' $f $f
    awk -v from=$((6 * (k - 1))) -v second="$([ $f = a ] && echo 1 || echo 0)" 'NR > from && NR <= from + 6 && NR % 2 == second && $6 != "-" {
      printf "[[condition]]\nid = \"p%d\"\ncontrol = \"pressure\"\nmax_pressure_MPa = { value = %g, sd_relative = 0.01 }\nporosity_after_percent = { value = %.3f, sd = 0.6 }\n", $4, $4, $6 }' readings.txt
  done >"ask$k/both.txt"
  csplit -s -f "ask$k/part" "ask$k/both.txt" '/name = "film b"/-1'
  mv "ask$k/part00" "ask$k/a_measured.toml"
  mv "ask$k/part01" "ask$k/b_measured.toml"
  known=() # a film whose packing jams has no readings
  for f in a b; do
    if grep -q '^\[\[condition' "ask$k/${f}_measured.toml"; then known+=("ask$k/${f}_measured.toml"); fi
  done
  "$bin/calendem" calibrate "${known[@]}" -o "ask$k/model" \
    --bank "$cases/films/bank.toml" >"ask$k/log" || fail "calibrate, ask $k"
  wanted=$(awk -v a="$pc" -v b="$target" 'BEGIN { print a * b }')
  "$bin/calendem" design "ask$k/model/model.json" "ask$k/c.toml" -o "ask$k/design" --within $within --porosity "$wanted" \
    >>"ask$k/log" || fail "design, ask $k"
  # Between 12 % over the thickness without pores (6 mg/cm2 of 4.65 and 1.83 g/cm3) and 3 % under that before pressing.
  gaps=$(awk -v p="$pc" -v c="$cc" 'BEGIN { s = 60 * ((1 - 0.02 * c) / 4.65 + 0.02 * c / 1.83); printf "%.1f:%.1f", s * 1.12, s / (1 - p / 100) * 0.97 }')
  "$bin/calendem" design "ask$k/model/model.json" "ask$k/c.toml" -o "ask$k/gap" --within $within --porosity "$wanted" \
    --gap "$gaps" >"ask$k/gap.log" || fail "design --gap, ask $k"
done <asks.txt

# As a study's name, the key that is chosen, its unit in what design says, and what it said: the third film of each ask is
# pressed, and hits are counted. If design says that nothing meets the target, that is 0 %. Hits are binomial with the stated
# probabilities, the three packings of one ask alike at the worst.
outcome() { # NAME CONTROL KEY UNIT LOG
  while read -r k material _ _ _ _ pc cc target; do
    read -r at stated assured < <(sed -n \
      -e "s/^film c: \([0-9.]*\) $4 meets the target with \([0-9]*\) % (with \([0-9]*\) % or more for .*/\1 \2 \3/p" \
      -e "s/^film c: no .* meets the target (less than 1 %); at \([0-9.]*\) $4: .*/\1 0 0/p" "ask$k/$5") ||
      fail "ask $k: design says nothing"
    for seed in 1 2 3; do
      echo "$material $pc $cc $at $((3000 + 10 * k + seed)) $stated $(awk -v a="$pc" -v b="$target" 'BEGIN { print a * b }') $assured"
    done
  done <asks.txt >"chosen_$1.txt"
  study "$1" "chosen_$1.txt" "$2" "$3"
  porosities "$1" | paste -d' ' "chosen_$1.txt" - >"outcome_$1.txt"
  awk -v within=$within -v what="$1" '{ hit = ($9 != "-" && $9 - $7 <= within && $7 - $9 <= within); hits += hit; stated += $6 / 100; variance += 3 * $6 / 100 * (1 - $6 / 100); ++n
      of[int((NR - 1) / 3)] += hit; mean[int((NR - 1) / 3)] = $6 / 100; least[int((NR - 1) / 3)] = $8 / 100; assured += $8 / 100 }
    END { for (k in of) { met += of[k] / 3 >= least[k] - 1e-9; mean_met += of[k] / 3 >= mean[k] - 1e-9 }
      printf "%s: %d asks, %d films pressed: %.0f %% met the target, %.0f %% were promised (standard deviation at most %.0f), %.0f %% were assured\n",
        what, n / 3, n, 100 * hits / n, 100 * stated / n, 100 * sqrt(variance) / n, 100 * assured / n
      printf "%d asks have as many hits among their three films as was assured of them or more, %d as many as was promised\n", met, mean_met
      exit (hits < stated - 2.6 * sqrt(variance)) }' "outcome_$1.txt" || fail "$1: fewer hits than promised"
}
outcome by_pressure pressure max_pressure_MPa MPa log
outcome by_gap roll_gap roll_gap_um um gap.log
