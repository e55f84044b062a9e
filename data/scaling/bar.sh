#!/bin/bash
# Scene A: a cantilever 4 x 0.2 x 0.2 m, 200 kN across its tip, ramped over 0.02 s.  bar.sh NX NY NZ [LENGTH] [ccx]: a deck of linear
# hexahedra in Abaqus' format on stdout, with CalculiX's step where asked.
awk -v nx="$1" -v ny="$2" -v nz="$3" -v L="${4:-4}" -v ccx="${5:-}" 'BEGIN {
  print "*NODE, NSET=all"
  for (i = 0; i <= nx; i++) for (j = 0; j <= ny; j++) for (k = 0; k <= nz; k++) {
    id[i, j, k] = ++n; printf "%d, %.12g, %.12g, %.12g\n", n, L * i / nx, .2 * j / ny - .1, .2 * k / nz - .1
  }
  print "*ELEMENT, TYPE=C3D8I, ELSET=bar"
  for (i = 0; i < nx; i++) for (j = 0; j < ny; j++) for (k = 0; k < nz; k++)
    printf "%d, %d, %d, %d, %d, %d, %d, %d, %d\n", ++e, id[i, j, k], id[i+1, j, k], id[i+1, j+1, k], id[i, j+1, k],
      id[i, j, k+1], id[i+1, j, k+1], id[i+1, j+1, k+1], id[i, j+1, k+1]
  print "*NSET, NSET=root"; for (j = 0; j <= ny; j++) for (k = 0; k <= nz; k++) print id[0, j, k] ","
  print "*NSET, NSET=tip"; for (j = 0; j <= ny; j++) for (k = 0; k <= nz; k++) print id[nx, j, k] ","
  if (!ccx) exit
  print "*MATERIAL, NAME=m\n*ELASTIC\n2.07e9, 0.3\n*DENSITY\n7800\n*SOLID SECTION, ELSET=bar, MATERIAL=m"
  print "*BOUNDARY\nroot, 1, 3\n*AMPLITUDE, NAME=ramp\n0, 0, 0.02, 1, 1, 1\n*STEP, NLGEOM, INC=1000\n*DYNAMIC, DIRECT, ALPHA=0\n1e-3, 0.02"
  printf "*CLOAD, AMPLITUDE=ramp\ntip, 3, %.12g\n*NODE PRINT, NSET=tip, FREQUENCY=20\nU\n*END STEP\n", 2e5 / ((ny + 1) * (nz + 1))
}'
