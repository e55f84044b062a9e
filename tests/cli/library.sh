#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The libraries as hilo-dev installs them: a program outside the tree finds, compiles and runs them.  Usage: library.sh REPO BUILD
set -euo pipefail
repo=$(realpath "$1") build=$(realpath "$2")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cmake --install "$build" --prefix "$folder/usr" --component dev > "$folder/log" || { cat "$folder/log"; exit 1; }
! grep -rlF -e "$repo/" -e "$build/" "$folder"/usr/lib/cmake || { echo "library: the targets name the source tree"; exit 1; }
cmake -S "$repo/tests/library" -B "$folder/build" -DCMAKE_PREFIX_PATH="$folder/usr" > "$folder/log" || { cat "$folder/log"; exit 1; }
cmake --build "$folder/build" > "$folder/log" || { cat "$folder/log"; exit 1; }
cd "$folder" && build/pendulum && build/own_material
