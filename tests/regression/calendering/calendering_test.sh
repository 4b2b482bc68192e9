#!/usr/bin/env bash
# One case of the calendering path on a small cell: calendering_test.sh CASE BIN WORK
set -euo pipefail
case=$1 bin=$2 work=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
scripts=$(cd "$here/../../../input_scripts" && pwd)
if [ "$(id -u)" -eq 0 ]; then export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; fi
fail() { echo "FAILED: $*" >&2; exit 1; }
number() { sed -n "s/^ *\"$1\": \([-+0-9.e]*\),*$/\1/p" "$2"; } # of a summary
rows() { sed -n '/^[0-9]/p' "$1"; }
holds() { awk "BEGIN { exit !($1) }" || fail "$2"; }
plain() { # SCRIPT DIR: the input scripts without the command line tool, with the run's settings
  mkdir -p "$2/vtk"
  mpirun -np 1 "$bin/liggghts" -in "$scripts/$1" -log "$2/log.liggghts" -var scripts "$scripts" \
    -var electrode "$work/electrode" -var out "$2" -var sigma_c_MPa 200 -var tau_c_MPa 200 \
    -var p_max_MPa 40 -var speed_m_s 2 -var touch_speed_m_s 2 -var release_speed_m_s 2 \
    -var restart_every_us 0.5 >"$2/screen.txt" || { tail "$2/screen.txt"; exit 1; }
}
# kill -9 to the launcher and the ranks of one run; other runs on this machine, even of the same path, go on.
kill_job() { # PID of calendem run
  local launcher
  launcher=$(pgrep -P "$1") && kill -9 "$launcher" $(pgrep -P "$launcher") 2>/dev/null
}
kill_and_resume() { # CASE DIR: kill -9 once a restart file and twelve rows are there, then --resume
  "$bin/calendem" run "$1" -o "$2" --ranks 1 >"$2.log" 2>&1 &
  run=$!
  while kill -0 $run 2>/dev/null; do
    [ -s "$2/running.restart" ] && [ "$(wc -l <"$2/curve_raw.csv")" -gt 12 ] && break
    sleep 0.05
  done
  kill_job $run || fail "the run ended before it could be killed"
  wait $run && fail "a killed run must not end with exit status 0"
  "$bin/calendem" run "$1" -o "$2" --ranks 1 --resume
}
same_on_two_ranks() { # CASE RUN: the breaks, pressures and gaps of a run on one rank, to the last digit
  rm -rf "$work/ranks"
  "$bin/calendem" run "$1" -o "$work/ranks" --ranks 2
  cmp "$2/breaks.csv" "$work/ranks/breaks.csv" || fail "1 and 2 ranks broke different bonds"
  cmp <(cut -d, -f1-13 "$2/curve_raw.csv") <(cut -d, -f1-13 "$work/ranks/curve_raw.csv") ||
    fail "1 and 2 ranks gave different curves"
}

mkdir -p "$work"
cp "$here/case.toml" "$work/"
case $case in
  settings) # the scripts alone: a bond is as stiff as its particles unless asked; every setting is written down
    written() { # VARIABLE [-var NAME VALUE]...: what settings.txt says of it
      printf '%s\n' "variable scripts index x" "include $scripts/common/defaults.in" \
        "include $scripts/common/settings.in" >"$work/in.settings"
      "$bin/liggghts" -in "$work/in.settings" -log none -var out "$work" "${@:2}" >"$work/said" || { cat "$work/said"; exit 1; }
      sed -n "s/^variable $1 index //p" "$work/settings.txt"
    }
    [ "$(written E_bond_GPa -var E_am_GPa 150)" = 150 ] || fail "E_bond_GPa is not E_am_GPa"
    [ "$(written nu_bond -var nu_am 0.2)" = 0.2 ] || fail "nu_bond is not nu_am"
    [ "$(written E_bond_GPa -var E_am_GPa 150 -var E_bond_GPa 200)" = 200 ] || fail "E_bond_GPa cannot be given"
    [ "$(written vtk_every_us)" = 2 ] || fail "vtk_every_us is not what a case has" ;;
  pack)
    rm -rf "$work/electrode"
    "$bin/calendem" pack "$here/electrode.toml" -o "$work/electrode" --ranks 1
    "$bin/calendem" pack "$here/electrode.toml" -o "$work/electrode" --ranks 1 | grep already >/dev/null ||
      fail "a second pack of the same recipe should find it done"
    # At rest with a case's materials. A packing counts as quiet at 1e-3 m/s; sound of 2 km/s in 2.5 g/cm3 then carries
    # rho c v = 0.005 MPa.
    stress=$(number film_stress_MPa "$work/electrode/electrode.json")
    holds "$stress < 0.005 && $stress > -0.005" "the packed film bears $stress MPa in its plane" ;;
  run)
    rm -rf "$work/run"
    (cd "$work" && "$bin/calendem" run case.toml -o run --ranks 1 \
      --liggghts "$(realpath --relative-to=. "$bin/liggghts")") # paths may be relative
    p=$(number max_pressure_MPa "$work/run/summary.json")
    # rows are a window apart, in which the pressure rises by 0.2 % of the target at last
    holds "$p >= 0.998 * 40 && $p <= 40.4" "maximum pressure $p MPa is not 40 within a window below and 1 % above"
    before=$(number porosity_initial "$work/run/summary.json")
    after=$(number porosity_after_relaxation "$work/run/summary.json")
    holds "$after < $before" "porosity $before -> $after did not fall"
    [ "$(rows "$work/run/breaks.csv" | wc -l)" -gt 0 ] || fail "no bond broke"
    awk -F, 'NR > 1 && !($11 > 0) { wrong = 1 } END { exit wrong }' "$work/run/breaks.csv" ||
      fail "breaks without the pressure at which they happened"
    # cracks.csv ends as bodies.csv does, with a face of 1.28 x 1.28 um for every broken bond
    awk -F, -v file="$work/run/cracks.csv" 'NR > 1 { broken += $4; cracked += $10; apart += $6 > 1; all += $3 > 0 }
      END { while ((getline line < file) > 0) last = line
            split(last, c, ","); d = c[9] - broken * 1.28 * 1.28
            exit !(c[4] == all && c[5] == apart && c[6] == cracked && d * d < 1e-6 * c[9] * c[9] && c[9] > 0) }' \
      "$work/run/bodies.csv" || fail "cracks.csv does not end as bodies.csv does"
    # overlaps beyond the range: shares fall with the limit; inertial number at the platen's 2 m/s, kinetic over elastic
    # energy to their four digits; the summary has the row of maximum pressure
    said=$(sed -n '/"contact_range"/,$p' "$work/run/summary.json" >"$work/said" && number 'force_beyond_0.2_R' "$work/said" | head -n 1)
    awk -F, -v said="$said" -v density="$(awk 'NF == 7 && $2 == 1 { print $4; exit }' "$work/electrode/electrode.data")" '
      function near(x, y, tolerance) { return (x - y) ^ 2 <= (tolerance * y) ^ 2 }
      NR == 1 { for (k = 1; k <= NF; ++k) at[$k] = k; next }
      { for (k = 0; k < 2; ++k) {
          what = k ? "contacts" : "force"
          for (n = 1; n <= 3; ++n) s[n] = $at[what "_beyond_0." n "_R"]
          wrong += !(1 >= s[1] && s[1] >= s[2] && s[2] >= s[3] && s[3] >= 0) }
        wrong += !near($at["kinetic_to_elastic"], $at["kinetic_fJ"] / ($at["strain_fJ"] + $at["contact_elastic_fJ"]), 1e-3)
        P = $at["pressure_MPa"]
        if (P > 5 && P < 15 && $at["stage"] == "compression") { # before the platen slows down
          rows += 1
          wrong += !near($at["inertial_number"], 2 / $at["thickness_um"] * 1.59 * sqrt(density / (1e3 * P)), 1e-3) }
        if (P > highest) { highest = P; beyond = $at["force_beyond_0.2_R"]; largest = $at["am_cbd_overlap_largest"] } }
      END { print "at maximum pressure: " beyond " of the force beyond 0.2 R, largest overlap of AM and CBD " largest " R"
            exit !(wrong == 0 && rows > 0 && largest > 0 && near(beyond, said, 1e-5)) }' "$work/run/curve.csv" ||
      fail "what curve.csv says of overlaps, inertia and energies does not agree with itself or with summary.json ($said)"
    awk -F, 'NR > 1 && $2 + $3 + $4 + $5 != n { if (n) exit 1; n = $2 + $3 + $4 + $5 } END { exit !(NR == 17 && n > 0) }' \
      "$work/run/thresholds.csv" || fail "thresholds.csv does not count every body at each threshold"
    for f in curve.csv bodies.csv case.toml vtk/particles.pvd vtk/bonds.pvd vtk/platen.pvd; do
      [ -s "$work/run/$f" ] || fail "$f is missing"
    done ;;
  split_scripts) # in.compression then in.relaxation give in.calendering's bytes
    rm -rf "$work/split"
    plain in.compression "$work/split"
    mpirun -np 1 "$bin/liggghts" -in "$scripts/in.relaxation" -log "$work/split/log.liggghts" -var scripts "$scripts" \
      -var out "$work/split" >"$work/split/screen.txt" || { tail "$work/split/screen.txt"; exit 1; } # settings of the compression
    cmp <(rows "$work/run/curve_raw.csv") <(rows "$work/split/curve_raw.csv") || fail "curves differ"
    cmp "$work/run/breaks.csv" "$work/split/breaks.csv" || fail "break logs differ"
    "$bin/calendem" collect "$work/split" # as `calendem run` does at its end
    for f in curve.csv bodies.csv cracks.csv thresholds.csv vtk/bonds.pvd; do
      cmp "$work/run/$f" "$work/split/$f" || fail "$f of collect differs from that of run"
    done ;;
  killed_and_resumed) # kill -9 in mid-run, resume: the uninterrupted run's bytes
    rm -rf "$work/killed"
    kill_and_resume "$work/case.toml" "$work/killed"
    cmp "$work/run/breaks.csv" "$work/killed/breaks.csv" || fail "break logs differ after --resume"
    cmp "$work/run/curve.csv" "$work/killed/curve.csv" || fail "curves differ after --resume" ;;
  effects_resumed) # the same with every effect on: memories of contacts, radii, nanoporosities restart
    # a contact follows one law: several runs, all with CALENDEM_HEAVY=1
    for effects in \
      "nmc_plasticity.yield_pressure_GPa = 2
       collector_indentation.yield_pressure_GPa = 0.5
       cbd_collapse.yield_pressure_MPa = 2
       cbd_collapse.hardening_MPa = 10
       cbd_viscoelasticity.relaxed_fraction = 0.3
       cbd_viscoelasticity.time_us = 0.5" \
      "nmc_confinement.bulk_modulus_GPa = 150
       nmc_confinement.free_surface = 0.95
       cbd_plasticity.yield_pressure_GPa = 0.55
       cbd_plasticity.hardening_GPa = 0.2" \
      "binder_bridges.strength_MPa = 20
       pre_cracks.fraction = 0.1"; do
      sed 's/^max_pressure_MPa = .*/control = "displacement"\ndisplacement_um = 2.8/; s/= 2$/= 4/' "$here/case.toml" >"$work/effects.toml"
      printf '\n[effects]\n%s\n' "$effects" >>"$work/effects.toml"
      rm -rf "$work/effects" "$work/effects_killed"
      "$bin/calendem" run "$work/effects.toml" -o "$work/effects" --ranks 1
      left=$(number unaccounted_fraction "$work/effects/summary.json")
      holds "$left < 0.003" "the ledger with all effects leaves $left of the work"
      kill_and_resume "$work/effects.toml" "$work/effects_killed"
      cmp "$work/effects/breaks.csv" "$work/effects_killed/breaks.csv" || fail "break logs differ after --resume"
      cmp "$work/effects/curve.csv" "$work/effects_killed/curve.csv" || fail "curves differ after --resume"
      same_on_two_ranks "$work/effects.toml" "$work/effects"
      [ "${CALENDEM_HEAVY:-0}" = 1 ] || break
    done ;;
  roll) # two passes with slip and elongation are gone on with to the same bytes; one pass is the platen at equal smallest gap
    under() { # FILE SETTINGS-OF-PLATEN SETTINGS-OF-ROLL
      sed "s/^max_pressure_MPa = .*/$2/" "$here/case.toml" >"$work/$1"
      printf '\n[roll]\n%b' "$3" >>"$work/$1"
    }
    rm -rf "$work"/rolled* "$work/pressed" "$work/passed_once"
    under rolled.toml 'control = "roll_gap"\nroll_gap_um = 14' 'passes = 2\nfirst_gap_um = 15\nslip = 0.002\nelongation_percent = 1\n'
    # of a film that has dried on its foil before
    printf '\n[effects.binder_bridges]\nstrength_MPa = 10\n\n[effects.drying_stress]\nshrinkage = 0.009\ntime_us = 0.1\n' >>"$work/rolled.toml"
    "$bin/calendem" run "$work/rolled.toml" -o "$work/rolled" --ranks 1
    kill_and_resume "$work/rolled.toml" "$work/rolled_killed"
    cmp "$work/rolled/breaks.csv" "$work/rolled_killed/breaks.csv" || fail "break logs differ after --resume"
    cmp "$work/rolled/curve.csv" "$work/rolled_killed/curve.csv" || fail "curves differ after --resume"
    left=$(number unaccounted_fraction "$work/rolled/summary.json" | tail -n 1) # the first is of drying
    holds "$left < 0.003" "the ledger of two passes with slip and elongation leaves $left of the work"
    [ "$(awk -F, '$2 == "compression" && last != $2 { n += 1 } { last = $2 } END { print n }' "$work/rolled/curve.csv")" = 2 ] ||
      fail "curve.csv does not show two passes"
    awk -F, 'NR == 1 { for (k = 1; k <= NF; ++k) at[$k] = k; next }
      $at["cell_x_um"] / (6 * (1 + 0.01 * $at["elongation_percent"])) - 1 > 1e-8 { wrong = 1 } { last = $at["elongation_percent"] }
      END { exit wrong || last != 1 }' "$work/rolled/curve.csv" || fail "the web did not elongate by 1 %"
    sed -n '/"roll":/,/^  }/p' "$work/rolled/summary.json" >"$work/said"
    mapfile -t gaps < <(number gap_um "$work/said")
    # a row is an average over 0.1 um at the highest speed, which turns in the nip: a quarter of that at most
    holds "${gaps[0]} >= 15 && ${gaps[0]} < 15.025 && ${gaps[1]} >= 14 && ${gaps[1]} < 14.025" "gaps of the passes: ${gaps[*]}"
    # at 5 % of the maximum: in this cell 1 % is a single contact. Over six speeds the platen's thickness scatters by 0.058 um,
    # the roll's by 0.036: 0.2 um is three times what both together do
    under passed_once.toml 'control = "roll_gap"\nroll_gap_um = 14' ''
    under pressed.toml 'control = "thickness"\nthickness_um = 14' ''
    for run in passed_once pressed; do
      "$bin/calendem" run "$work/$run.toml" -o "$work/$run" --ranks 1
      s=$work/$run/summary.json
      released=$(awk "BEGIN { print $(number thickness_at_max_um "$s") * (1 - $(number porosity_at_max "$s")) / (1 - $(number '0\.05' "$s")) }")
      echo "$run: $released um at 5 % of the largest pressure"
      [ -z "${other:-}" ] || holds "($other - $released) ^ 2 < 0.2 ^ 2" "roll and platen are apart"
      other=$released
    done ;;
  line_load) # one layer of four elastic spheres: the gap that carries the load, in closed form; gone on with after a kill
    rm -rf "$work"/layer "$work"/loaded*
    mkdir -p "$work/layer"
    (cd "$work/layer"
      {
        printf 'layer\n\n4 atoms\n4 atom types\n\n0 5 xlo xhi\n0 5 ylo yhi\n0 4 zlo zhi\n\nAtoms\n\n'
        awk 'BEGIN { for (n = 0; n < 4; ++n) print n + 1, 1, 1.59, 4.65, 1.25 + 2.5 * (n % 2), 1.25 + 2.5 * (n > 1), 0.795 }'
      } >electrode.data
      printf '1 1\n2 2\n3 3\n4 4\n' >bodies.map
      printf 'variable %s equal %s\n' thickness_um 1.6 area_um2 25 solid_volume_um3 8.4 primary_diameter_um 1.59 lattice_um 1.28 \
        cbd_diameter_um 1.59 >electrode.in
      echo '{"cell_um": [5, 5], "thickness_um": 1.6, "porosity_total": 0.79, "porosity_macro": 0.79, "bonds": 0, "bodies": 4,
        "primaries": 4, "recipe": {"particles.lattice_um": "1.28", "particles.primary_diameter_um": "1.59", "cbd.diameter_um": "1.59"}}' \
        >electrode.json
      echo body >bodies.csv)
    cat >"$work/loaded.toml" <<'EOF'
electrode = "layer"
[material.am]
ced_J_m3 = 0
[material.collector]
youngs_modulus_GPa = 200
[platen]
control = "roll_gap"
roll_gap_um = 1.54
speed_m_s = 0.1
touch_speed_m_s = 0.1
release_speed_m_s = 0.1
ramp_us = 0
[roll]
line_load_N_mm = 30
[numerics]
average_us = 0.01
gravity_m_s2 = 0
[output]
every_us = 0.01
restart_every_us = 0.5
EOF
    "$bin/calendem" run "$work/loaded.toml" -o "$work/loaded" --ranks 1
    cat "$work/loaded/rehearsals.csv"
    sed -n '/"roll":/,/^  }/p' "$work/loaded/summary.json" >"$work/said"
    load=$(number line_load_N_mm "$work/said" | head -n 1) gap=$(number gap_um "$work/said" | head -n 1)
    # q = n/A (3 pi/8) F s0, F = (4/3) E* sqrt(R) (d/2)^1.5, s0 = sqrt(2 R_nip d); waves: v sqrt(k m)/F = 1.2e-3
    closed=$(awk "BEGIN { d = 1.59 - $gap; print 4 / 25 * 3 * 3.14159265 / 8 * 4 / 3 * 100 / 0.91 * sqrt(0.795) * (d / 2) ^ 1.5 * sqrt(2e5 * d) }")
    echo "line load $load N/mm at $gap um; Hertz contacts there: $closed N/mm"
    holds "($load / 30 - 1) ^ 2 <= 0.02 ^ 2" "the line load is $load instead of 30 N/mm"
    holds "($load / $closed - 1) ^ 2 < 0.002 ^ 2" "the line load is $load, of Hertz contacts $closed N/mm"
    kill_and_resume "$work/loaded.toml" "$work/loaded_killed"
    cmp "$work/loaded/curve.csv" "$work/loaded_killed/curve.csv" || fail "curves differ after --resume"
    cmp "$work/loaded/rehearsals.csv" "$work/loaded_killed/rehearsals.csv" || fail "rehearsals differ after --resume" ;;
  packed_anew) # an electrode that changes during a run is reported, not collected
    rm -rf "$work/anew" "$work/on_anew"
    cp -r "$work/electrode" "$work/anew"
    sed 's/^electrode = .*/electrode = "anew"/' "$here/case.toml" >"$work/on_anew.toml"
    "$bin/calendem" run "$work/on_anew.toml" -o "$work/on_anew" --ranks 1 >"$work/said" 2>&1 &
    run=$!
    until [ -s "$work/on_anew/curve_raw.csv" ] || ! kill -0 $run 2>/dev/null; do sleep 0.05; done
    sed 's/^1 1 /1 2 /' "$work/electrode/electrode.data" >"$work/anew/electrode.data"
    head -n 3 "$work/electrode/bodies.map" >"$work/anew/bodies.map"
    wait $run && fail "a run whose electrode changed must not end with exit status 0"
    grep -q "anew/electrode.data' has changed while the run went on" "$work/said" || { cat "$work/said"; fail "it is not said"; } ;;
  many_kills) # twenty kill -9 at random moments, every time gone on with: the uninterrupted run's bytes
    [ "${CALENDEM_HEAVY:-0}" = 1 ] || { echo "skipped: calendering.many_kills runs with tools/test --all"; exit 77; }
    RANDOM=4
    kills=0 runs=0
    while [ $kills -lt 20 ]; do
      rm -rf "$work/kills"
      runs=$((runs + 1))
      for _ in $(seq 100); do
        "$bin/calendem" run "$work/case.toml" -o "$work/kills" --ranks 1 --resume >"$work/kills.log" 2>&1 &
        run=$!
        sleep "$(awk "BEGIN { print 0.1 + $RANDOM / 32768 * 1.2 }")"
        if kill_job $run; then kills=$((kills + 1)); fi
        if wait $run; then break; fi
        [ ! -e "$work/kills/summary.json" ] || grep -q '"finished": false' "$work/kills/summary.json" ||
          fail "summary.json says finished after a kill"
      done
      cmp "$work/run/breaks.csv" "$work/kills/breaks.csv" || fail "break logs differ after $kills kills"
      cmp "$work/run/curve.csv" "$work/kills/curve.csv" || fail "curves differ after $kills kills"
    done
    echo "$kills kills in $runs runs, every one gone on with to the same bytes" ;;
  rare_rows) # asked for every 0.5 us, they come every 0.1 um of travel; breaks before first touch are at 0 MPa
    (cat "$here/case.toml" && printf 'every_us = 0.5\n[effects.pre_cracks]\nfraction = 0.05\n') >"$work/rare.toml"
    "$bin/calendem" run "$work/rare.toml" -o "$work/rare" --ranks 1 --force
    grep -q '"finished": true' "$work/rare/summary.json" || fail "the run counts as not finished"
    awk -F, 'NR > 2 && $1 - last > 0.0502 { wrong = 1 } { last = $1 } END { exit wrong }' "$work/rare/curve.csv" ||
      fail "rows are more than 0.1 um of travel apart"
    [ -n "$(number '0\.01' "$work/rare/summary.json")" ] || fail "no porosity at the platen's own threshold"
    awk -F, 'NR > 1 && $1 < 0.01 { n += 1; wrong += $11 != 0 } END { exit !(n > 0 && wrong == 0) }' "$work/rare/breaks.csv" ||
      fail "breaks before first touch have a pressure: $(head -n 3 "$work/rare/breaks.csv")" ;;
  unbreakable) # bonds weaker than those that break in `run` bear all
    sed 's/^\[bond\]/&\nbreakable = "no"/; s/^tensile.*/tensile_strength_MPa = 20/; s/^max_pressure.*/max_pressure_MPa = 15/' \
      "$here/case.toml" >"$work/unbreakable.toml"
    "$bin/calendem" run "$work/unbreakable.toml" -o "$work/unbreakable" --ranks 1 --force
    [ "$(rows "$work/unbreakable/breaks.csv" | wc -l)" = 0 ] || fail "a bond broke" ;;
  refused) # another electrode's restart files, nanoporosity of another recipe, paths LIGGGHTS cannot take
    refused() { # TEXT ARGUMENT...: exit status 2 and the text
      local status=0
      "$bin/calendem" run "${@:2}" --ranks 1 >"$work/said" 2>&1 || status=$?
      cat "$work/said"
      [ $status -eq 2 ] || fail "exit status $status instead of 2"
      grep -qF -- "$1" "$work/said" || fail "'$1' was not said"
    }
    rm -rf "$work/other" "$work/begun" "$work/a run"
    cp -r "$work/electrode" "$work/other"
    awk '/^Atoms/ { atoms = 1 } atoms && $1 == 1 && NF == 7 { $5 = sprintf("%.17g", $5 + 1e-9) } { print }' \
      "$work/electrode/electrode.data" >"$work/other/electrode.data"
    sed 's/"electrode"/"other"/' "$work/case.toml" >"$work/another.toml"
    "$bin/calendem" run "$work/case.toml" -o "$work/begun" --ranks 1 >"$work/begun.log" 2>&1 &
    run=$!
    until [ -s "$work/begun/running.restart" ]; do sleep 0.1; done
    kill_job $run || fail "the run ended before it could be killed"
    wait $run && fail "a killed run must not end with exit status 0"
    refused "holds a run of another electrode" "$work/another.toml" -o "$work/begun" --resume
    (cat "$work/case.toml" && printf '[effects.cbd_collapse]\nyield_pressure_MPa = 20\ninitial_nanoporosity = 0.4\n') >"$work/pores.toml"
    refused "initial_nanoporosity is 0.4, but the electrode was packed with a nanoporosity of 0.5" "$work/pores.toml" -o "$work/pores"
    refused "LIGGGHTS cannot take a path with a blank" "$work/case.toml" -o "$work/a run"
    [ ! -e "$work/a run" ] || fail "a folder was made for nothing" ;;
  two_ranks) same_on_two_ranks "$work/case.toml" "$work/run" ;;
  measured) # calendem measure agrees with the run's own files; the report shows it
    rm -rf "$work/measured"
    cp -r "$work/run" "$work/measured"
    "$bin/calendem" measure "$work/measured" --voxel-um 0.2
    s=$work/measured/structure.json
    mapfile -t total < <(number porosity_total "$s") # before, max, after
    mapfile -t macro < <(number porosity_macro "$s")
    mapfile -t tau < <(number tau_through_plane "$s")
    near() { holds "($1) - ($2) < $3 && ($2) - ($1) < $3" "$4: $1 instead of $2"; }
    i=0
    for key in porosity_initial porosity_at_max porosity_after_relaxation; do
      near "${total[i]}" "$(number $key "$work/run/summary.json")" 1e-5 "total porosity, $key"
      i=$((i + 1))
    done
    mapfile -t times < <(number time_us "$s")
    for i in 0 1; do # the curve's macro porosity in the row next to the frame: CBD outside the bare primaries
      near "${macro[i]}" "$(awk -F, -v t="${times[i]}" 'NR > 1 { d = ($1 - t) ^ 2; if (NR == 2 || d < least) { least = d; p = $14 } }
        END { print p }' "$work/run/curve.csv")" 0.006 "macro porosity at ${times[i]} us"
    done
    profile() { awk -F, -v m="$1" -v c="$2" '$1 == m { n += $c } END { print n }' "$work/measured/structure.csv"; }
    for moment in before max after; do
      near "$(profile $moment 9)" "$(number bonds_initial "$work/run/summary.json")" 0.5 "bonds in the profile, $moment"
    done
    near "$(profile before 10)" 0 0.5 "broken bonds before"
    near "$(profile after 10)" "$(rows "$work/run/breaks.csv" | wc -l)" 0.5 "broken bonds after"
    holds "${tau[0]} > 1 && ${tau[1]} > ${tau[0]} && ${tau[2]} < ${tau[1]}" "tortuosity ${tau[*]}"
    "$bin/calendem" report "$work/measured"
    for text in "Porosity through the thickness" "Tortuosity factor through the plane"; do
      grep -q "$text" "$work/measured/report.html" || fail "the report does not show '$text'"
    done ;;
  images) # a run's own frames as an experiment's label images: no gap; that of before as after: a gap
    "$bin/calendem" measure "$work/run" -o "$work/images" --without-tortuosity --voxel-um 0.2 --images
    experiment() { # IMAGE: of the state after calendering
      printf '[experiment]\nname = "own frames"\nelectrode = "%s/electrode.toml"\nlabels_cbd = -1\n' "$here"
      printf '[[condition]]\nid = "p40"\ncontrol = "pressure"\nmax_pressure_MPa = 40\n'
      printf 'labels_before = "images/before.mha"\nlabels_after = "%s"\n' "$1"
    }
    experiment images/after.mha >"$work/own.toml"
    "$bin/calendem" compare "$work/own.toml" "$work/run" -o "$work/own_gap"
    mapfile -t residuals < <(number residual "$work/own_gap/gap.json")
    [ "${#residuals[@]}" -ge 6 ] || fail "${#residuals[@]} rows instead of three for each image at least"
    for r in "${residuals[@]}"; do holds "$r < 1e-9 && -($r) < 1e-9" "a run differs from its own image by $r"; done
    experiment images/before.mha >"$work/other.toml"
    "$bin/calendem" compare "$work/other.toml" "$work/run" -o "$work/other_gap"
    grep -q '"significant": true' "$work/other_gap/gap.json" || fail "the film of before passed for that of after"
    (cat "$work/case.toml" && printf '\n[imposed]\ncbd_nanoporosity_until_MPa = 40\n') >"$work/imposed.toml"
    "$bin/calendem" run "$work/imposed.toml" -o "$work/imposed" --ranks 1 --force
    # Frames hold radii as floats, 1e-7 of them: nanoporosities of 50 and, beyond 40 MPa, 27 % to 1e-6.
    for of in run:0.5 imposed:0.27; do
      nano=$(number cbd_nanoporosity_after "$work/${of%:*}/summary.json")
      holds "($nano - ${of#*:}) ^ 2 < 1e-12" "${of%:*}: the nanoporosity after is $nano instead of ${of#*:}"
    done
    "$bin/calendem" compare "$work/own.toml" "$work/imposed" -o "$work/imposed_gap"
    grep -q 'CBD is imposed, not predicted: from 50 to 27 % at 40 MPa' "$work/imposed_gap/gap.html" ||
      fail "the page does not say that nanoporosity was imposed" ;;
esac
