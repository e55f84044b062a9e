# For each column of the first file, the closed form: its peak, and how far the others are from it at most, in percent of the peak.
#   awk -f differences.awk closed.csv rigid.csv flexible.csv
BEGIN { FS = "," }
FNR == 1 { ++file; n = split($0, name, ","); next }
file == 1 { for (i = 2; i <= n; ++i) { v[$1 + 0 "", i] = $i; if (abs($i) > peak[i]) peak[i] = abs($i) } at[++rows] = $1 + 0; next }
{
  while (k[file] < rows - 1 && at[k[file] + 1] < $1 - 1e-3) ++k[file]
  a = at[k[file] + 1]
  if (abs(a - $1) > 1e-3) next                                       # an instant that the closed form does not have
  for (i = 2; i <= n; ++i) { d = abs($i - v[a "", i]); if (d > off[file, i]) off[file, i] = d; if (abs($i) > top[file, i]) top[file, i] = abs($i) }
}
function abs(x) { return x < 0 ? -x : x }
END {
  printf "%-28s %12s %12s %12s %14s %14s\n", "", "closed form", "rigid", "flexible", "rigid off by", "flexible"
  for (i = 2; i <= n; ++i)
    printf "%-28s %12.4f %12.4f %12.4f %13.4f%% %13.4f%%\n", name[i], peak[i], top[2, i], top[3, i], 100*off[2, i]/peak[i], 100*off[3, i]/peak[i]
}
