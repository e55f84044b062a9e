#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Laws of materials that decks carry against CalculiX, run here on the same cells (quadratic tetrahedra, four points in both): a bar with a
notch all around is pulled and let go (metal: yield table, isotropic or kinematic), or pulled (rubber, wood).

  ccx_laws.py REPO BIN

Compared are the displacements of all nodes and the von Mises stress of nodes, at the end of the pull and at the end of the run.  Rubber and
wood are the same law in both: printed digits.  A metal's elasticity is of logarithmic strain here and of another finite-strain law there:
apart by the order of the elastic strain, and nodal stress is extrapolated otherwise."""
import os
import sys
import tempfile

import h5py
import numpy as np

import calculix as ccx

ccx.tools(need_decks=False)
TET = ((0, 1, 3, 7), (0, 1, 7, 5), (0, 5, 7, 4), (1, 2, 3, 7), (1, 2, 7, 6), (1, 5, 6, 7))
EDGES = ccx.EDGES[4]
METAL = "*ELASTIC\n2e11, .3\n*PLASTIC%s\n2.5e8, 0.\n%s"
MOONEY = "*HYPERELASTIC, MOONEY-RIVLIN\n.3e6, .1e6, 1e-6\n"
DECKS = {  # cards of the material, pull over the length, let go again, limits: displacements, stress; cards for CalculiX where they are others
    "metal, isotropic": (METAL % ("", "3.2e8, .01\n3.6e8, .05\n4e8, .3\n"), 0.005, True, 5e-3, 0.02),
    "metal, kinematic": (METAL % (", HARDENING=KINEMATIC", "7.5e8, .1\n"), 0.005, True, 5e-3, 0.02),
    "Mooney-Rivlin": (MOONEY, 0.4, False, 1e-5, 0.02),
    "neo-Hooke": ("*HYPERELASTIC, NEO HOOKE\n.4e6, 1e-6\n", 0.4, False, 1e-5, 0.02),
    "Ogden": ("*HYPERELASTIC, OGDEN, N=2\n.6e6, 2., .2e6, -2., 1e-6, 0.\n", 0.4, False, 1e-5, 0.02, MOONEY),  # theirs does not converge
    "wood": ("*ELASTIC, TYPE=ENGINEERING CONSTANTS\n11e9, .9e9, .5e9, .37, .42, .47, .7e9, .6e9\n.04e9\n", 0.02, False, 1e-5, 0.01),
}


def bar(n=(8, 2, 2)):
    """Nodes and cells of a bar 0.4 x 0.1 x 0.1 whose middle is a third thinner."""
    grid = np.array([[i, j, k] for k in range(2 * n[2] + 1) for j in range(2 * n[1] + 1) for i in range(2 * n[0] + 1)])
    number = {tuple(g): i for i, g in enumerate(grid)}
    used, cells = {}, []
    for k in range(n[2]):
        for j in range(n[1]):
            for i in range(n[0]):
                c = np.array([2 * i, 2 * j, 2 * k]) + 2 * np.array(ccx.HEXAHEDRON)
                for t in TET:
                    corners = c[list(t)]
                    if np.linalg.det(corners[1:] - corners[0]) < 0:
                        corners = corners[[0, 2, 1, 3]]
                    nodes = list(corners) + [(corners[a] + corners[b]) // 2 for a, b in EDGES]
                    cells.append([used.setdefault(number[tuple(x)], len(used)) for x in nodes])
    s = grid[sorted(used, key=used.get)] / (2 * np.array(n))
    x = 0.4 * s[:, 0]
    thin = 1 - np.exp(-((x - 0.2) / 0.06)**2) / 3
    X = np.column_stack([x, 0.1 * (s[:, 1] - 0.5) * thin, 0.1 * (s[:, 2] - 0.5) * thin])
    return straight(X, cells), cells


def straight(X, cells):
    """Middles of the edges halfway between their ends."""
    X = X.copy()
    for c in cells:
        for m, (a, b) in enumerate(EDGES):
            X[c[4 + m]] = (X[c[a]] + X[c[b]]) / 2
    return X


def steps(back):
    """Of a pull: CalculiX needs small ones where a metal turns back."""
    return 50 if back else 10


def deck(X, cells, cards, pull, back):
    left, right = np.where(abs(X[:, 0]) < 1e-9)[0], np.where(abs(X[:, 0] - 0.4) < 1e-9)[0]
    lines = ccx.node_cards(X.tolist()) + ccx.cell_cards("C3D10", "BAR", (np.array(cells) + 1).tolist())
    lines += ccx.set_cards("LEFT", left + 1) + ccx.set_cards("RIGHT", right + 1)
    lines += ["*ORIENTATION, NAME=GRAIN", "2., 1., 0., -1., 2., 0."]
    lines += ["*MATERIAL, NAME=M"] + cards.strip().split("\n") + ["*DENSITY", "1000."]
    lines += ["*SOLID SECTION, ELSET=BAR, MATERIAL=M" + (", ORIENTATION=GRAIN" if "ENGINEERING" in cards else "")]
    lines += ["*AMPLITUDE, NAME=A", "0., 0., 1., 1." + (f", 2., {0.8:g}" if back else "")]
    lines += ["*STEP, NLGEOM, INC=1000", "*STATIC, DIRECT", f"{1 / steps(back):g}, {2 if back else 1}."]
    lines += ["*BOUNDARY", "LEFT, 1, 3", "*BOUNDARY, AMPLITUDE=A", f"RIGHT, 1, 1, {pull * 0.4:g}", "RIGHT, 2, 3, 0."]
    return "\n".join(lines + ["*NODE FILE", "U", "*EL FILE", "S", "*END STEP", ""])


def compared(X, cells, cards, pull, back, their_cards):
    ccx.write("their.inp", deck(X, cells, their_cards, pull, back))
    ccx.run("ccx", "their")
    theirs = {round(t, 6): fields for t, fields in ccx.plotted(open("their.frd")).items()}
    ccx.write("bar.inp", deck(X, cells, cards, pull, back))
    ccx.imported("bar")
    ccx.solved("\n[solver]\ntolerance = 1e-12\n[output]\ninterval = 1\n", 1.0, "--set", f"time.steps={(2 if back else 1) * steps(back)}")
    apart = [0.0, 0.0]
    with h5py.File("run.h5") as f:
        for name in f["field"]:
            t = round(float(f["field"][name].attrs["t"]), 6)
            if t not in theirs:
                continue
            u, s = (np.array([theirs[t][k][i + 1] for i in range(len(X))]) for k in ("DISP", "STRESS"))
            mises = ccx.von_mises(s)
            ours, stress = f["field"][name]["displacement"][:], f["field"][name]["von_mises"][:]
            apart[0] = max(apart[0], abs(ours - u).max() / abs(u).max())
            inside = abs(X[:, 0] - 0.2) < 0.1  # away from the clamped ends, where it is singular
            apart[1] = max(apart[1], np.sqrt(((stress - mises)[inside]**2).mean()) / mises.max())
    return apart


good = True
X, cells = bar()
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for name, (cards, pull, back, limit_u, limit_s, *their) in DECKS.items():
        u, s = compared(X, cells, cards, pull, back, their[0] if their else cards)
        good = good and u < limit_u and s < limit_s
        print(f"{name:<18} {len(cells)} cells: displacements differ by {u:.1e} ({limit_u:g}), nodal von Mises stress by {s:.2%} ({limit_s:g})", flush=True)
    os.chdir("/")
sys.exit(0 if good else 1)
