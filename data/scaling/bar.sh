#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Scene A: a cantilever 4 x 0.2 x 0.2 m, 200 kN across its tip, ramped over 0.02 s.  bar.sh NX NY NZ [LENGTH] [ELEMENT] [ccx]: a deck of
# hexahedra in Abaqus' format on stdout, C3D8I unless another element with 8 or 20 nodes is named; with CalculiX's step where asked.
awk -v nx="$1" -v ny="$2" -v nz="$3" -v L="${4:-4}" -v type="${5:-C3D8I}" -v ccx="${6:-}" '
# The node at (i, j, k) in steps of half a cell; made when first asked for.
function node(i, j, k) {
  if (!((i, j, k) in id)) {
    id[i, j, k] = ++n; text = text sprintf("%d, %.12g, %.12g, %.12g\n", n, L * i / nx / 2, .1 * j / ny - .1, .1 * k / nz - .1)
    if (i == 0) root = root n ",\n"
    if (i == 2 * nx) { tip = tip n ",\n"; at_tip++ }
    if (length(text) > 4000) { printf "%s", text; text = "" }
  }
  return id[i, j, k]
}
BEGIN {
  corners = "0 0 0 2 0 0 2 2 0 0 2 0 0 0 2 2 0 2 2 2 2 0 2 2"
  middles = " 1 0 0 2 1 0 1 2 0 0 1 0 1 0 2 2 1 2 1 2 2 0 1 2 0 0 1 2 0 1 2 2 1 0 2 1"
  per = split(type ~ /^C3D20/ ? corners middles : corners, at, " ") / 3
  print "*NODE, NSET=all"
  for (i = 0; i < nx; i++) for (j = 0; j < ny; j++) for (k = 0; k < nz; k++) {
    cell[++e] = e
    for (a = 0; a < per; a++) cell[e] = cell[e] "," (a == 15 ? "\n" : " ") node(2 * i + at[3 * a + 1], 2 * j + at[3 * a + 2], 2 * k + at[3 * a + 3])
  }
  printf "%s*ELEMENT, TYPE=%s, ELSET=bar\n", text, type
  for (i = 1; i <= e; i++) print cell[i]
  printf "*NSET, NSET=root\n%s*NSET, NSET=tip\n%s", root, tip
  if (!ccx) exit
  print "*MATERIAL, NAME=m\n*ELASTIC\n2.07e9, 0.3\n*DENSITY\n7800\n*SOLID SECTION, ELSET=bar, MATERIAL=m"
  print "*BOUNDARY\nroot, 1, 3\n*AMPLITUDE, NAME=ramp\n0, 0, 0.02, 1, 1, 1\n*STEP, NLGEOM, INC=1000\n*DYNAMIC, DIRECT, ALPHA=0\n1e-3, 0.02"
  printf "*CLOAD, AMPLITUDE=ramp\ntip, 3, %.12g\n*NODE PRINT, NSET=tip, FREQUENCY=20\nU\n*END STEP\n", 2e5 / at_tip
}'
