#!/bin/bash
# Runs every sh block of docs/tour.md in one empty folder, and the Python block where h5py is there.  Usage: tour.sh REPO BIN
set -euo pipefail
repo=$1
export PATH=$2:$PATH
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
awk '/^```sh$/ {on = 1; next} /^```$/ {on = 0} on' "$repo/docs/tour.md" > tour-blocks.sh
awk '/^```python$/ {on = 1; next} /^```$/ {on = 0} on' "$repo/docs/tour.md" > read.py
bash -euo pipefail tour-blocks.sh
if /usr/bin/python3 -c 'import h5py' 2>/dev/null; then /usr/bin/python3 read.py; fi
for f in run.h5 run.xdmf run.json model.png vm.png two.png arm.mp4 hinge.csv hinge.png gload.csv gload.png; do
  [ -s "$f" ] || { echo "tour: $f is missing" >&2; exit 1; }
done
