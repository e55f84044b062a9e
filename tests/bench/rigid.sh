#!/bin/bash
# Small scenes, one thread: microseconds per step, and seconds to start.  Usage: rigid.sh BIN
set -euo pipefail
scenes=$(cd "$(dirname "$0")/../../data/stability/scenes" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

# A chain of twenty bodies on revolutes and balls.
{
  printf 'gravity = [0, 0, -9.81]\n[time]\nend = 1\nstep = 0.002\n'
  for i in $(seq 0 19); do
    a=$([ "$i" = 0 ] && echo ground || echo "b$((i - 1))")
    printf '[[body]]\nname = "b%d"\nmass = 1\ncom = [%d.5, 0, 0]\ninertia = [0.01, 0.09, 0.09]\n' "$i" "$i"
    printf '[[joint]]\nname = "j%d"\na = "%s"\nb = "b%d"\nat = [%d, 0, 0]\n' "$i" "$a" "$i" "$i"
    if [ $((i % 2)) = 0 ]; then printf 'kind = "revolute"\naxis = [0, 1, 0]\n'; else printf 'kind = "spherical"\n'; fi
  done
} > chain.toml

# The four-bar of the IFToMM library with 40 loops: 81 rods, 121 revolutes, 120 of the 605 rows redundant.
{
  printf 'gravity = [0, -9.81, 0]\n[time]\nend = 2\nstep = 0.01\n'
  pin() { printf '[[joint]]\nkind = "revolute"\nname = "%s"\na = "%s"\nb = "%s"\nat = [%s, %s, 0]\naxis = [0, 0, 1]\n' "$@"; }
  third=0.08333333333333333
  for i in $(seq 0 40); do
    printf '[[body]]\nname = "c%d"\nmass = 1\ncom = [%d, 0.5, 0]\ninertia = [%s, 0.0001, %s]\n' "$i" "$i" $third $third
    printf '[[initial]]\non = ["c%d"]\nspin = [0, 0, -1]\nabout = [%d, 0, 0]\n' "$i" "$i"
    pin "A$i" ground "c$i" "$i" 0
  done
  for i in $(seq 1 40); do
    printf '[[body]]\nname = "k%d"\nmass = 1\ncom = [%d.5, 1, 0]\ninertia = [0.0001, %s, %s]\n' "$i" "$((i - 1))" $third $third
    printf '[[initial]]\non = ["k%d"]\nvelocity = [1, 0, 0]\n' "$i"
    pin "L$i" "c$((i - 1))" "k$i" "$((i - 1))" 1
    pin "R$i" "c$i" "k$i" "$i" 1
  done
} > forty.toml

# A pendulum of 200 hexahedra (50 x 2 x 2).
awk 'BEGIN {
  n = 0; print "*NODE"
  for (i = 0; i <= 50; i++) for (j = 0; j < 3; j++) for (k = 0; k < 3; k++) { id[i, j, k] = ++n; printf "%d, %.17g, %.17g, %.17g\n", n, i / 50, (j - 1) * .02, (k - 1) * .02 }
  print "*ELEMENT, TYPE=C3D8, ELSET=beam"
  for (i = 0; i < 50; i++) for (j = 0; j < 2; j++) for (k = 0; k < 2; k++)
    printf "%d, %d, %d, %d, %d, %d, %d, %d, %d\n", ++e, id[i, j, k], id[i+1, j, k], id[i+1, j+1, k], id[i, j+1, k], id[i, j, k+1], id[i+1, j, k+1], id[i+1, j+1, k+1], id[i, j+1, k+1]
  print "*NSET, NSET=root"
  for (j = 0; j < 3; j++) for (k = 0; k < 3; k++) printf "%d,\n", id[0, j, k]
}' > beam.inp
"$1/hilo-import" beam.inp -o beam.h5 --quiet --regions beam > /dev/null
cat > beam.toml <<'END'
mesh = "beam.h5"
gravity = [0, 0, -9.81]
[material.rubber]
E = 1e7
nu = 0.3
density = 1000
[region.beam]
material = "rubber"
[[joint]]
kind = "revolute"
name = "pin"
b = "root"
at = [0, 0, 0]
axis = [0, 1, 0]
[time]
end = 0.3
step = 1e-3
END

best() {  # name, scene, options: the fastest of five
  for k in 1 2 3 4 5; do
    "$1/hilo-solve" --quiet "$3" -o run.h5 "${@:4}" 2> /dev/null
    awk -F'[:,]' '/"steps"/ {steps = $2} /newton_iterations/ {n = $2}
      /"seconds": {"all"/ {split($0, s, /"all": |, "assembly": |, "solve": |, "output": |}/); print s[2] / steps * 1e6, n / steps, s[3] / steps * 1e6, s[4] / steps * 1e6, s[5] / steps * 1e6, s[2] / n * 1e6}' run.json
  done | sort -n | head -1 | awk -v name="$2" '{printf "%-24s %10.1f %10.2f %10.1f %10.1f %10.1f %14.1f\n", name, $1, $2, $3, $4, $5, $6}'
}
printf '%-24s %10s %10s %10s %10s %10s %14s\n' scene us/step tangents assembly solve output us/tangent
best "$1" "chain of 20" chain.toml
best "$1" "heavy top, h .001" "$scenes/top.toml" --set time.step=0.001 --set time.end=2
best "$1" "double four-bar, h .01" "$scenes/double_four_bar.toml" --set time.step=0.01 --set time.end=10
best "$1" "Bricard, h .01" "$scenes/bricard.toml" --set time.step=0.01 --set time.end=10
best "$1" "40 four-bars, h .01" forty.toml --set time.end=10
best "$1" "beam pendulum, h .001" beam.toml
for k in 1 2 3; do
  start=$(date +%s%N)
  "$1/hilo-solve" --quiet --dry-run chain.toml
  echo "start-up with the scene read and checked: $((($(date +%s%N) - start) / 1000)) us"
done
