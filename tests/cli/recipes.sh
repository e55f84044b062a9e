#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the sh blocks of pages that are recipes, each page in a folder of its own, and checks what the pages say comes out.
# Usage: recipes.sh REPO BIN [PAGE ...]
set -euo pipefail
repo=$(realpath "$1") bin=$(realpath "$2")
shift 2
export PATH=$bin:$PATH
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
fail() { echo "recipes: $*" >&2; exit 1; }
[ $# -gt 0 ] || set -- scene bricks beside-calculix
for page; do
  mkdir "$place/$page" && cd "$place/$page"
  cp "$repo/data/tour/arm.step" .
  awk '/^```sh$/ {on = 1; next} /^```$/ {on = 0} on' "$repo/docs/$page.md" > blocks.sh
  [ -s blocks.sh ] || fail "docs/$page.md has no sh block"
  bash -euo pipefail blocks.sh > out.txt 2> err.txt || { cat out.txt err.txt; fail "docs/$page.md: a command fails"; }
  # what the blocks say they write is there
  for file in $(grep -oE -- '(-o|--png) [a-z0-9-]+\.[a-z0-9]+' blocks.sh | cut -d' ' -f2); do
    [ -s "$file" ] || fail "docs/$page.md: $file is missing"
  done
  echo "$page: $(grep -c . blocks.sh) lines"
done
