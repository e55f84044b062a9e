#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Two bars with *EQUATION of reference nodes and of their turns, and *COUPLING of some displacements, through ccx and through hilo: the same
displacements.  And a plate of shells turned by 30 degrees, held and pushed in axes of *TRANSFORM, against the same plate in the axes of the model.

  tests/cli/ccx_links.py REPO BIN

ccx answers linearly, so loads are multiplied by 1e-4, and displacements divided by that.  The limit is that of the digits which ccx prints and of
sines of angles of 1e-6. A node that is coupled along x stays in a plane that turns with the body, by 1e-5 here.  For the plate that of Newton's tolerance."""
import math, os, sys, tempfile
import h5py
import numpy as np

import calculix as ccx

ccx.tools(need_decks=False)
SMALL = 1e-4


def bars(model, step):
    """Two bars of five cells of 20 nodes along x, held at x = 0."""
    one, two = (ccx.block([0, 3 * k, 0], [10, 3 * k + 1, 1], (5, 1, 1), 2, 500 * k + 1, 5 * k + 1) for k in (0, 1))
    end = lambda grid, i: [number for g, number in grid[0].items() if g[0] == i]
    out = ccx.node_cards(one[1] | two[1], "all")
    out += ["1001, 10., 0.5, 0.5", "1002, 10., 3.5, 0.5", "1003, 10., 0.5, 0.5", "1004, 10., 3.5, 0.5"]
    out += ccx.cell_cards("C3D20", "cells", dict([*one[2].values(), *two[2].values()]))
    out += ccx.set_cards("roots", end(one, 0) + end(two, 0)) + ccx.set_cards("tip1", end(one, 10)) + ccx.set_cards("tip2", end(two, 10))
    out += ["*MATERIAL, NAME=m", "*ELASTIC", "210000., .3", "*SOLID SECTION, ELSET=cells, MATERIAL=m"] + model
    out += ["*BOUNDARY", "roots, 1, 3", "*STEP", "*STATIC"] + step + ["*NODE PRINT, NSET=all", "U", "*END STEP"]
    return "\n".join(out).replace("BETWEEN", str(one[0][6, 2, 2])) + "\n"


def solve(name, *options):
    """Displacements of the nodes by number; and what was not read."""
    lost = ccx.imported(name, *options)
    return ccx.solved("\n[solver]\ntolerance = 1e-12\n", SMALL), lost


rigid = ["*RIGID BODY, NSET=tip1, REF NODE=1001, ROT NODE=1003", "*RIGID BODY, NSET=tip2, REF NODE=1002, ROT NODE=1004"]
coupled = ["*SURFACE, NAME=end, TYPE=NODE", "tip1", "*COUPLING, REF NODE=1001, SURFACE=end, CONSTRAINT NAME=c", "*KINEMATIC"]
DECKS = {
    "of reference nodes": (rigid + ["*EQUATION", "2", "1002, 2, 3., 1001, 2, 2."], ["*CLOAD", "1001, 2, 5.", "1001, 3, 3."]),
    "of a node and reference nodes": (rigid + ["*EQUATION", "3", "1002, 3, 3., 1001, 3, 2., BETWEEN, 3, 1."], ["*CLOAD", "1001, 3, 5.", "1002, 1, 9."]),
    "of turns": (rigid + ["*EQUATION", "2", "1004, 1, 1., 1003, 1, -2."], ["*CLOAD", "1003, 1, 20.", "1001, 3, 3."]),
    "of a turn and a displacement": (rigid + ["*EQUATION", "2", "1002, 2, 1., 1003, 3, 4."], ["*CLOAD", "1001, 2, 5."]),
    "y and z coupled": (coupled + ["2, 3"], ["*BOUNDARY", "1001, 1, 1", "1001, 4, 6", "*CLOAD", "1001, 2, 5.", "1001, 3, 3."]),
    "x coupled": (coupled + ["1, 1"], ["*BOUNDARY", "1001, 2, 4", "*CLOAD", "1001, 1, 50.", "1001, 5, 40."]),
}
bad = 0
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for name, (model, step) in DECKS.items():
        ccx.write("deck.inp", bars(model, step))
        ccx.run("ccx", "deck")
        ours, lost = solve("deck")
        nodes, largest, off = ccx.apart(ours, ccx.last(ccx.printed(open("deck.dat"))))
        wrong = bool(lost) or nodes < 100 or not off < (1e-4 if name == "x coupled" else 3e-6)
        bad += wrong
        print(f"{name:<32}{nodes:>4} nodes  largest u {largest:.4g}  difference {off:.1e}{'  WRONG ' if wrong else ''}" + "".join(lost))

    # a plate of 6 x 4 shells, clamped along the left edge, guided along the lower one, pushed at a corner
    def plate(angle, held, turned):
        c, s = math.cos(angle), math.sin(angle)
        axes = ["*TRANSFORM, NSET=all", f"{c!r}, {s!r}, 0., {-s!r}, {c!r}, 0."] if turned else []
        number = lambda i, j: 1 + i + 7 * j
        out = ["*NODE, NSET=all"] + [f"{number(i, j)}, {c * i - s * j!r}, {s * i + c * j!r}, 0." for j in range(5) for i in range(7)]
        out += ["*ELEMENT, TYPE=S4, ELSET=plate"] + [f"{1 + i + 6 * j}, {number(i, j)}, {number(i + 1, j)}, {number(i + 1, j + 1)}, {number(i, j + 1)}" for j in range(4) for i in range(6)]
        out += ccx.set_cards("left", [number(0, j) for j in range(5)]) + ccx.set_cards("low", [number(i, 0) for i in range(1, 7)])
        out += ["*MATERIAL, NAME=m", "*ELASTIC", "210000., .3", "*SHELL SECTION, ELSET=plate, MATERIAL=m", "0.1"] + axes
        out += ["*BOUNDARY"] + held + ["*STEP", "*STATIC", "*CLOAD", f"{number(6, 4)}, 1, 2.", f"{number(6, 4)}, 2, 3.", f"{number(6, 4)}, 3, .02", "*END STEP"]
        return "\n".join(out) + "\n"

    for what, held in (("a clamp", ["left, 1, 6"]), ("a guide", ["left, 1, 6", "low, 2, 2"]), ("a moved edge", ["left, 1, 6", "low, 2, 2, 0.02"]), ("turns held", ["left, 1, 3", "low, 2, 4"])):
        answers = []
        for angle in (0, math.pi / 6):
            ccx.write("plate.inp", plate(angle, held, angle != 0))
            _, lost = solve("plate", "--thicken")
            with h5py.File("mesh.h5") as m:
                X, u = m["/mesh/nodes/X"][:], ccx.last_field("displacement") / SMALL
            back = np.array([[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]])
            X, u = X @ back, u @ back
            order = np.lexsort(np.round(X, 6).T)
            answers.append((X[order], u[order]))
        off = abs(answers[0][1] - answers[1][1]).max() / abs(answers[0][1]).max()
        wrong = bool(lost) or abs(answers[0][0] - answers[1][0]).max() > 1e-6 or not off < 1e-6
        bad += wrong
        print(f"{'shells, ' + what:<32}{len(X):>4} nodes  largest u {abs(answers[0][1]).max():.4g}  difference {off:.1e}{'  WRONG ' if wrong else ''}" + "".join(lost))
sys.exit(bad > 0)
