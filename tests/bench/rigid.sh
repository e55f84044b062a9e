#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Small scenes, one thread: microseconds per step, and seconds to start; where simbody-bench is built, rigid ones beside Simbody.
# Usage: rigid.sh BIN
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
  printf '[[probe]]\nname = "B0"\non = "c0"\nat = [0, 1, 0]\n'
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

# Beside Simbody: the same scenes and steps, processor time of both, errors against the same positions, the energy at every step.
[ -x "$1/simbody-bench" ] || exit 0
export OPENBLAS_NUM_THREADS=1
row() { printf '%-16s %-34s %8s %8s %10s %10s %10s\n' "$@"; }
hilo() {  # name, name in simbody-bench, method, probe, scene, options: the fastest of five
  "$1/simbody-bench" "$3" reference > places
  for k in 1 2 3 4 5; do
    "$1/hilo-solve" --quiet "$6" -o run.h5 --set "time.integrator=\"$4\"" "${@:7}" 2> /dev/null
    awk -F'[:,]' '/"steps"/ {n = $2} /"processor_seconds"/ {print n, $2 / n * 1e6}' run.json
  done | sort -k2g | head -1 > cost
  "$1/hilo-post" series run.h5 "probe.$5" | awk -F'[ ,]' 'NR == FNR {t[NR] = $1; x[NR] = $2; y[NR] = $3; z[NR] = $4; next}
    FNR > 1 {for (k in t) if (($1 - t[k]) ^ 2 < 1e-16) {e = ($2 - x[k]) ^ 2 + ($3 - y[k]) ^ 2 + ($4 - z[k]) ^ 2; seen++; if (e > most) most = e}}
    END {if (seen != 10) exit 1; printf "%.2g\n", sqrt(most)}' places - > error
  "$1/hilo-post" series run.h5 energy | awk -F, 'NR == 2 {E = $2 + $3 + $4} NR > 1 {d = $2 + $3 + $4 - E; d = d < 0 ? -d : d; if (d > most) most = d}
    END {printf "%.2g\n", most}' > drift
  row "$2" "hilo $4" "$h" $(awk '{printf "%d %.1f", $1, $2}' cost) "$(cat error)" "$(cat drift)"
}
simbody() {  # name, name in simbody-bench, method, fixed or accuracy, value
  result=$(timeout 120 "$1/simbody-bench" "${@:3:4}" | head -1) || result="failed: too long"
  [ "${result#failed}" = "$result" ] || result="fails - - -"
  local what=$([ "$5" = fixed ] && echo "$6" || echo var)
  row "$2" "Simbody $4${7:-}$([ "$5" = fixed ] || echo ", accuracy $6")" "$what" $result
}
beside() {  # name, name in simbody-bench, probe, scene, step, end
  h=$6
  hilo "$1" "$2" "$3" energy-momentum "$4" "$5" --set "time.step=$6" --set "time.end=$7"
  [ "$3" = top ] || hilo "$1" "$2" "$3" mid-point "$4" "$5" --set "time.step=$6" --set "time.end=$7"  # the default without its clock
  [ "$3" = forty ] || hilo "$1" "$2" "$3" radau "$4" "$5" --set "time.step=$6" --set "time.end=$7"
  for m in euler merson; do simbody "$1" "$2" "$3" $m fixed "$6"; done
  simbody "$1" "$2" "$3" merson accuracy 1e-5
}
printf '\n'
row scene "code, method" step steps us/step "error [m]" "|dE| [J]"
beside "$1" "heavy top" top tip "$scenes/top.toml" 0.001 2
beside "$1" "double four-bar" double B0 "$scenes/double_four_bar.toml" 0.01 10
beside "$1" Bricard bricard far "$scenes/bricard.toml" 0.01 10
simbody "$1" Bricard bricard-as-given merson fixed 0.01 ", redundant row too"
beside "$1" "40 four-bars" forty B0 forty.toml 0.01 10
