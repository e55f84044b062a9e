#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# One run of the catalogue:  run.sh SCENE MESH|- OUT HISTORIES OPTIONS...   leaves OUT.h5, OUT.csv and OUT.exit.
# A run that stops by itself (exit 3) is what the catalogue looks for; any other fault ends make.
set -u
scene=$1 mesh=$2 out=$3 histories=$4
shift 4
[ "$mesh" = - ] && mesh=
hilo-solve --quiet "$scene" $mesh -o "$out.h5" --set solver.cuts=0 "$@" 2> "$out.log"
code=$?
echo $code > "$out.exit"
if [ $code != 0 ] && [ $code != 3 ]; then
  cat "$out.log" >&2
  exit $code
fi
hilo-post series "$out.h5" $histories -o "$out.csv" || exit
find "$out.h5" -size +4M -delete  # the long runs; their histories stay
