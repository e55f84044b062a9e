#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Vehicle L, a million hexahedra, eight steps of data/firing's `make L`, on RANKS ranks (2 4 8 16):  large.sh TAGS-L.h5 FOLDER.
# Seconds of the run and of its phases, iterations, and megabytes of the rank with most; from run.json.
set -eu
tags=$(realpath "$1") out=$(realpath "$2"); cd "$(dirname "$0")/../firing"
number() { sed -n "s/.*\"$2\": \([-0-9.e+]*\).*/\1/p" "$1" | head -1; }
of() { sed -n "s/.*\"$2\": {.*\"$3\": \([-0-9.e+]*\).*/\1/p" "$1" | tail -1; }
echo "ranks,kind,all,assembly,set_up,solve,output,rest,solves,iterations,peak_MB"
for n in ${RANKS:-2 4 8 16}; do
  hilo-part --quiet "$tags" scene.toml -n "$n" -o "$out/parts-L-$n.h5" > /dev/null
  for kind in ${KINDS:-cg}; do
    json=$out/run-L-$n-$kind.json
    mpirun -n "$n" hilo-solve --quiet scene.toml "$out/parts-L-$n.h5" -o "${json%.json}.h5" --set 'quantity=[]' --set 'time.start="as given"' --set time.step=2.5e-5 \
      --set time.end=2e-4 --set 'load.shot.history={t=[0,2.5e-3],value=[0,3e6]}' --set solver.tolerance=1e-7 --set output.interval=2e-4 \
      --set 'output.fields=["displacement"]' --set 'output.precision="single"' --set "solver.kind=\"$kind\"" 2> "$out/log" || cat "$out/log" >&2
    printf '%s,%s,%s' "$n" "$kind" "$(of "$json" all seconds)"
    for phase in assembly set-up solve output rest; do printf ',%s' "$(of "$json" $phase seconds)"; done
    printf ',%s,%s,%.0f\n' "$(number "$json" solves)" "$(number "$json" linear_iterations)" "$(($(number "$json" peak_memory_bytes) / 1000000))"
  done
done
