#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the example lines at the end of every --help, of each tool and each subcommand, as printed (movies with four pictures a second), in
# a folder that holds the files they name.  What an example writes serves the next ones.  Usage: help_examples.sh REPO BIN
set -euo pipefail
repo=$(realpath "$1")
bin=$(realpath "$2")
export PATH=$bin:$PATH
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
export PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe OMPI_MCA_btl_tcp_disable_family=6 OPENBLAS_NUM_THREADS=1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
fail() { echo "help_examples: $*" >&2; exit 1; }

cp "$repo/data/firing/vehicle.geo" .
cp "$repo/data/tour/arm.step" .

cat > bracket.inp << 'END'
*NODE, NSET=ALL
1, 0, 0, 0
2, 10, 0, 0
3, 10, 10, 0
4, 0, 10, 0
5, 0, 0, 10
6, 10, 0, 10
7, 10, 10, 10
8, 0, 10, 10
*ELEMENT, TYPE=C3D8, ELSET=BRACKET
1, 1, 2, 3, 4, 5, 6, 7, 8
*MATERIAL, NAME=STEEL
*ELASTIC
210000., .3
*DENSITY
7.85e-9
*SOLID SECTION, ELSET=BRACKET, MATERIAL=STEEL
END

# Four blocks in a row: wheel, hull, arm, wheel.
cat > row.geo << 'END'
h = 0.02;
Point(1) = {0, -h, -h}; Point(2) = {0, h, -h}; Point(3) = {0, h, h}; Point(4) = {0, -h, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1:4} = 3; Transfinite Surface {1}; Recombine Surface {1};
a[] = Extrude {0.1, 0, 0} {Surface{1}; Layers{2}; Recombine;};
b[] = Extrude {0.1, 0, 0} {Surface{a[0]}; Layers{2}; Recombine;};
c[] = Extrude {0.4, 0, 0} {Surface{b[0]}; Layers{8}; Recombine;};
d[] = Extrude {0.1, 0, 0} {Surface{c[0]}; Layers{2}; Recombine;};
Physical Volume("wheel_1") = {a[1]};
Physical Volume("hull") = {b[1]};
Physical Volume("arm") = {c[1]};
Physical Volume("wheel_2") = {d[1]};
Physical Surface("hub") = {1};
END
hilo-import --quiet row.geo -o mesh.h5 > /dev/null

cat > scene.toml << 'END'
title = "an arm on a hinge"
mesh = "tags.h5"
gravity = [0, 0, -9.80665]

[material.alloy]
E = 7e9
nu = 0.3
density = 2700

[region."*"]
material = "alloy"

[section.rod]
kind = "circle"
diameter = 0.01

[beam.mast]
points = [[0, 0.2, 0], [0, 0.2, 0.3]]
cells = [2]
section = "rod"
material = "alloy"
a = "ground"

[[joint]]
kind = "revolute"
name = "hinge"
a = "ground"
b = "hub"
at = [0, 0, 0]
axis = [0, 1, 0]

[[sensor]]
name = "seat"
on = "wheel_2"

[[probe]]
name = "tip"
on = "wheel_2"

[[quantity]]
name = "hinge"
kind = "peak"
joint = "hinge"
tolerance = "50%"

[time]
end = 0.1
step = 1e-3
END

# examples COMMAND...: the lines of its --help behind "Example:"
examples() { "$@" --help | sed -n '/^Example:/,$p' | sed '1d; s/^ *//; /^$/d'; }

count=0
try() {
  local lines
  lines=$(examples "$@")
  [ -n "$lines" ] || fail "$* --help has no example"
  while IFS= read -r line; do
    # movies of few pictures, or they are most of the time
    if ! bash -euo pipefail -c "$(sed 's/hilo-post movie [^ ]*/& --fps 4/' <<< "$line")" < /dev/null > out.txt 2> err.txt; then
      cat out.txt err.txt >&2
      fail "example of $* --help does not run: $line"
    fi
    # what it says it writes is there
    local word previous=
    eval "set -- $line"
    for word; do
      case "$previous" in -o | --png) [ -s "$word" ] || fail "no $word after: $line" ;; esac
      previous=$word
    done
    echo "ran: $line"
    count=$((count + 1))
  done <<< "$lines"
}

try hilo-import
try hilo-tag
try hilo-part
try hilo-show
try hilo-solve
subcommands=$(hilo-post --help | sed -n '/^Subcommands:/,/^$/p' | awk 'NR > 1 && NF {print $1}')
[ -n "$subcommands" ] || fail "hilo-post --help lists no subcommand"
for subcommand in $subcommands; do try hilo-post "$subcommand"; done
try hilo-post
for tool in "$bin"/hilo-*; do
  case "${tool##*/}" in
    hilo-import | hilo-tag | hilo-part | hilo-show | hilo-solve | hilo-post) ;;
    *) [ ! -x "$tool" ] || [ -d "$tool" ] || try "${tool##*/}" ;;
  esac
done
echo "$count examples ran"
