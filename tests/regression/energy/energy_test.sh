#!/usr/bin/env bash
# The energy ledger of one run closes: energy_test.sh friction|frictionless|plastic|collapse|viscous|hardening|confined|bridges|drying BIN WORK
set -euo pipefail
case=$1 bin=$2 work=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if [ "$(id -u)" -eq 0 ]; then export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; fi
fail() { echo "FAILED: $*" >&2; exit 1; }
holds() { awk "BEGIN { exit !($1) }" || fail "$2"; }
number() { sed -n "s/^ *\"$1\": \([-+0-9.e]*\),*$/\1/p"; }
at() { sed -n "/\"$1\"/,/}/p" "$summary" | number "$2"; } # WHEN TERM

limit=0.003 # see README.md
mkdir -p "$work"
summary=$work/$case/summary.json
case $case in
  friction) cp "$here/case.toml" "$work/$case.toml" ;;
  frictionless) # every friction 0: the two that are set, and the walls'
    sed 's/^friction = .*/friction = 0/' "$here/case.toml" >"$work/$case.toml"
    printf '\n[material.collector]\nfriction = 0\n\n[material.platen]\nfriction = 0\n' >>"$work/$case.toml" ;;
  plastic) # what yields takes more than damping does in the other cases
    sed 's/^max_pressure_MPa = .*/max_pressure_MPa = 30/; s/^timestep_us.*//' "$here/case.toml" >"$work/$case.toml"
    printf '\n[effects.nmc_plasticity]\nyield_pressure_GPa = 3\n\n[effects.collector_indentation]\nyield_pressure_GPa = 0.5\n' \
      >>"$work/$case.toml" ;;
  collapse)
    sed 's/^max_pressure_MPa = .*/max_pressure_MPa = 40/' "$here/case.toml" >"$work/$case.toml"
    printf '\n[effects.cbd_collapse]\nyield_pressure_MPa = 5\nhardening_MPa = 20\n' >>"$work/$case.toml" ;;
  viscous)
    sed 's/^max_pressure_MPa = .*/max_pressure_MPa = 30/' "$here/case.toml" >"$work/$case.toml"
    printf '\n[effects.cbd_viscoelasticity]\nrelaxed_fraction = 0.5\ntime_us = 1\n' >>"$work/$case.toml" ;;
  hardening) # what CBD takes
    sed 's/^max_pressure_MPa = .*/max_pressure_MPa = 30/; s/^timestep_us.*//' "$here/case.toml" >"$work/$case.toml"
    printf '\n[effects.cbd_plasticity]\nyield_pressure_GPa = 0.55\nhardening_GPa = 0.2\n' >>"$work/$case.toml" ;;
  confined) # from 0.9 of the surface on, so that the bulk acts at this pressure
    sed 's/^max_pressure_MPa = .*/max_pressure_MPa = 30/; s/^timestep_us.*//' "$here/case.toml" >"$work/$case.toml"
    printf '\n[effects.cbd_confinement]\nbulk_modulus_GPa = 10\nfree_surface = 0.9\n' >>"$work/$case.toml" ;;
  bridges) # strong, so that what they lose in breaks would be missed
    sed 's/^max_pressure_MPa = .*/max_pressure_MPa = 30/' "$here/case.toml" >"$work/$case.toml"
    printf '\n[effects.binder_bridges]\nstrength_MPa = 25\ncollector_strength_MPa = 10\n' >>"$work/$case.toml" ;;
  drying) # so far that bridges break before the press touches the film
    sed 's/^max_pressure_MPa = .*/max_pressure_MPa = 10/' "$here/case.toml" >"$work/$case.toml"
    printf '\n[effects.binder_bridges]\nstrength_MPa = 10\n\n[effects.drying_stress]\nshrinkage = 0.009\ntime_us = 0.1\n' \
      >>"$work/$case.toml" ;;
esac
rm -rf "${work:?}/$case"
"$bin/calendem" run "$work/$case.toml" -o "$work/$case" --ranks 1
left=$(sed -n '/"energy_fJ"/,/^  }/p' "$summary" | number unaccounted_fraction)
echo "unaccounted for: $left of the work"
holds "$left <= $limit" "the ledger leaves $left of the platen's work"
W=$(at at_max_pressure work_of_platen)
terms="elastic_in_contacts cohesion damped"
[ "$case" != friction ] || terms="$terms friction elastic_in_bonds lost_in_breaks"
for term in $terms; do # each is large enough that the ledger would show its absence
  x=$(at at_max_pressure "$term")
  echo "$term: $(awk "BEGIN { print 100 * $x / $W }") % of the work at maximum pressure"
  holds "$x >= 2 * $limit * $W || $x <= -2 * $limit * $W" "$term is too small for this test: $x of $W fJ"
done
if [ "$case" = collapse ]; then # frames carry the radii: the nanopores' share of the cell falls
  nano=$(awk -F, 'NR == 1 { for (k = 1; k <= NF; ++k) at[$k] = k; next }
    { v = ($at["porosity_total"] - $at["porosity_macro"]) * $at["thickness_um"]; if (NR == 2) first = v }
    END { print v / first }' "$work/$case/curve.csv")
  echo "nanopores at the end, of those at the start: $nano"
  holds "$nano < 0.9" "the nanopores did not collapse"
fi
if [ "$case" = bridges ]; then
  for of in $(sed -n '/"bridges"/,/^  }/p' "$summary" | tr -d ' ",{}' | grep '^[a-z]*:[0-9]'); do
    echo "bridges, broken after and at the maximum, made: $of"
    holds "${of#*:} > 0" "no bridges were made, or none broke"
  done
  x=$(at at_max_pressure lost_in_breaks)
  echo "lost in breaks: $(awk "BEGIN { print 100 * $x / $W }") % of the work at maximum pressure"
  holds "$x >= 2 * $limit * $W" "bridges lose too little for this test: $x of $W fJ"
fi
if [ "$case" = drying ]; then
  dried=$(sed -n '/"drying"/,/^  }/p' "$summary")
  left=$(number unaccounted_fraction <<<"$dried") broken=$(number am <<<"$dried")
  echo "while it dries: $left of the work of shrinking unaccounted for, $broken bridges to AM broken"
  holds "$left <= $limit && $left > 0" "the ledger of drying leaves $left of the work of shrinking"
  holds "$broken > 0" "no bridge broke while the film dried"
fi
if [ "$case" = frictionless ]; then # the host damps across a contact in the half step of a set-up
  x=$(at at_end friction)
  holds "$x <= $limit * $W && $x >= 0" "friction takes $x fJ though it is switched off"
fi
