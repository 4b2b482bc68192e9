# Root mean square of (P - P_ref) / P_ref at equal displacement, compression only, where P_ref is above
# `above` MPa; P interpolated, both averaged over `window` um of travel.
#   awk -v above=5 -v window=0.5 -f rms_difference.awk REFERENCE/curve.csv OTHER/curve.csv
BEGIN { FS = "," }
FNR == 1 {
  ++file
  for (i = 1; i <= NF; ++i) column[$i] = i
  next
}
$column["stage"] == "compression" {
  k = ++rows[file]
  d[file, k] = $column["displacement_um"]
  p[file, k] = $column["pressure_MPa"]
}
function pressure(f, at, k) { # linear between rows, which are in order
  k = last[f] ? last[f] : 1
  while (k > 1 && d[f, k] > at) --k
  while (k < rows[f] - 1 && d[f, k + 1] < at) ++k
  last[f] = k
  return p[f, k] + (p[f, k + 1] - p[f, k]) * (at - d[f, k]) / (d[f, k + 1] - d[f, k])
}
function smooth(f, at, s, sum) {
  sum = 0
  for (s = 0; s < 10; ++s) sum += pressure(f, at - window * s / 9)
  return sum / 10
}
END {
  end = d[1, rows[1]] < d[2, rows[2]] ? d[1, rows[1]] : d[2, rows[2]]
  for (at = window + 0.1; at <= end; at += 0.1) {
    reference = smooth(1, at)
    if (reference <= above) continue
    other = smooth(2, at)
    sum += ((other - reference) / reference) ^ 2
    level_other += other
    level_reference += reference
    ++n
  }
  printf "%.4f over %d points; mean pressure %.3f of the reference's\n", sqrt(sum / n), n, level_other / level_reference
}
