#!/bin/bash
# Scene A by CalculiX (C3D8I) and hilo (hex8, solver by itself), one thread, on one mesh, in turn, best of two.  Seconds in all.
set -eu
here=$(cd "$(dirname "$0")" && pwd); cd "$1"
export OMP_NUM_THREADS=1
echo "code,mesh,unknowns,seconds,tip"
for mesh in "40 2 2" "80 4 4"; do
  name=${mesh// /x}; IFS=' ' read -r nx ny nz <<< "$mesh"
  "$here/bar.sh" $mesh > "bar-$name.inp"; "$here/bar.sh" $mesh 4 ccx > "ccx-$name.inp"
  hilo-import --quiet "bar-$name.inp" -o "bar-$name.h5" --regions bar > /dev/null
  for k in 1 2; do
    start=$(date +%s%N); ccx -i "ccx-$name" > "ccx-$name.log"; end=$(date +%s%N)
    tip=$(awk 'NF == 4 && $1 ~ /^[0-9]+$/ {s += $4; n++} END {printf "%.5f", s / n}' "ccx-$name.dat")
    echo "CalculiX C3D8I,$name,$((3 * (nx + 1) * (ny + 1) * (nz + 1))),$(((end - start) / 1000000))e-3,$tip"
    start=$(date +%s%N); hilo-solve --quiet "$here/bar.toml" "bar-$name.h5" -o "hilo-$name.h5"; end=$(date +%s%N)
    tip=$(hilo-post series "hilo-$name.h5" probe.tip | tail -1 | awk -F, '{printf "%.5f", $4}')
    echo "hilo hex8,$name,$((3 * (nx + 1) * (ny + 1) * (nz + 1))),$(((end - start) / 1000000))e-3,$tip"
  done
done | sort -t, -k2,2 -k1,1 -k4,4g | awk -F, '!seen[$1, $2]++'
