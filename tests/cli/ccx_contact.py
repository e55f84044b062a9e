#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""*CONTACT PAIR of decks against CalculiX, run here on the same cells (C3D8I): a block stands on a larger one, whose mesh does not match.

  ccx_contact.py REPO BIN [CASE...]

Compared are the displacements of all nodes at the end.  CalculiX holds contact by springs at points of faces, hilo by a pressure at other points
of faces; both are some hundred times as stiff as the cells.  So the difference is that of two ways to weigh the same faces."""
import os
import re
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
FACES = [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)]  # S1..
PAIR = "*CONTACT PAIR, INTERACTION=BETWEEN, TYPE=SURFACE TO SURFACE\nFOOT, TABLE\n*SURFACE INTERACTION, NAME=BETWEEN\n"
LAW = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e8\n"
STEP = "*STEP, NLGEOM\n*STATIC\n{}\n{}*END STEP\n"
PRESS = "*DSLOAD\nTOP, P, {}\n"
PUSH = "*BOUNDARY\nHEAD, 1, 1, {}\n"
DOWN = "*BOUNDARY\nHEAD, 3, 3, {}\n"
CASES = {  # height of the gap, cards of the interaction, steps, limit of the largest difference over the largest displacement
    "pressed": (0.0, LAW, [PRESS.format(500.0) + PUSH.format(0.0)], 0.01),
    "held by friction": (0.0, LAW + "*FRICTION\n0.5, 1e8\n", [PRESS.format(500.0) + PUSH.format(0.0), PUSH.format(1e-4)], 0.01),
    "slides": (0.0, LAW + "*FRICTION\n0.1, 1e8\n", [PRESS.format(500.0) + PUSH.format(0.0), PUSH.format(4e-3)], 0.01),
    "gap closes": (0.01, LAW, [DOWN.format(-0.012) + PUSH.format(0.0)], 0.01),
    "tied": (0.0, "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n1e8\n*FRICTION\n1., 1e8\n", [DOWN.format(1e-3) + PUSH.format(1e-3)], 0.03),
}


def block(low, high, n, node, cell):
    """Nodes of a block by their place on its grid, and cells by theirs: number and nodes."""
    low, high, n = np.array(low), np.array(high), np.array(n)
    number = {g: node + i for i, g in enumerate(np.ndindex(*(n + 1)))}
    X = {i: low + (high - low) * np.array(g) / n for g, i in number.items()}
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
    return number, X, {at: (cell + i, [number[tuple(c)] for c in corners + at]) for i, at in enumerate(np.ndindex(*n))}


def deck(gap, interaction, steps):
    down, top = block([0, 0, 0], [1, 1, 0.5], [8, 8, 4], 1, 1), block([0.15, 0.15, 0.5 + gap], [0.75, 0.85, 1 + gap], [6, 6, 4], 2000, 500)
    text = "*NODE, NSET=ALL\n"
    for number, X, cells in (down, top):
        for i, x in X.items():
            text += f"{i}, " + ", ".join(repr(float(v)) for v in x) + "\n"
    for name, (number, X, cells) in (("DOWN", down), ("UP", top)):
        text += f"*ELEMENT, TYPE=C3D8I, ELSET={name}\n" + "".join(f"{i}, " + ", ".join(map(str, nodes)) + "\n" for i, nodes in cells.values())
    for name, grid, layer in (("FLOOR", down, 0), ("HEAD", top, 4)):
        text += f"*NSET, NSET={name}\n" + "".join(f"{i},\n" for g, i in grid[0].items() if g[2] == layer)
    for name, grid, layer, face in (("TABLE", down, 3, 2), ("FOOT", top, 0, 1), ("TOP", top, 3, 2)):
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
    gap, interaction, steps, limit = CASES[name]
    open("deck.inp", "w").write(deck(gap, interaction, steps))
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
    print(f"{name:<18}{len(ids):>7}{largest:>14.4g}{difference:>12.1e}{limit:>9.0e}  {'agrees' if difference < limit else 'DIFFERS'}", flush=True)
    return difference < limit


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    print(f"{'contact':<18}{'nodes':>7}{'largest u':>14}{'difference':>12}{'limit':>9}")
    sys.exit(0 if all([compare(name) for name in sys.argv[3:] or CASES]) else 1)
