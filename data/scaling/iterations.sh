#!/bin/bash
# Iterations by number of subdomains: BDDC to a relative residual of 1e-8, all subdomains in one process; FETI-DP, one subdomain on each
# rank, the most of any solve with the flexible part, to 1e-10 of the dual residual.  A block of 20 x 20 x 20 cubes between two bodies, one
# of them on a joint, a third joint at a node; jumps of 1e4 in as many scattered regions as there are subdomains, with which their borders
# have nothing in common.
set -eu
bench() { substructuring-bench 20 20 20 "$@" | tail -1 | sed -n '/FAILED/! s/.* \([0-9]*\) iterations.*/\1/p'; }
fetidp() {
  PETSC_OPTIONS=-hilo_fetidp_ksp_converged_reason mpirun -n "$2" substructuring-bench 20 20 20 "$1" feti-dp "$2" |
    awk '/hilo_fetidp_/ {if ($NF + 0 > most) most = $NF + 0} END {print most}'
}
echo "subdomains,case,iterations"
for n in 2 4 8 16 32 64 128; do
  echo "$n,BDDC static,$(bench 1e6 bddc $n)"
  echo "$n,BDDC CFL 50,$(bench 50 bddc $n)"
  echo "$n,BDDC static jumps of 1e4,$(bench 1e6 bddc $n 1e4)"
done
for n in 2 4 8; do
  echo "$n,FETI-DP static,$(fetidp 1e6 $n)"
  echo "$n,FETI-DP CFL 50,$(fetidp 50 $n)"
done
