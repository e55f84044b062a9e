#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A block in a press, in load steps, here and by CalculiX with its contact of faces, on the same cells: a quarter of a block of 20 x 20 x 20 mm,
E 1000 MPa, between plates of 20 000 MPa, pressed by 2 mm.  With friction of 0.3 it bulges, without it bears
E A (1 - s^2)/2 s of St. Venant and Kirchhoff, s the stretch, to 2 %: the plates give way.  Prints force, processor seconds of each and their
ratio.

  press.py BIN [CELLS]     CELLS across the quarter of the block, 8 (1 400 cells in all) unless given

Ours takes the stiffness that a load step takes; CalculiX the same of both cells in series, and of the bristle along.  One core each, one
after the other."""
import json
import os
import sys
import tempfile

import h5py

from costs import cost

tools = os.path.abspath(sys.argv[1])
n = int(sys.argv[2]) if len(sys.argv) > 2 else 8
os.environ["OMP_NUM_THREADS"] = os.environ["OPENBLAS_NUM_THREADS"] = "1"
WIDTH, HEIGHT, PLATE, DOWN, STEPS = 10.0, 20.0, 4.0, 2.0, 5
E = {"BLOCK": 1000.0, "LOW": 20000.0, "HIGH": 20000.0}


def even(a, b, pieces):
    return [a + (b - a) * i / pieces for i in range(pieces + 1)]


def part(name, first, cell, x, z):
    """Nodes, cells, facets below and above, and sets.  The plates' outer faces are held as a whole."""
    across = len(x)

    def at(i, j, k):
        return first + i + across * (j + across * k)

    nodes = [f"{at(i, j, k)}, {x[i]:.12g}, {x[j]:.12g}, {z[k]:.12g}" for k in range(len(z)) for j in range(across) for i in range(across)]
    cells, faces = [], {"LOW": [], "HIGH": []}
    for k in range(len(z) - 1):
        for j in range(across - 1):
            for i in range(across - 1):
                number = cell + len(cells)
                corners = [at(i + a, j + b, k + c) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
                cells.append(f"{number}, " + ", ".join(map(str, corners)))
                faces["LOW"] += [f"{number}, S1"] if k == 0 else []
                faces["HIGH"] += [f"{number}, S2"] if k == len(z) - 2 else []
    free, every = range(name == "LOW", len(z) - (name == "HIGH")), range(across)
    sets = {"X": [at(0, j, k) for j in every for k in free], "Y": [at(i, 0, k) for i in every for k in free],
            "BOTTOM": [at(i, j, 0) for i in every for j in every], "TOP": [at(i, j, len(z) - 1) for i in every for j in every]}
    return nodes, cells, faces, sets


def mesh():
    """Lines, and the number of cells.  The plates have other cells than the block."""
    parts, first, cell = {}, 1, 1
    for name, x, z in (("BLOCK", even(0, WIDTH, n), even(0, HEIGHT, 2 * n)), ("LOW", even(0, 1.25 * WIDTH, n), even(-PLATE, 0, 3)),
                       ("HIGH", even(0, 1.25 * WIDTH, n), even(HEIGHT, HEIGHT + PLATE, 3))):
        parts[name] = part(name, first, cell, x, z)
        first, cell = first + len(parts[name][0]), cell + len(parts[name][1])
    lines = ["*NODE"] + [line for made in parts.values() for line in made[0]]
    for name, (_, cells, faces, sets) in parts.items():
        lines += [f"*ELEMENT, TYPE=C3D8, ELSET={name}"] + cells
        for word, nodes in sets.items():
            lines += [f"*NSET, NSET={name}{word}"] + [f"{k}," for k in nodes]
        for word, facets in faces.items():
            lines += [f"*SURFACE, NAME={name}{word}FACE, TYPE=ELEMENT"] + facets
    for name, modulus in E.items():
        lines += [f"*MATERIAL, NAME=M{name}", "*ELASTIC", f"{modulus}, .3", "*DENSITY", "7.8e-9", f"*SOLID SECTION, ELSET={name}, MATERIAL=M{name}"]
    return lines, cell - 1


def ours(friction):
    held = [(f"{p}{s}", c) for p in E for s, c in (("X", "x"), ("Y", "y"))]
    return "".join([f'[material.M{k}]\nE = {1e6 * v}\nnu = 0.3\ndensity = 7800\n[region.{k}]\nmaterial = "M{k}"\n' for k, v in E.items()] +
                   [f'[[contact]]\nname = "{s}"\na = "{a}"\nb = "BLOCK"\nfriction = {friction}\n' for s, a in (("below", "LOW"), ("above", "HIGH"))] +
                   ['[[motion]]\nkind = "fixed"\nname = "held"\non = "LOWBOTTOM"\n[[motion]]\nkind = "translation"\nname = "pressed"\n'
                    f'on = "HIGHTOP"\ndisplacement = [0, 0, {-1e-3 * DOWN}]\n'] +
                   [f'[[motion]]\nkind = "fixed"\nname = "{s}"\non = "{s}"\ncomponents = ["{c}"]\n' for s, c in held] +
                   [f'[output]\nfields = ["displacement"]\n[time]\nanalysis = "static"\nsteps = {STEPS}\n'])


def theirs(friction):
    stiffness = 100 / (HEIGHT / (2 * n) / E["BLOCK"] + PLATE / 3 / E["LOW"])
    pair = "*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE"
    return (["*SURFACE INTERACTION, NAME=I", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{stiffness:g}"] +
            (["*FRICTION", f"{friction}, {stiffness * 1.4 / 1.7:g}"] if friction else []) +
            [pair, "BLOCKLOWFACE, LOWHIGHFACE", pair, "BLOCKHIGHFACE, HIGHLOWFACE", "*STEP, NLGEOM, INC=200", "*STATIC, DIRECT", f"{1 / STEPS}, 1.",
             "*BOUNDARY", "LOWBOTTOM, 1, 3", "HIGHTOP, 1, 2", f"HIGHTOP, 3, 3, {-DOWN}"] +
            [f"{p}{s}, {c}, {c}" for p in E for s, c in (("X", 1), ("Y", 2))] +
            ["*NODE PRINT, NSET=LOWBOTTOM, TOTALS=ONLY", "RF", "*NODE FILE", "U", "*END STEP", ""])


def seconds(*words):
    took = cost(words, 900)
    if not took:
        sys.exit(f"{' '.join(words)}: fails\n{open('words').read()[-2000:]}")
    return took[0]


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    lines, cells = mesh()
    with open("mesh.inp", "w") as f:
        f.write("\n".join(lines + [""]))
    seconds(tools + "/hilo-import", "--quiet", "mesh.inp", "--units", "mm-t-s", "-o", "mesh.h5")
    print(f"{cells} cells, {STEPS} load steps; force of a quarter, N; iterations; processor seconds")
    for friction in (0.3, 0):
        with open("scene.toml", "w") as f:
            f.write(ours(friction))
        with open("theirs.inp", "w") as f:
            f.write("\n".join(lines + theirs(friction)))
        mine = seconds(tools + "/hilo-solve", "--quiet", "scene.toml", "mesh.h5", "-o", "run.h5")
        told = json.load(open("run.json"))
        force = -h5py.File("run.h5")["history/contact/above"][-1, 2]
        other = seconds("ccx", "theirs")
        totals = [line.split() for line in open("theirs.dat") if len(line.split()) == 3 and line.split()[0][0] in "-0123456789"]
        iterations = sum(int(line.split()[3]) for line in open("theirs.sta") if line.split()[:1] == ["1"])
        print(f"friction {friction}")
        print(f"  hilo      {force:8.1f} {told['newton_iterations']:4} {mine:8.2f}")
        print(f"  CalculiX  {float(totals[-1][2]):8.1f} {iterations:4} {other:8.2f}   {other / mine:.1f} times as long")
        if abs(float(totals[-1][2]) / force - 1) > 0.01:
            sys.exit("press.py: the answers are not equal")
        stretch = 1 - DOWN / HEIGHT
        if not friction and abs(force / (E["BLOCK"] * WIDTH**2 * (1 - stretch**2) / 2 * stretch) - 1) > 0.02:
            sys.exit("press.py: not the force of a block that is free to widen")
