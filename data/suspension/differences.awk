# Of each column of two runs with the same steps: at rest, greatest size, the greatest difference and when.
#   awk -f differences.awk rigid.csv flexible.csv
BEGIN { FS = "," }
FNR == 1 { ++file; n = split($0, name, ","); next }
{
  for (i = 2; i <= n; ++i) {
    if (FNR == 2) rest[file, i] = $i
    if (abs($i) > peak[file, i]) peak[file, i] = abs($i)
    if (file == 1) { v[FNR, i] = $i; continue }
    d = abs($i - v[FNR, i])
    if (d > off[i]) { off[i] = d; when[i] = $1 }
  }
}
function abs(x) { return x < 0 ? -x : x }
END {
  printf "%-24s %10s %10s %10s %10s %10s %8s\n", "", "at rest", "", "peak", "", "differ", "at t [s]"
  printf "%-24s %10s %10s %10s %10s %10s\n", "", "rigid", "flexible", "rigid", "flexible", "by"
  for (i = 2; i <= n; ++i)
    printf "%-24s %10.4f %10.4f %10.4f %10.4f %10.4f %8.3f\n", name[i], rest[1, i], rest[2, i], peak[1, i], peak[2, i], off[i], when[i]
}
