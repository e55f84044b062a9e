#!/bin/bash
# A chain of twenty rigid bodies: microseconds per Newton iteration, and seconds to start.  Usage: rigid.sh BIN
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
{
  printf 'gravity = [0, 0, -9.81]\n[time]\nend = 1\nstep = 0.002\n'
  for i in $(seq 0 19); do
    a=$([ "$i" = 0 ] && echo ground || echo "b$((i - 1))")
    printf '[[body]]\nname = "b%d"\nmass = 1\ncom = [%d.5, 0, 0]\ninertia = [0.01, 0.09, 0.09]\n' "$i" "$i"
    printf '[[joint]]\nname = "j%d"\na = "%s"\nb = "b%d"\nat = [%d, 0, 0]\n' "$i" "$a" "$i" "$i"
    if [ $((i % 2)) = 0 ]; then printf 'kind = "revolute"\naxis = [0, 1, 0]\n'; else printf 'kind = "spherical"\n'; fi
  done
} > chain.toml
for k in 1 2 3 4 5; do
  "$1/hilo-solve" --quiet chain.toml -o chain.h5
  awk -F'[:,]' '/newton_iterations/ {n = $2} /"seconds"/ {split($0, s, /"all": |, "assembly": |, "solve": |, "output": |}/); printf "chain of 20: %.1f us per Newton iteration in all, %.1f assembly, %.1f solve\n", s[2] / n * 1e6, s[3] / n * 1e6, s[4] / n * 1e6}' chain.json
done
for k in 1 2 3; do
  start=$(date +%s%N)
  "$1/hilo-solve" --quiet --dry-run chain.toml
  echo "start-up with the scene read and checked: $((($(date +%s%N) - start) / 1000)) us"
done
