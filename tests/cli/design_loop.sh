#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The design loop in a folder of its own, cut to 5 ms: designs that cannot be are reported with exit code and message and do not stop the
# sweep; a changed number redoes its own design alone; a changed scene redoes no mesh.  Usage: design_loop.sh REPO BIN
set -euo pipefail
repo=$(realpath "$1")
bin=$(realpath "$2")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/data"
cp "$repo/.setup" "$folder"
cp "$repo/data/common.mk" "$folder/data"
cp -r "$repo/data/design-loop" "$folder/data"
cd "$folder/data/design-loop"
rm -rf out
sed -i 's/^end = .*/end = 0.005/' scene.toml
fail() { echo "design_loop: $*" >&2; exit 1; }
loop() { make --no-print-directory BUILD="$(dirname "$bin")" BIN="$bin" BUILT=1 "$@"; }
# stages a dry run would do: "out/mesh/t8 out/t8_k100_c6 out/t8_k100_c6/run"
planned() { loop -n "$@" > plan.txt; sed -n 's/.*attempt \(out[^ ]*\).*/\1/p' plan.txt | sed 's/[./]status$//' | sort | paste -sd ' '; }
same() { [ "$2" = "$3" ] || fail "$1: \"$2\" instead of \"$3\""; }

printf '8 100 6\n8 75 6\n-8 100 6\n8 100 -6\n8 0 4\n' > sweep.txt
loop -j2 > log.txt 2>&1 || { cat log.txt; fail "the sweep ended with $?"; }
cat out/sweep.txt
same "lines of the table" "$(grep -c converged out/sweep.txt) $(grep -c 'failed, exit' out/sweep.txt)" "2 3"
row() { grep "^$1," out/sweep.csv; }
expect() { [[ $(row "$1") == $2 ]] || fail "$(row "$1") is not $2"; }
expect t-8_k100_c6 '*,failed,,,,2,"hilo-import: gun.geo: *-0.008 m thick"'
expect t8_k100_c-6 '*,failed,,,,2,"hilo-solve: --set spring.recoil.damping=-6e3:*"'
expect t8_k0_c4 '*,failed,,,,2,"hilo-solve: scene.toml:*: a preload needs a stiffness*"'
expect t8_k100_c6 '*,converged,3[0-9].??,[0-9]*.?,[0-9].*,0,""'
[ -s out/sweep.png ] || fail "no chart"
# 8 mm weigh what the drawing says: two plates less bore and hole, arcs as polygons of a few cells
awk -F, '$1 == "t8_k100_c6" {
  pi = atan2(0, -1)
  area = 0.5 * (0.70 + 0.22) * 0.75 + pi * 0.11 ^ 2 / 2 - pi * (0.055 ^ 2 + 0.13 ^ 2)
  mass = 2 * 0.008 * area * 7850
  exit !($6 > 0.97 * mass && $6 < 1.03 * mass)
}' out/sweep.csv || fail "the cheeks weigh $(row t8_k100_c6 | cut -d, -f6) kg"

same "all is made" "$(planned)" ""
sed -i 's/^8 75 6/8 76 6/' sweep.txt
same "another stiffness" "$(planned)" "out/t8_k76_c6 out/t8_k76_c6/run"
sed -i 's/^8 76 6/9 75 6/' sweep.txt
same "another thickness" "$(planned)" "out/mesh/t9 out/t9_k75_c6 out/t9_k75_c6/run"
loop > log.txt 2>&1 || { cat log.txt; fail "the second sweep ended with $?"; }
same "done again" "$(grep -c ': done\|: failed' log.txt)" 3
row t9_k75_c6 | grep -q converged || fail "the new design is not in the table"
[ -z "$(row t8_k75_c6)" ] || fail "a design that was left out is still in the table"
touch scene.toml
planned > stages.txt
grep -q mesh stages.txt && fail "a changed scene makes meshes: $(cat stages.txt)"
same "a changed scene" "$(tr ' ' '\n' < stages.txt | grep -c run)" 5
# a scene from a pipe is the scene with the key set
sed 's/^mass = 95 .*/mass = 60/' scene.toml | "$bin/hilo-solve" --quiet - out/mesh/t8.h5 -o piped.h5
"$bin/hilo-solve" --quiet --set region.seat.mass=60 scene.toml out/mesh/t8.h5 -o set.h5
last() { "$bin/hilo-post" series "$1" sensor.driver probe.barrel | tail -n 1; }
same "a scene from a pipe" "$(last piped.h5)" "$(last set.h5)"
[ "$(last piped.h5)" != "$(last out/t8_k100_c6/run.h5)" ] || fail "another driver changes nothing"
echo "design loop: as promised"
