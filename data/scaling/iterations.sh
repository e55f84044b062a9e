#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Iterations by number of subdomains, all in one process: BDDC to a relative residual of 1e-8, FETI-DP to 1e-8 of the dual residual, the
# most of any solve with the flexible part.  A block of 20 x 20 x 20 cubes between two bodies, one of them on a joint, a third joint at a
# node; jumps of 1e4 in as many scattered regions as there are subdomains, with which their borders have nothing in common.
set -eu
bench() { substructuring-bench 20 20 20 "$@" | tail -1 | sed -n '/FAILED/! s/.* \([0-9]*\) iterations.*/\1/p'; }
echo "subdomains,case,iterations"
for n in 2 4 8 16 32 64 128; do
  while read -r name kind; do
    echo "$n,$name static,$(bench 1e6 "$kind" $n)"
    echo "$n,$name CFL 50,$(bench 50 "$kind" $n)"
    echo "$n,$name static jumps of 1e4,$(bench 1e6 "$kind" $n 1e4)"
  done <<< $'BDDC bddc\nFETI-DP feti-dp'
done
