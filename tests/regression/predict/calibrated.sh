#!/usr/bin/env bash
# Read by the tests with their arguments BIN CASES WORK: in WORK/model two measured films have calibrated the bank that
# ships, with $samples samples where they are set; film.toml is one to predict.
set -euo pipefail
bin=$1 cases=$2 work=$3
fail() { echo "FAILED: $*" >&2; exit 1; }
rm -rf "$work"
mkdir -p "$work"
cd "$work"
films=("$cases/paper/experiment_with_nanopores.toml" "$cases/real/artistic_96/experiment.toml")
calendem() { "$bin/calendem" "$@"; }

calendem calibrate "${films[@]}" -o model --bank "$cases/films/bank.toml" ${samples:+--samples "$samples"} | tee calibrate.log

cat >film.toml <<'END'
name = "film"
[composition]
carbon_weight_percent = 2.5
binder_weight_percent = 2.5
[coating]
porosity_total_percent = 44
END
refuses() { # WORDS ARGUMENTS...
  local words=$1 status=0
  shift
  calendem "$@" -o bad >bad.log 2>&1 || status=$?
  [ $status = 2 ] || fail "exit status $status for: $*"
  grep -qF -- "$words" bad.log || { cat bad.log; fail "'$words' is not said for: $*"; }
  [ ! -e bad ] || fail "something was written for: $*"
}
