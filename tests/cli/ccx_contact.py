#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""*CONTACT PAIR of decks against CalculiX, run here on the same cells (C3D8I, C3D20): a block stands on a larger one, whose mesh does not match.

  ccx_contact.py REPO BIN [CASE...]

Compared are the displacements of all nodes at the end.  CalculiX holds contact by springs at points of faces, hilo by a pressure at other points
of faces; both are some hundred times as stiff as the cells.  So the difference is that of two ways to weigh the same faces."""
import os
import shutil
import subprocess
import sys
import tempfile

import h5py
import numpy as np

if shutil.which("ccx") is None:
    print("this system has no CalculiX to compare with")
    sys.exit(77)

tools = os.path.abspath(sys.argv[2])
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
PAIR = "*CONTACT PAIR, INTERACTION=BETWEEN, TYPE=SURFACE TO SURFACE\nFOOT, TABLE\n*SURFACE INTERACTION, NAME=BETWEEN\n"
LAW = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e8\n"
STEP = "*STEP, NLGEOM\n*STATIC\n{}\n{}*END STEP\n"
PRESS = "*DSLOAD\nTOP, P, {}\n"
PUSH = "*BOUNDARY\nHEAD, 1, 1, {}\n"
DOWN = "*BOUNDARY\nHEAD, 3, 3, {}\n"
CASES = {  # height of the gap, cards of the interaction, steps, limit of the largest difference over the largest displacement, order of the cells
    "pressed": (0.0, LAW, [PRESS.format(500.0) + PUSH.format(0.0)], 0.01, 1),
    "pressed, quadratic": (0.0, LAW, [PRESS.format(500.0) + PUSH.format(0.0)], 0.02, 2),
    "held by friction": (0.0, LAW + "*FRICTION\n0.5, 1e8\n", [PRESS.format(500.0) + PUSH.format(0.0), PUSH.format(1e-4)], 0.01, 1),
    "slides": (0.0, LAW + "*FRICTION\n0.1, 1e8\n", [PRESS.format(500.0) + PUSH.format(0.0), PUSH.format(4e-3)], 0.01, 1),
    "gap closes": (0.01, LAW, [DOWN.format(-0.012) + PUSH.format(0.0)], 0.01, 1),
    "tied": (0.0, "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n1e8\n*FRICTION\n1., 1e8\n", [DOWN.format(1e-3) + PUSH.format(1e-3)], 0.03, 1),
}


def block(low, high, n, order, node, cell):
    """Nodes of a block by their place on its grid, their points, and cells by their place: number and nodes."""
    low, high, n = np.array(low), np.array(high), np.array(n)
    number, X, cells = {}, {}, {}
    for at in np.ndindex(*n):
        c = order * (CORNERS + at)
        nodes = []
        for g in [*c, *[(c[a] + c[b]) // 2 for a, b in EDGES if order == 2]]:
            if tuple(g) not in number:
                number[tuple(g)] = node + len(X)
                X[number[tuple(g)]] = low + (high - low) * g / (order * n)
            nodes.append(number[tuple(g)])
        cells[at] = (cell + len(cells), nodes)
    return number, X, cells


def deck(gap, interaction, steps, order):
    divided = 3 - order  # cells, so that both have as many nodes along an edge
    down = block([0, 0, 0], [1, 1, 0.5], [4 * divided, 4 * divided, 2 * divided], order, 1, 1)
    top = block([0.15, 0.15, 0.5 + gap], [0.75, 0.85, 1 + gap], [3 * divided, 3 * divided, 2 * divided], order, 2000, 500)
    text = "*NODE, NSET=ALL\n"
    for number, X, cells in (down, top):
        for i, x in X.items():
            text += f"{i}, " + ", ".join(repr(float(v)) for v in x) + "\n"
    for name, (number, X, cells) in (("DOWN", down), ("UP", top)):
        text += f"*ELEMENT, TYPE={'C3D8I' if order == 1 else 'C3D20'}, ELSET={name}\n"
        for i, nodes in cells.values():
            text += f"{i}, " + ", ".join(map(str, nodes[:12])) + (",\n" + ", ".join(map(str, nodes[12:])) if order == 2 else "") + "\n"
    for name, grid, layer in (("FLOOR", down, 0), ("HEAD", top, 4)):
        text += f"*NSET, NSET={name}\n" + "".join(f"{i},\n" for g, i in grid[0].items() if g[2] == layer)
    for name, grid, layer, face in (("TABLE", down, 2 * divided - 1, 2), ("FOOT", top, 0, 1), ("TOP", top, 2 * divided - 1, 2)):
        text += f"*SURFACE, NAME={name}\n" + "".join(f"{i}, S{face}\n" for at, (i, nodes) in grid[2].items() if at[2] == layer)
    text += "*MATERIAL, NAME=STEEL\n*ELASTIC\n2.1e5, .3\n*SOLID SECTION, ELSET=DOWN, MATERIAL=STEEL\n*SOLID SECTION, ELSET=UP, MATERIAL=STEEL\n"
    text += "*BOUNDARY\nFLOOR, 1, 3\nHEAD, 2, 2\n" + PAIR + interaction
    for cards in steps:
        text += STEP.format(".25, 1.", cards + "*NODE PRINT, NSET=ALL, FREQUENCY=1000\nU\n")
    return text


def displacements(path):
    u = {}
    for line in open(path):
        f = line.split()
        if len(f) == 4 and f[0].isdigit():
            u[int(f[0])] = [float(x) for x in f[1:]]
    return u


def run(*command):
    ran = subprocess.run(command, capture_output=True, text=True, timeout=200)
    if ran.returncode:
        sys.exit(f"ccx_contact: {' '.join(command)}: exit {ran.returncode}: {(ran.stderr or ran.stdout)[-500:]}")


def compare(name):
    gap, interaction, steps, limit, order = CASES[name]
    open("deck.inp", "w").write(deck(gap, interaction, steps, order))
    run("ccx", "deck")
    truth = displacements("deck.dat")
    run(f"{tools}/hilo-import", "deck.inp", "-o", "mesh.h5", "--scene-out", "scene.toml")
    run(f"{tools}/hilo-solve", "--quiet", "scene.toml", "-o", "run.h5")
    with h5py.File("mesh.h5") as m, h5py.File("run.h5") as r:
        ids = m["mesh/nodes/id"][:]
        u = r["field"][sorted(r["field"])[-1]]["displacement"][:]
    expected = np.array([truth[i] for i in ids])
    largest = abs(expected).max()
    difference = abs(u - expected).max() / largest
    print(f"{name:<20}{len(ids):>7}{largest:>14.4g}{difference:>12.1e}{limit:>9.0e}  {'agrees' if difference < limit else 'DIFFERS'}", flush=True)
    return difference < limit


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    print(f"{'contact':<20}{'nodes':>7}{'largest u':>14}{'difference':>12}{'limit':>9}")
    sys.exit(0 if all([compare(name) for name in sys.argv[3:] or CASES]) else 1)
