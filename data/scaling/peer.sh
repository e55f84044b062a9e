#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Beside CalculiX, one thread, in turn: scene A on the same meshes of linear hexahedra (C3D8I, hex8), the finest once, the others best of
# two; the least work of either that gives the tip to 0.1 % (C3D20R 20x1x1; accuracy.toml).  hilo alone: 240x12x12, and scene B, a tube.
# Processor seconds in all, start included; per Newton iteration, hilo's without the start.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd); cd "$1"
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
TIMEFORMAT='%3U %3S'
spent() { { time "$@" > log 2>&1; } 2> clock || { cat log >&2; exit 1; }; awk '{printf "%.3f", $1 + $2}' clock; }
number() { sed -n "s/.*\"$1\": \([-0-9.e+]*\).*/\1/p" peer.json | head -1; }

calculix() {  # mesh, element
  local name=${1// /x} all iterations unknowns
  "$here/bar.sh" $1 4 "$2" ccx > "ccx-$name.inp"
  all=$(spent ccx -i "ccx-$name")
  iterations=$(grep -c '^ *iteration *[0-9]' log)
  unknowns=$(awk '/^\*/ {at = $0} /^[0-9]/ && at ~ /^\*NODE, NSET/ {n++} /^[0-9]/ && at == "*NSET, NSET=root" {n--} END {print 3 * n}' "ccx-$name.inp")
  awk -v head="CalculiX $2,$name,$unknowns" -v all="$all" -v n="$iterations" '
    NF == 4 && $1 ~ /^[0-9]+$/ {s += $4; m++} END {printf "%s,%.3f,%.5f,%d,%.4f\n", head, all, s / m, n, all / n}' "ccx-$name.dat"
}
hilo() {  # row, mesh, deck, region, scene, options
  local all
  hilo-import --quiet "$3" -o peer-mesh.h5 --regions "$4" > /dev/null
  all=$(spent hilo-solve --quiet "$here/$5" peer-mesh.h5 -o peer.h5 "${@:6}")
  hilo-post series peer.h5 probe.tip | tail -1 | awk -F, -v head="$1,$2,$(number unknowns)" -v all="$all" -v n="$(number newton_iterations)" \
    -v own="$(number processor_seconds)" '{printf "%s,%.3f,%.5f,%d,%.4f\n", head, all, $4, n, own / n}'
}
linear() {  # mesh, row, options
  local name=${1// /x}
  "$here/bar.sh" $1 > "bar-$name.inp"; hilo "${2:-hilo hex8}" "$name" "bar-$name.inp" bar bar.toml "${@:3}"
}
best() { for k in 1 2; do "$@"; done | sort -t, -k4g | head -1; }

# Times as fast as CalculiX on the mesh before, or as its cheapest way to the accuracy.
ratio() {
  awk -F, '{faster = ""} $1 ~ /^CalculiX/ {theirs = $4; mesh = $2} $1 ~ /^hilo/ && ($2 == mesh || $1 == "hilo best") {faster = sprintf("%.3g", theirs / $4)}
    {print $0 "," faster; fflush()}'
}
{
  for mesh in "40 2 2" "80 4 4"; do best calculix "$mesh" C3D8I; best linear "$mesh"; done
  calculix "160 8 8" C3D8I
  best linear "160 8 8"
  linear "240 12 12"
  linear "240 12 12" "hilo hex8 to 1e-10" --set solver.tolerance=1e-10
  best calculix "20 1 1" C3D20R
  "$here/bar.sh" 16 1 1 4 C3D20 > bar-20.inp
  best hilo "hilo best" "16x1x1 hex20" bar-20.inp bar accuracy.toml
  "$here/tube.sh" > tube.inp
  best hilo "hilo hex8" "tube 24x6x178" tube.inp tube tube.toml
} | {
  echo "code,mesh,unknowns,seconds,tip,iterations,seconds per iteration,times faster"
  ratio
}
