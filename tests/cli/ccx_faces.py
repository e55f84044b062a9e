#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Face numbers of solids against CalculiX, run here: one deck for each kind of cell and each of its faces P1 to P6, a cell of irregular shape
whose nodes stand on springs to the ground, so that the displacements are the forces of the nodes.

  ccx_faces.py REPO BIN

Total force and moment about the origin are compared, in relation to the area of the face; 1e-4 is what the digits printed leave.  CalculiX
takes pressure on the quadrangles of C3D6 and C3D8R at one point, so that their moments are those of equal forces at the corners: of these kinds
the force alone says which face it is.  A shell has one face, and P1 to P6 of it are P: in CalculiX by its displacements, here by the scene."""
import os
import sys
import tempfile

import numpy as np

import calculix as ccx

ccx.tools(need_decks=False)
STIFF, PRESSURE, LIMIT = 1e6, 1.0, 1e-4
TET = [(0, 0, 0), (1.1, .1, 0), (.2, 1.3, .1), (.1, .2, .9)]
WEDGE = [(0, 0, 0), (1.1, .1, 0), (.2, 1.3, .1), (.1, 0, 1.2), (1.2, .1, 1.3), (.3, 1.2, 1.1)]
HEX = [(0, 0, 0), (1.1, .1, 0), (1.2, 1.3, .1), (.1, 1, .05), (.1, 0, 1.2), (1.2, .1, 1.3), (1.3, 1.25, 1.1), (.15, 1.1, 1)]
KINDS = {"C3D4": (TET, 4), "C3D6": (WEDGE, 5), "C3D8": (HEX, 6), "C3D8R": (HEX, 6), "C3D8I": (HEX, 6), "C3D10": (TET, 4), "C3D15": (WEDGE, 5),
         "C3D20": (HEX, 6), "C3D20R": (HEX, 6)}

ONE_POINT = ("C3D6", "C3D8R")


def points(kind):
    corners = [np.array(x, float) for x in KINDS[kind][0]]
    quadratic = kind[3:5] in ("10", "15", "20")
    return np.array(corners + ([(corners[a] + corners[b]) / 2 for a, b in ccx.EDGES[len(corners)]] if quadratic else []))


def deck(kind, face, X):
    lines = ccx.node_cards(X) + ccx.cell_cards(kind, "E", [range(1, len(X) + 1)])
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", "1e4, .3", "*SOLID SECTION, ELSET=E, MATERIAL=M"]
    for dof in (1, 2, 3):
        lines += [f"*ELEMENT, TYPE=SPRING1, ELSET=S{dof}"] + [f"{100 * dof + i}, {i + 1}" for i in range(len(X))]
        lines += [f"*SPRING, ELSET=S{dof}", str(dof), f"{STIFF:.1f}"]
    return "\n".join(lines + ["*STEP", "*STATIC", "*DLOAD", f"E, P{face}, {PRESSURE:g}", "*NODE PRINT, NSET=ALL", "U", "*END STEP", ""])


def resultant(X, u):
    return np.concatenate([STIFF * u.sum(0), STIFF * np.cross(X, u).sum(0)])


def shell(label):
    return "\n".join(["*NODE, NSET=ALL", "1, 0, 0, 0", "2, 1, 0, 0", "3, 1, 1, 0", "4, 0, 1, 0", "*ELEMENT, TYPE=S4, ELSET=E", "1, 1, 2, 3, 4",
                      "*BOUNDARY", "1, 1, 6", "4, 1, 6", "*MATERIAL, NAME=M", "*ELASTIC", "1e4, .3", "*SHELL SECTION, ELSET=E, MATERIAL=M", ".1",
                      "*STEP", "*STATIC", "*DLOAD", f"E, {label}, {PRESSURE:g}", "*NODE PRINT, NSET=ALL", "U", "*END STEP", ""])


worst, count = 0.0, 0
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for kind, (_, n_faces) in KINDS.items():
        X = points(kind)
        for face in range(1, n_faces + 1):
            ccx.write("a.inp", deck(kind, face, X))
            ccx.run("ccx", "a")
            theirs = np.array(list(ccx.last(ccx.printed(open("a.dat"))).values()))
            ccx.imported("a")
            ours = np.array(list(ccx.solved().values()))
            a, b = resultant(X, ours), resultant(X, theirs)
            if kind in ONE_POINT:
                a, b = a[:3], b[:3]
            off = abs(a - b).max() / np.linalg.norm(b[:3])
            print(f"{kind:<7} P{face}  {b.round(4)}  off {off:.1e}{'' if off < LIMIT else '  DIFFERS'}")
            worst, count = max(worst, off), count + 1
    answers, scenes = set(), set()
    for label in ("P", "P1", "P6"):
        ccx.write("a.inp", shell(label))
        ccx.run("ccx", "a")
        answers.add("".join(line for line in open("a.dat") if len(line.split()) == 4))
        ccx.run("hilo-import", "--quiet", "a.inp", "--thicken", "-o", "a.h5", "--scene-out", "a.toml")
        scenes.add(open("a.toml").read())
    if len(answers) > 1 or len(scenes) > 1:
        sys.exit(f"ccx_faces: P, P1 and P6 of a shell: {len(answers)} answers of CalculiX, {len(scenes)} scenes")
    if "pressure" not in scenes.pop():
        sys.exit("ccx_faces: the pressure of a shell is lost")
print(f"{count} faces, worst {worst:.1e}")
sys.exit(0 if worst < LIMIT else 1)
