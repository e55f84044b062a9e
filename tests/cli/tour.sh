#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs every sh block of docs/tour.md and docs/tour-assembly.md in one folder that holds the tour's STEP file, and the Python block, for which
# `make -C tests` installs h5py.
# Usage: tour.sh REPO BIN
set -euo pipefail
repo=$(realpath "$1")
bin=$(realpath "$2")
export PATH=$bin:$PATH
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp "$repo/data/tour/arm.step" "$repo/data/tour/slider.geo" "$folder"
cd "$folder"
fail() { echo "tour: $*" >&2; exit 1; }
awk '/^```sh$/ {on = 1; next} /^```$/ {on = 0} on' "$repo/docs/tour.md" "$repo/docs/tour-assembly.md" > blocks.sh
awk '/^```python$/ {on = 1; next} /^```$/ {on = 0} on' "$repo/docs/tour.md" > read.py
sed -i 's/hilo-post movie [^ ]*/& --fps 4/' blocks.sh  # few pictures, or they are most of the time
bash -euo pipefail blocks.sh | tee said.txt
/usr/bin/python3 -c 'import h5py' || fail "the Python block of the tour needs h5py (apt install python3-h5py)"
/usr/bin/python3 read.py > read.txt
grep -q '^largest moment' read.txt || fail "the Python block of the tour says no largest moment"
"$repo/tests/cli/xdmf.py" run.xdmf
"$repo/tests/cli/vtkhdf.py" run.h5
# what the blocks say they write is there
for file in $(grep -oE -- '(-o|--png) [a-z0-9-]+\.[a-z0-9]+' blocks.sh | cut -d' ' -f2); do
  [ -s "$file" ] || fail "$file is missing"
done
# the text's own check: the peak is a little less than the beam formula's stress at the axis
peak=$(awk '/von_mises .MPa/ {getline; print $2}' said.txt)
beam=$(awk -F, '/by beam theory .MPa/ {getline; print $2}' said.txt)
awk -v p="$peak" -v b="$beam" 'BEGIN {exit !(p > 0.85 * b && p < b)}' || fail "peak $peak MPa, by beam theory $beam MPa"
# a rod of 120 mm on a crank of 40 mm
awk -F, 'NR == 2 {least = most = $2} NR > 1 {if ($2 < least) least = $2; if ($2 > most) most = $2}
  END {exit !(least > .07999 && least < .0801 && most > .1599 && most < .16001)}' slider.csv || fail "the slider does not go from 80 to 160 mm"
