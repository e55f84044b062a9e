#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The tables of out/ as one page of Markdown.
set -eu
cd "$1"
table() { awk 'NR == 1 {n = split($0, unused, ","); for (i = 1; i <= n; i++) rule = rule "|---"} {gsub(/,/, " | "); print "| " $0 " |"} NR == 1 {print rule "|"}' "$1"; }
cat << 'EOF'
# Scaling

Iterations to 1e-8:

EOF
awk -F, 'NR > 1 {if (!($2 in k)) {k[$2] = ++n; name[n] = $2}; v[$1, $2] = $3; if (!($1 in s)) {s[$1] = 1; row[++m] = $1}}
  END {line = "| subdomains"; rule = "|---"; for (i = 1; i <= n; i++) {line = line " | " name[i]; rule = rule "|---"} print line " |"; print rule "|"
  for (j = 1; j <= m; j++) {line = "| " row[j]; for (i = 1; i <= n; i++) line = line " | " (((row[j], name[i]) in v) ? v[row[j], name[i]] : ""); print line " |"}}' iterations.csv
for t in "balance:Vehicle M, partition" "runs:Vehicle M, five steps: seconds, counts, bytes of the rank with most" "weak:Weak scaling" "model:Efficiency, vehicle M" "turning:A free bar, turning: the whole tangent and its symmetric part" "peer:Scenes A and B, CalculiX beside hilo (seconds of processor)"; do
  printf '\n%s:\n\n' "${t#*:}"; table "${t%%:*}.csv"
done
