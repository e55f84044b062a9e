#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Geometry of gmsh's own tutorial from file to picture: t5.geo (a cube hung on one of its five spheres, now rigid bodies), t16.geo (nearly
# the same solid by Boolean operations) and t20_data.step (a part in millimetres), both in free fall.  Usage: gmsh_doc.sh REPO BIN
set -euo pipefail
bin=$(realpath "$2")
export PATH=$bin:$PATH
for tutorial in /usr/share/doc/gmsh-doc/doc/gmsh/tutorial{,s}; do [ ! -d "$tutorial" ] || break; done  # of Debian 12, 13
[ -d "$tutorial" ] || { echo "gmsh_doc: no $tutorial (apt-get install gmsh-doc)" >&2; exit 1; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
for file in t5.geo t16.geo t20_data.step; do
  if [ -e "$tutorial/$file" ]; then cp "$tutorial/$file" .; else gunzip -c "$tutorial/$file.gz" > "$file"; fi
done
fail() { echo "gmsh_doc: $*" >&2; exit 1; }

# scene NAME: everything of steel, gravity, ten steps to 0.01 s
scene() {
  cat > "$1.toml" << END
gravity = [0, 0, -9.80665]

[material.steel]
E = 210e9
nu = 0.3
density = 7850

[region."*"]
material = "steel"

[time]
end = 0.01
step = 1e-3
END
}

# solve_and_look NAME FIELD
solve_and_look() {
  hilo-solve --quiet "$1.toml" "$1-tags.h5" -o "$1-run.h5"
  hilo-show --check "$1-run.h5" > "$1-check.txt"
  hilo-post render "$1-run.h5" --field "$2" -o "$1.png"
  [ "$(head -c 8 "$1.png" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "$1.png is not a PNG"
  [ "$(stat -c %s "$1.png")" -gt 15000 ] || fail "$1.png shows next to nothing: $(stat -c %s "$1.png") bytes"
}

# last RUN COLUMN: the last value of a history
last() { hilo-post series "$1" "$2" | tail -n 1 | awk -F, '{print $NF}'; }

# near WHAT VALUE TRUTH RELATIVE
near() { awk -v a="$2" -v b="$3" -v r="$4" 'BEGIN {d = a - b; if (d < 0) d = -d; exit !(d <= r * (b < 0 ? -b : b))}' || fail "$1 is $2, not $3"; }

hilo-import t5.geo -o t5.h5 --size 0.2 > t5.txt
[ "$(grep -c '^volume_' t5.txt)" = 6 ] || fail "t5.geo has six volume groups"
hilo-tag t5.h5 --rigid 'volume_[1-5]' --rest nonlinear -o t5-tags.h5 > t5-tags.txt
scene t5
printf '\n[[motion]]\nkind = "fixed"\nname = "hook"\non = "volume_1"\n' >> t5.toml
solve_and_look t5 von_mises

hilo-import t16.geo -o t16.h5 --size 0.2 > t16.txt
[ "$(grep -c '^volume_' t16.txt)" = 6 ] || fail "t16.geo has six volume groups"
hilo-tag t16.h5 --rest nonlinear -o t16-tags.h5 > t16-tags.txt
scene t16
solve_and_look t16 displacement

hilo-import t20_data.step -o t20.h5 --size 15 > t20.txt
hilo-tag t20.h5 --rest nonlinear -o t20-tags.h5 > t20-tags.txt
scene t20
solve_and_look t20 displacement

# A falling solid of mass m has the kinetic energy m (g t)^2 / 2; mass by the volume of the table.
for name in t16 t20; do
  volume=$(tail -n 1 $name.txt | sed 's/.*volume \([^ ]*\) m.*/\1/')
  near "the kinetic energy of $name" "$(last $name-run.h5 energy.kinetic)" "$(awk -v v="$volume" 'BEGIN {print v * 7850 * (9.80665 * 0.01)^2 / 2}')" 1e-3
done
# The hung cube is held: far less than half of what it would have in free fall.
awk -v a="$(last t5-run.h5 energy.kinetic)" 'BEGIN {exit !(a < 0.5 * 0.875 * 7850 * (9.80665 * 0.01)^2 / 2)}' || fail "t5 falls although it is held"
