#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stress at the surface of a connecting rod (rod.geo, quadratic tetrahedra) against CalculiX, run here on the same cells: a peak at a fillet
must not come out low because nodal stress is the mean of what the cells have inside.

  ccx_rod.py REPO BIN [H]     H: edge of the cells, 0.008 m"""
import os
import sys
import tempfile

import h5py
import numpy as np

import calculix as ccx

ccx.tools(need_decks=False)
repo = os.path.abspath(sys.argv[1])
edge = sys.argv[3] if len(sys.argv) > 3 else "0.008"
LIMIT_U, LIMIT_STRESS = 1e-5, 0.01  # of the peak: printed digits; extrapolation to a node is not the same in both


def deck(X, cells):
    """The big eye held in its bore, the small one pulled and pushed aside: 2 N and 0.1 N, so that the answer is linear."""
    held = np.where(abs(np.hypot(X[:, 0], X[:, 1]) - 0.025) < 1e-4)[0]
    pulled = np.where(abs(np.hypot(X[:, 0] - 0.15, X[:, 1]) - 0.011) < 1e-4)[0]
    lines = ccx.node_cards(X.tolist()) + ccx.cell_cards("C3D10", "ROD", (cells + 1).tolist())
    lines += ccx.set_cards("BIG", held + 1) + ccx.set_cards("SMALL", pulled + 1)
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "2.1e11, 0.3", "*DENSITY", "7850.", "*SOLID SECTION, ELSET=ROD, MATERIAL=STEEL"]
    lines += ["*BOUNDARY", "BIG, 1, 3", "*STEP", "*STATIC", "1., 1.", "*CLOAD"]
    lines += [f"SMALL, 1, {-2 / len(pulled):.12g}", f"SMALL, 2, {0.1 / len(pulled):.12g}"]
    return "\n".join(lines + ["*NODE FILE", "U", "*EL FILE", "S", "*END STEP", ""])


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    ccx.run("hilo-import", "--quiet", repo + "/tests/cli/rod.geo", "--define", "H=" + edge, "--order", "2", "-o", "cad.h5")
    with h5py.File("cad.h5") as f:
        X, cells = f["mesh/nodes/X"][:], f["mesh/cells/nodes"][:].reshape(-1, 10)
    ccx.write("rod.inp", deck(X, cells))
    ccx.run("ccx", "rod")
    theirs = ccx.last(ccx.plotted(open("rod.frd")))
    u, s = (np.array([theirs[k][i + 1] for i in range(len(X))]) for k in ("DISP", "STRESS"))
    mises = ccx.von_mises(s)
    ccx.imported("rod")
    ccx.solved("\n[solver]\ntolerance = 1e-12\n")
    ours, stress = ccx.last_field("displacement"), ccx.last_field("von_mises")
    os.chdir("/")
apart, peak, node = abs(ours - u).max() / abs(u).max(), stress.max() / mises.max(), np.argmax(mises)
print(f"{len(cells)} cells: displacements differ by {apart:.1e}; peak von Mises stress over CalculiX's {peak:.4f}, at its node {stress[node] / mises[node]:.4f}")
sys.exit(0 if apart < LIMIT_U and max(abs(peak - 1), abs(stress[node] / mises[node] - 1)) < LIMIT_STRESS else 1)
