#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A free bar of 80 x 4 x 4 hexahedra, turning: Newton's and linear iterations with the whole tangent (GMRES, "iterative") and with its
# symmetric part ("cg"), which hands over to the former where parts turn far in a step.
set -eu
here=$(cd "$(dirname "$0")" && pwd); cd "$1"
number() { sed -n "s/.*\"$1\": \([-0-9.e+]*\).*/\1/p" turning.json | head -1; }
"$here/bar.sh" 80 4 4 > turning.inp
hilo-import --quiet turning.inp -o turning-mesh.h5 --regions bar > /dev/null
echo "turn in a step [rad],solver,newton iterations,linear iterations"
for step in 0.0005 0.001 0.01; do
  for kind in iterative cg; do
    hilo-solve --quiet "$here/turning.toml" turning-mesh.h5 -o turning.h5 --set time.step=$step --set solver.kind=$kind 2> log
    echo "$(awk -v h=$step 'BEGIN {print h * sqrt(3^2 + 15^2 + 10^2)}'),$kind,$(number newton_iterations),$(number linear_iterations)"
  done
done
