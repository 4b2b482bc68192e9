#!/usr/bin/env bash
# One compressed state, released at three speeds with several averaging windows; see README.md.
#   release_test.sh small ELECTRODE RUN BIN WORK    from a run of `calendering`
#   release_test.sh bank BIN WORK                   packs and presses the bank's cell
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
scripts=$(cd "$here/../../../input_scripts" && pwd)
if [ "$(id -u)" -eq 0 ]; then export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; fi
fail() { echo "FAILED: $*" >&2; exit 1; }
number() { sed -n "s/^ *\"$1\": \([-+0-9.e]*\),*$/\1/p" "$2"; } # of a summary
script() { # NAME FOLDER SETTING...
  mpirun -np 1 "$bin/liggghts" -in "$scripts/$1" -log "$2/log.liggghts" -var scripts "$scripts" \
    -var electrode "$electrode" -var out "$2" "${@:3}" >"$2/screen.txt" || { tail "$2/screen.txt"; exit 1; }
}
release() { # SPEED WINDOW: from $work/pressed
  local folder=$work/release_$1_$2
  rm -rf "$folder"
  cp -r "$work/pressed" "$folder"
  script in.relaxation "$folder" "${settings[@]}" -var release_speed_m_s "$1" -var average_us "$2"
  sed -i "s/^\(variable release_speed_m_s index\) .*/\1 $1/; s/^\(variable average_us index\) .*/\1 $2/" "$folder/settings.txt"
  "$bin/calendem" collect "$folder" --electrode "$electrode" >"$folder/collect.txt" 2>&1 ||
    { cat "$folder/collect.txt"; fail "$folder could not be collected"; }
}
platen() { # SHARE FOLDER...: gaps at that share of the largest pressure, as the summaries have them
  local share=$1 folder s
  for folder in "${@:2}"; do
    s=$folder/summary.json
    awk -v h="$(number thickness_at_max_um "$s")" -v top="$(number porosity_at_max "$s")" \
      -v p="$(number "${share//./\\.}" "$s")" 'BEGIN { if (p != "") printf "%.4f\n", h * (1 - top) / (1 - p) }'
  done
}
both_walls() { # SHARE FOLDER...: the same by the mean of the pressures on platen and collector, of the largest before the release
  for folder in "${@:2}"; do
    awk -F, -v share="$1" 'NR == 1 { for (k = 1; k <= NF; ++k) at[$k] = k; next }
      { p = 0.5 * ($at["pressure_MPa"] + $at["pressure_bottom_MPa"]); h = $at["thickness_um"]
        if ($at["stage"] != "relaxation" && $at["pressure_MPa"] > most) most = $at["pressure_MPa"]
        if ($at["stage"] == "relaxation" && p < share * most) {
          printf "%.4f\n", h0 + (h - h0) * (p0 - share * most) / (p0 - p); exit }
        p0 = p; h0 = h }' "$folder/curve.csv"
  done
}
within() { # WHAT, gaps on stdin: at most 0.05 um between any two
  awk -v what="$1" -v n="$2" '{ if (NR == 1 || $1 < low) low = $1; if (NR == 1 || $1 > high) high = $1 }
    END { printf "%s: %.3f to %.3f um\n", what, low, high; exit !(NR == n && high - low <= 0.05) }' ||
    fail "$1: the thickness after the release depends on how it was taken"
}
means_agree() { # WHAT, gaps on stdin, first those of slow releases, then as many of fast ones
  awk -v what="$1" -v n="$2" '{ h[NR] = $1; mean[NR > n] += $1 / n }
    END { for (k = 1; k <= NR; ++k) s2 += (h[k] - mean[k > n]) ^ 2 / (2 * n - 2)
      d = mean[1] - mean[0]; most = 3.71 * sqrt(s2 * 2 / n)
      printf "%s: means %.3f and %.3f um, scatter %.3f um, at most %.3f apart\n", what, mean[0], mean[1], sqrt(s2), most
      exit !(NR == 2 * n && d * d <= most * most) }' ||
    fail "$1: the thickness after the release depends on the speed"
}

case $1 in
  small)
    electrode=$2 bin=$4 work=$5
    settings=(-var sigma_c_MPa 200 -var tau_c_MPa 200 -var p_max_MPa 40 -var speed_m_s 2 -var touch_speed_m_s 2)
    rm -rf "$work"
    mkdir -p "$work/pressed/vtk"
    cp "$3/compressed.restart" "$3/time_step.in" "$3/settings.txt" "$3/breaks.csv" "$work/pressed/"
    awk -F, 'NR == 1 || $3 < 2.5' "$3/curve_raw.csv" >"$work/pressed/curve_raw.csv"
    for v in "1 0.0125 0.05 0.1" "4 0.00625 0.0125 0.025" "8 0.00625 0.01 0.0125"; do # up to 0.1 um of travel
      read -r speed short middle longest <<<"$v"
      for w in $short $middle $longest; do release "$speed" "$w"; done
      platen 0.05 "$work"/release_"$speed"_* | within "$speed m/s, windows $short to $longest us, 5 %" 3
    done
    both_walls 0.1 "$work"/release_{1_0.1,4_0.025,8_0.0125} | within "1, 4 and 8 m/s, windows of 0.1 um, 10 % on both walls" 3 ;;
  bank)
    [ "${CALENDEM_HEAVY:-0}" = 1 ] || { echo "skipped: release.bank runs with tools/test --all"; exit 77; }
    bin=$2 work=$3 electrode=$3/electrode
    settings=(-var speed_m_s 2 -var touch_speed_m_s 2 -var vtk_every_us 1000 -var restart_every_us 1000)
    mkdir -p "$work"
    "$bin/calendem" pack "$scripts/cases/films/electrode.toml" -o "$electrode" --ranks 1 --force
    rm -rf "$work/pressed"
    mkdir -p "$work/pressed/vtk"
    script in.compression "$work/pressed" "${settings[@]}"
    for v in "1 0.01 0.1" "4 0.01 0.025" "8 0.01 0.0125"; do
      read -r speed short longest <<<"$v"
      release "$speed" "$short"
      release "$speed" "$longest"
      for share in 0.01 0.02 0.05; do
        platen $share "$work"/release_"$speed"_* | within "$speed m/s, windows $short and $longest us, $share" 2
      done
    done
    both_walls 0.1 "$work"/release_{1_0.1,4_0.025,8_0.0125} | within "1, 4 and 8 m/s, windows of 0.1 um, 10 % on both walls" 3
    for v in "0.9 0.111" "1.1 0.0909" "1.4 0.0714" "5.6 0.0178" "7.2 0.0138" "8.8 0.0113"; do
      read -r speed window <<<"$v"
      release "$speed" "$window"
    done
    # 3.71: Student's t of 6 degrees of freedom at 1 % on both sides
    platen 0.01 "$work"/release_{0.9_*,1_0.1,1.1_*,1.4_*,5.6_*,7.2_*,8_0.0125,8.8_*} |
      means_agree "0.9 to 1.4 and 5.6 to 8.8 m/s, 0.01" 4 ;;
esac
