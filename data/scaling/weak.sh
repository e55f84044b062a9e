#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Weak scaling: scene A with 40 x 8 x 8 hexahedra for each rank, the bar as much longer; BDDC, five steps.  Best of three, in turn.
set -eu
here=$(cd "$(dirname "$0")" && pwd); cd "$1"
for n in 1 2 4; do
  "$here/bar.sh" $((40 * n)) 8 8 $n > weak-$n.inp
  hilo-import --quiet weak-$n.inp -o weak-$n.h5 --regions bar > /dev/null
  hilo-part --quiet weak-$n.h5 -n $n -o weak-parts-$n.h5 2> /dev/null > /dev/null
done
of() { sed -n "s/.*\"$2\": {.*\"$3\": \([-0-9.e+]*\).*/\1/p" "$1" | tail -1; }
number() { sed -n "s/.*\"$2\": \([-0-9.e+]*\).*/\1/p" "$1" | head -1; }
for k in 1 2 3; do
  for n in 1 2 4; do
    run=(); [ $n = 1 ] || run=(mpirun -n $n)
    "${run[@]}" hilo-solve --quiet "$here/bar.toml" weak-parts-$n.h5 -o weak-run-$n.h5 --set time.end=0.005 --set output.interval=0.005 \
      --set 'solver.kind="bddc"' 2> log
    j=weak-run-$n.json
    echo "$n,$(number $j unknowns),$(of $j all seconds),$(of $j assembly seconds),$(of $j set-up seconds),$(of $j solve seconds),$(number $j solves),$(number $j linear_iterations)"
  done
done | sort -t, -k1n -k3n | awk -F, 'BEGIN {print "ranks,unknowns,all,assembly,set_up,solve,solves,iterations"} !seen[$1]++'
