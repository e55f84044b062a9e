#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The scene and the commands of README.md, as they stand there, and the two other words that it names.  Usage: readme.sh REPO BIN
set -euo pipefail
repo=$(realpath "$1") bin=$(realpath "$2")
export PATH=$bin:$PATH
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
fail() { echo "readme: $*" >&2; exit 1; }
ln -s "$repo/data" data
# block LANGUAGE: the first block of it
block() { awk -v begin="\`\`\`$1" '$0 == begin {on = 1; next} /^```$/ {if (on) exit} on' "$repo/README.md"; }
block toml > scene.toml
block sh > commands.sh
[ "$(wc -l < scene.toml)" -le 10 ] || fail "the scene has more than ten lines"
bash -euo pipefail commands.sh > /dev/null
[ "$(head -c 8 fall.png | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "no picture was drawn"
# a pendulum, whatever word the arm has: from rest at the horizontal the block has come down by the same angle, to some percent
for word in rigid linear nonlinear; do
  hilo-tag --quiet mesh.h5 --$word arm --rigid block -o tags.h5
  hilo-solve --quiet scene.toml tags.h5 -o $word.h5
  hilo-show --check $word.h5 > /dev/null
  hilo-post series $word.h5 momentum.Lz | tail -n 1 | awk -F, '{print $NF}' > $word.txt
done
# the moment of momentum about the hinge is the impulse of the weight: the same to 2 %
paste rigid.txt linear.txt nonlinear.txt | awk '{a = $2/$1 - 1; b = $3/$1 - 1; if (a < 0) a = -a; if (b < 0) b = -b; exit !(a < .02 && b < .02 && $1 < 0)}' ||
  fail "the moment of momentum differs: $(paste rigid.txt linear.txt nonlinear.txt)"
