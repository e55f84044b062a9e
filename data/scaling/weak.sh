#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Weak scaling: scene A with CELLS (40 8 8) hexahedra for each of RANKS ranks (1 2 4), the bar as much longer; BDDC, five steps.  Best of three,
# in turn.  Meshes weak-N.h5 that are there are taken as they are.
set -eu
here=$(cd "$(dirname "$0")" && pwd); cd "$1"
RANKS=${RANKS:-1 2 4}; read -r nx ny nz <<< "${CELLS:-40 8 8}"
for n in $RANKS; do
  [ -e weak-$n.h5 ] || { "$here/bar.sh" $((nx * n)) $ny $nz $n > weak-$n.inp; hilo-import --quiet weak-$n.inp -o weak-$n.h5 --regions bar > /dev/null; }
  hilo-part --quiet weak-$n.h5 -n $n -o weak-parts-$n.h5 2> /dev/null > /dev/null
done
of() { sed -n "s/.*\"$2\": {.*\"$3\": \([-0-9.e+]*\).*/\1/p" "$1" | tail -1; }
number() { sed -n "s/.*\"$2\": \([-0-9.e+]*\).*/\1/p" "$1" | head -1; }
for k in 1 2 3; do
  for n in $RANKS; do
    run=(); [ $n = 1 ] || run=(mpirun -n $n)
    "${run[@]}" hilo-solve --quiet "$here/bar.toml" weak-parts-$n.h5 -o weak-run-$n.h5 --set time.end=0.005 --set output.interval=0.005 \
      --set 'solver.kind="bddc"' 2> log
    j=weak-run-$n.json
    echo "$n,$(number $j unknowns),$(of $j all seconds),$(of $j assembly seconds),$(of $j set-up seconds),$(of $j solve seconds),$(number $j solves),$(number $j linear_iterations)"
  done
done | sort -t, -k1n -k3n | awk -F, 'BEGIN {print "ranks,unknowns,all,assembly,set_up,solve,solves,iterations"} !seen[$1]++'
