#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Scene B: a tube of 2 m, radii 20 and 50 mm, of NC x NR x NZ linear hexahedra around, across and along it:  tube.sh [NC NR NZ], Abaqus' format.
awk -v nc="${1:-24}" -v nr="${2:-6}" -v nz="${3:-178}" 'function node(i, j, k) { return 1 + i % nc + nc * (j + (nr + 1) * k) }
BEGIN {
  print "*NODE, NSET=all"
  for (k = 0; k <= nz; k++) for (j = 0; j <= nr; j++) for (i = 0; i < nc; i++) {
    r = .02 + .03 * j / nr; angle = 2 * atan2(0, -1) * i / nc
    printf "%d, %.12g, %.12g, %.12g\n", node(i, j, k), 2 * k / nz, r * cos(angle), r * sin(angle)
  }
  print "*ELEMENT, TYPE=C3D8I, ELSET=tube"
  for (k = 0; k < nz; k++) for (j = 0; j < nr; j++) for (i = 0; i < nc; i++)
    printf "%d, %d, %d, %d, %d, %d, %d, %d, %d\n", ++e, node(i, j, k), node(i, j+1, k), node(i+1, j+1, k), node(i+1, j, k),
      node(i, j, k+1), node(i, j+1, k+1), node(i+1, j+1, k+1), node(i+1, j, k+1)
  for (k = 0; k <= nz; k += nz) {
    print "*NSET, NSET=" (k ? "tip" : "root")
    for (j = 0; j <= nr; j++) for (i = 0; i < nc; i++) print node(i, j, k) ","
  }
}'
