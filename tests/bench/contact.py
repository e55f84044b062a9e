#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Two spheres pressed onto each other (Hertz), in load steps, here and by CalculiX with its contact of faces, on the same cells: a quarter,
E 20 000 MPa, radius 50 mm, approach 4 mm, force of the whole 586.1 kN.  Prints force, processor seconds of each and their ratio.

  contact.py BIN [CELLS]     CELLS over the radius of contact, 4 (1 300 cells of eight nodes) unless given; 8: 5 800

Ours takes the stiffness that a load step takes; CalculiX the same of E over the depth of a cell there.  One core each, one after the other."""
import json
import math
import os
import resource
import subprocess
import sys
import tempfile

import h5py

tools = os.path.abspath(sys.argv[1])
n = int(sys.argv[2]) if len(sys.argv) > 2 else 4
R, A, WIDTH, APPROACH, STEPS = 50.0, 10.0, 33.0, 4.0, 5
FORCE = 4 / 3 * 20000 / (2 * (1 - 0.09)) * math.sqrt(R / 2) * APPROACH**1.5 / 4  # of a quarter


def graded(h, k, q, to):
    x = [0.0]
    while x[-1] < to:
        h *= q if len(x) > k else 1
        x.append(x[-1] + h)
    return x[:k + 1] + [x[k] + (y - x[k]) * (to - x[k]) / (x[-1] - x[k]) for y in x[k + 1:]]


def half(side, first):
    """Nodes, cells with their lower faces first, and sets: `side` -1 below, 1 above."""
    h = A / n * (1 if side < 0 else 1.1)
    x, z = graded(h, n + 1, 1.35, WIDTH), graded(h, 3, 1.35, R)
    nx, nodes = len(x), []
    for s in z:
        for b in x:
            for a in x:
                low = R - math.sqrt(R * R - a * a - b * b)
                nodes.append((a, b, side * (low + (1 - low / R) * s)))

    def at(i, j, k):
        return first + i + nx * (j + nx * k)

    cells = []
    for k in range(len(z) - 1):
        for j in range(nx - 1):
            for i in range(nx - 1):
                faces = [[at(i, j, m), at(i + 1, j, m), at(i + 1, j + 1, m), at(i, j + 1, m)] for m in (k, k + 1)]
                cells.append(faces[0] + faces[1] if side > 0 else faces[1] + faces[0])
    top, every = len(z) - 1, range(nx)
    sets = {"TOP": [at(i, j, top) for i in every for j in every], "X": [at(0, j, k) for j in every for k in range(top)],
            "Y": [at(i, 0, k) for i in every for k in range(top)]}
    return nodes, cells, sets, (nx - 1)**2


def mesh():
    lines, (low, high) = ["*NODE"], (half(-1, 1), None)
    high = half(1, 1 + len(low[0]))
    lines += [f"{i + 1}, {x:.15g}, {y:.15g}, {z:.15g}" for i, (x, y, z) in enumerate(low[0] + high[0])]
    cell = 1
    for name, (_, cells, sets, faces) in (("A", low), ("B", high)):
        lines += [f"*ELEMENT, TYPE=C3D8, ELSET={name}"] + [f"{cell + k}, " + ", ".join(map(str, c)) for k, c in enumerate(cells)]
        for which, nodes in sets.items():
            lines += [f"*NSET, NSET={name}{which}"] + [f"{k}," for k in nodes]
        lines += [f"*SURFACE, NAME={name}FACE, TYPE=ELEMENT"] + [f"{cell + k}, {'S2' if name == 'A' else 'S1'}" for k in range(faces)]
        cell += len(cells)
    return lines + ["*MATERIAL, NAME=M", "*ELASTIC", "20000., .3", "*DENSITY", "7.8e-9"] + \
        [f"*SOLID SECTION, ELSET={k}, MATERIAL=M" for k in "AB"], cell - 1


HELD = "".join(f'[[motion]]\nkind = "fixed"\nname = "{s}"\non = "{s}"\ncomponents = ["{c}"]\n'
               for s, c in (("AX", "x"), ("BX", "x"), ("AY", "y"), ("BY", "y")))
SCENE = f"""[material.M]
E = 2e10
nu = 0.3
density = 7800
[region."*"]
material = "M"
[[contact]]
name = "c"
a = "AFACE"
b = "BFACE"
[[motion]]
kind = "fixed"
name = "held"
on = "ATOP"
[[motion]]
kind = "translation"
name = "pressed"
on = "BTOP"
displacement = [0, 0, {-1e-3 * APPROACH}]
{HELD}[output]
fields = ["displacement"]
[time]
analysis = "static"
steps = {STEPS}
"""
THEIRS = f"""*SURFACE INTERACTION, NAME=I
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
{100 * 20000 / (2 * A / n):g}
*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE
BFACE, AFACE
*STEP, NLGEOM, INC=200
*STATIC, DIRECT
{1 / STEPS}, 1.
*BOUNDARY
ATOP, 1, 3
BTOP, 1, 2
BTOP, 3, 3, {-APPROACH}
AX, 1, 1
BX, 1, 1
AY, 2, 2
BY, 2, 2
*NODE PRINT, NSET=ATOP, TOTALS=ONLY
RF
*NODE FILE
U
*END STEP"""


def run(*command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    ran = subprocess.run(command, capture_output=True, text=True, env=dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1"))
    if ran.returncode:
        sys.exit(f"{' '.join(command)}: exit {ran.returncode}\n{ran.stdout[-2000:]}{ran.stderr[-2000:]}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    lines, cells = mesh()
    open("mesh.inp", "w").write("\n".join(lines + [""]))
    open("theirs.inp", "w").write("\n".join(lines + [THEIRS, ""]))
    open("scene.toml", "w").write(SCENE)
    run(tools + "/hilo-import", "--quiet", "mesh.inp", "--units", "mm-t-s", "-o", "mesh.h5")
    ours = run(tools + "/hilo-solve", "--quiet", "scene.toml", "mesh.h5", "-o", "run.h5")
    told = json.load(open("run.json"))
    force = h5py.File("run.h5")["history/contact/c"][-1, 2]
    theirs = run("ccx", "theirs")
    totals = [line.split() for line in open("theirs.dat") if len(line.split()) == 3 and line.split()[0][0] in "-0123456789"]
    reaction = float(totals[-1][2])
    iterations = sum(int(line.split()[3]) for line in open("theirs.sta") if line.split()[:1] == ["1"])
    print(f"{cells} cells, {STEPS} load steps; force of a quarter over that of Hertz, {FORCE:.0f} N; iterations; processor seconds")
    print(f"hilo      {force / FORCE:.4f} {told['newton_iterations']:4} {ours:8.2f}")
    print(f"CalculiX  {abs(reaction) / FORCE:.4f} {iterations:4} {theirs:8.2f}   {theirs / ours:.1f} times as long")
    if abs(force / FORCE - 1) > 0.01 or abs(abs(reaction) / force - 1) > 0.02:
        sys.exit("contact.py: the answers are not equal")
