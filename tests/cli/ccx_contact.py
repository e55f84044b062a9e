#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""*CONTACT PAIR of decks against CalculiX, run here on the same cells (C3D8I, C3D20): a block stands on a larger one, whose mesh does not match.

  ccx_contact.py REPO BIN [CASE...]

Compared are the displacements of all nodes at the end.  CalculiX holds contact by springs at points of faces, hilo by a pressure at other points
of faces; both are some hundred times as stiff as the cells.  So the difference is that of two ways to weigh the same faces."""
import os
import sys
import tempfile

import calculix as ccx

ccx.tools(need_decks=False)
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


def deck(gap, interaction, steps, order):
    divided = 3 - order  # cells, so that both have as many nodes along an edge
    down = ccx.block([0, 0, 0], [1, 1, 0.5], [4 * divided, 4 * divided, 2 * divided], order, 1, 1)
    top = ccx.block([0.15, 0.15, 0.5 + gap], [0.75, 0.85, 1 + gap], [3 * divided, 3 * divided, 2 * divided], order, 2000, 500)
    lines = ccx.node_cards(down[1] | top[1])
    for name, (number, X, cells) in (("DOWN", down), ("UP", top)):
        lines += ccx.cell_cards("C3D8I" if order == 1 else "C3D20", name, dict(cells.values()))
    for name, grid, layer in (("FLOOR", down, 0), ("HEAD", top, 4)):
        lines += ccx.set_cards(name, [i for g, i in grid[0].items() if g[2] == layer])
    for name, grid, layer, face in (("TABLE", down, 2 * divided - 1, 2), ("FOOT", top, 0, 1), ("TOP", top, 2 * divided - 1, 2)):
        lines += [f"*SURFACE, NAME={name}"] + [f"{i}, S{face}" for at, (i, nodes) in grid[2].items() if at[2] == layer]
    text = "\n".join(lines) + "\n*MATERIAL, NAME=STEEL\n*ELASTIC\n2.1e5, .3\n*SOLID SECTION, ELSET=DOWN, MATERIAL=STEEL\n*SOLID SECTION, ELSET=UP, MATERIAL=STEEL\n"
    text += "*BOUNDARY\nFLOOR, 1, 3\nHEAD, 2, 2\n" + PAIR + interaction
    for cards in steps:
        text += STEP.format(".25, 1.", cards + "*NODE PRINT, NSET=ALL, FREQUENCY=1000\nU\n")
    return text


def compare(name):
    gap, interaction, steps, limit, order = CASES[name]
    ccx.write("deck.inp", deck(gap, interaction, steps, order))
    ccx.run("ccx", "deck")
    ccx.imported("deck")
    nodes, largest, difference = ccx.apart(ccx.solved(), ccx.last(ccx.printed(open("deck.dat"))))
    print(f"{name:<20}{nodes:>7}{largest:>14.4g}{difference:>12.1e}{limit:>9.0e}  {'agrees' if difference < limit else 'DIFFERS'}", flush=True)
    return difference < limit


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    print(f"{'contact':<20}{'nodes':>7}{'largest u':>14}{'difference':>12}{'limit':>9}")
    sys.exit(0 if all([compare(name) for name in sys.argv[3:] or CASES]) else 1)
