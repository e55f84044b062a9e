# designs.csv as a table for people.  A design marked * is on the front: no other is at least as good in mass, stress and DRI and better in one.
BEGIN { FS = "," }
NR == 1 { next }
{
  n = NR - 1
  for (i = 1; i <= 9; ++i) value[n, i] = $i
  message[n] = $10
  for (i = 11; i <= NF; ++i) message[n] = message[n] "," $i
  gsub(/^"|"$/, "", message[n]); gsub(/""/, "\"", message[n])
}
function dominated(a,    b, i, better, worse) {
  for (b = 1; b <= n; ++b) {
    if (value[b, 5] != "converged") continue
    better = worse = 0
    for (i = 6; i <= 8; ++i) { better += value[b, i] + 0 < value[a, i] + 0; worse += value[b, i] + 0 > value[a, i] + 0 }
    if (better && !worse) return 1
  }
  return 0
}
END {
  printf "  %-18s %9s %9s %9s  %s\n", "design", "mass [kg]", "[MPa]", "DRI", "state"
  for (a = 1; a <= n; ++a) {
    failed += value[a, 5] != "converged"
    if (value[a, 5] == "converged")
      printf "%s %-18s %9s %9s %9s  converged\n", dominated(a) ? " " : "*", value[a, 1], value[a, 6], value[a, 7], value[a, 8]
    else
      printf "  %-18s %9s %9s %9s  failed, exit %s: %s\n", value[a, 1], "-", "-", "-", value[a, 9], message[a]
  }
  printf "%d designs, %d failed; *: none is better in one of mass, stress and DRI and as good in the others\n", n, failed
}
