#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Vehicle M, five steps from the drawn position by BDDC: on RANKS ranks (1 2 4), and on one rank with PARTS subdomains (2 to 128).  Best of three,
# taken in turn.  Seconds by phase, iterations, and of the rank with most: messages, sums over all ranks, bytes; from run.json.
set -eu
out=$(realpath "$1"); cd "$(dirname "$0")/../firing"
RANKS=${RANKS:-1 2 4} PARTS=${PARTS-2 4 8 16 32 64 128}
for n in ${RANKS/#1 /}; do hilo-part --quiet "$out/tags.h5" scene.toml -n $n -o "$out/parts-$n.h5" > /dev/null; done
number() { sed -n "s/.*\"$2\": \([-0-9.e+]*\).*/\1/p" "$1" | head -1; }
of() { sed -n "s/.*\"$2\": {.*\"$3\": \([-0-9.e+]*\).*/\1/p" "$1" | tail -1; }
line() {  # ranks, subdomains
  local mesh=$out/tags.h5 run=() json=$out/run-$1-$2.json
  [ "$1" = 1 ] || { mesh=$out/parts-$1.h5; run=(mpirun -n "$1"); }
  "${run[@]}" hilo-solve --quiet scene.toml "$mesh" -o "${json%.json}.h5" --set 'quantity=[]' --set 'time.start="as given"' --set time.step=1e-4 --set time.end=5e-4 \
    --set 'output.fields=["displacement"]' --set output.interval=5e-4 --set 'solver.kind="bddc"' --set solver.subdomains=$(($2 / $1)) 2> "$out/log"
  printf '%s,%s,%s' "$1" "$2" "$(of "$json" all seconds)"
  for phase in assembly set-up solve output rest; do printf ',%s' "$(of "$json" $phase seconds)"; done
  printf ',%s,%s,%s,%s,%s,%s,%s,%s,%s\n' "$(number "$json" undivided_seconds)" "$(number "$json" solves)" "$(number "$json" linear_iterations)" \
    "$(of "$json" all messages)" "$(of "$json" all collectives)" "$(of "$json" all bytes_sent)" "$(number "$json" solver_bytes)" \
    "$(number "$json" peak_memory_bytes)" "$(of "$json" assembly imbalance)"
}
for k in 1 2 3; do
  for n in $RANKS; do line $n $n; done
  for n in $PARTS; do line 1 $n; done
done | sort -t, -k1n -k2n -k3n | awk -F, 'BEGIN {print "ranks,subdomains,all,assembly,set_up,solve,output,rest,undivided,solves,iterations,messages,sums,bytes,solver_bytes,peak_bytes,imbalance"}
  !seen[$1, $2]++'
