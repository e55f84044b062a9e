#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reference nodes against CalculiX, run here on the same cells: the beam of calculix-ccx-test's beamprb with C3D20 cells, its end carried by a
rigid body, a kinematic and a distributing coupling, and held by a spring.  Loads are a thousandth, so that the answer is linear.
And its beamptied2, two meshes of C3D20R that *TIE holds together: there nodes follow faces, here the rows are integrals.

  ccx_ties.py REPO BIN"""
import os
import re
import sys
import tempfile

import calculix as ccx

ccx.tools()
LIMIT = 2e-5  # of the largest displacement: printed digits, and what a thousandth of the load leaves of nonlinear terms
OF_TIES = 3e-4  # of the same, where the rows of a tie are others
SMALL = 1e-3
FACES = [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 4, 5), (1, 2, 5, 6), (2, 3, 6, 7), (0, 3, 4, 7)]  # S1.. of a hexahedron
COUPLING = "*SURFACE, NAME=END, TYPE=NODE\nN1,\n*COUPLING, REF NODE=262, SURFACE=END, CONSTRAINT NAME=C1\n*{}\n"
TIES = {
    "rigid body": ("*RIGID BODY,NSET=N1,REF NODE=262,ROT NODE=263\n", "263,2,1.\n262,1,.2\n263,3,.7\n"),
    "kinematic": (COUPLING.format("KINEMATIC\n1,3"), "262,1,.2\n262,5,1.\n262,6,.7\n"),
    "distributing": ("*SURFACE, NAME=END\nFACES" + COUPLING[COUPLING.index("*COUPLING"):].format("DISTRIBUTING\n1,6"), "262,1,.2\n262,2,.1\n262,3,.7\n"),
    "spring": ("*ELEMENT, TYPE=SPRINGA, ELSET=ES\n900,5,1\n*SPRING, ELSET=ES\n\n300.\n", "5,1,.2\n6,3,.3\n"),
}


def end_faces(text):
    """Lines "element, face" of the cells' faces at z = 8."""
    z = {int(n): float(v) for n, v in re.findall(r"^ *(\d+), *[^,\n]+, *[^,\n]+, *([-+.\deE]+) *$", text.split("*ELEMENT")[0], flags=re.M)}
    numbers = [int(x) for x in re.findall(r"\d+", text.split("*ELEMENT")[1].split("\n", 1)[1].split("*")[0])]
    lines = ""
    for e in range(0, len(numbers), 21):
        for face, corners in enumerate(FACES):
            if all(abs(z[numbers[e + 1 + c]] - 8) < 1e-6 for c in corners):
                lines += f"{numbers[e]}, S{face + 1}\n"
    return lines


def hanging(tie, loads):
    text = ccx.stored("beamprb.inp").replace("C3D20R", "C3D20")
    text = re.sub(r"\*RIGID BODY.*\n", lambda _: tie.replace("FACES", end_faces(text)), text)
    text = re.sub(r"\*CLOAD\n.*\n", lambda _: "*CLOAD\n" + loads, text)
    return re.sub(r"\*NODE FILE\nU\n", lambda _: "*NODE PRINT, NSET=Nall\nU\n", text)


def compare(name, text, limit):
    ccx.write("deck.inp", text)
    ccx.run("ccx", "deck")
    ccx.imported("deck")
    nodes, largest, difference = ccx.apart(ccx.solved("", SMALL), ccx.last(ccx.printed(open("deck.dat"))))
    print(f"{name:<16}{nodes:>7}{largest:>14.4g}{difference:>12.1e}{limit:>9.0e}  {'agrees' if difference < limit else 'DIFFERS'}")
    return difference < limit


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    print(f"{'tie':<16}{'nodes':>7}{'largest u':>14}{'difference':>12}{'limit':>9}")
    sys.exit(0 if all([compare(name, hanging(*case), LIMIT) for name, case in TIES.items()] + [compare("surfaces", ccx.stored("beamptied2.inp"), OF_TIES)]) else 1)
