#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Decks of calculix-ccx-test through hilo-import and hilo-solve, against the reference results the package brings along.

  tests/cli/ccx_reference.py REPO BIN [DECK...]

Compared are the displacements of all printed nodes at the end of the first step (NAME.dat.ref, or NAME.frd.ref where the deck prints none).
Difference = largest component of u - u_ref over the largest component of u_ref.  A deck without NLGEOM asks for the linear answer: its loads and
prescribed displacements are multiplied by a factor that makes the displacements SMALL of the model's extent, and the displacements divided by it.

Of decks of buckling their factors are compared, the first FACTORS.

Limits: where CalculiX integrates the same element by the same points the two answers are one number, up to its printed digits (SAME).  C3D20R
leaves six modes of a cell without stiffness, hilo's hex20r holds them by a tenth of theirs (REDUCED); beampic was solved by iteration (ITERATED)."""
import os, re, sys, tempfile
import h5py
import numpy as np

import calculix as ccx

SMALL, SAME, REDUCED, ITERATED, BUCKLED, FACTORS, WANTED = 1e-6, 1e-5, 3e-4, 3e-3, 1.5e-3, 5, 16
DECKS = {  # deck: limit
    "beam10p": SAME,             # tip force, 4 points
    "beam20p": SAME,             # tip force, 27 points
    "c3d15": SAME,               # wedges under pressure, 9 points
    "c3d6": SAME,                # wedges under tension, 2 points
    "beamnld": SAME,             # prescribed stretch, the field is linear: any points are exact
    "beamd": REDUCED,            # pressure on an end face
    "beamwrite": REDUCED,        # pressure on an end face, large displacements, amplitude
    "beamp": REDUCED,            # tip force; the next six are the same beam said in other words
    "beamidset": REDUCED,        # material and section by set
    "beampset": REDUCED,         # set of sets
    "beamp2stage": REDUCED,      # supports in two *BOUNDARY blocks
    "beampic": ITERATED,         # another solver of CalculiX
    "beampis": REDUCED,          # another solver; 500 times the force: the linear answer is 43 long on a beam of 8
    "beampfix": REDUCED,         # first of two steps
    "changesolidsection": REDUCED,
    "beamnlp": REDUCED,          # tip force, large displacements
    "beamnlptp": REDUCED,        # the same, with *TIME POINTS
    "beamb": BUCKLED,            # factors of a column; cells of beam8b are others in hilo, 10 % apart
    "beamdynamic": REDUCED,      # static first step of a dynamic deck, in 1e-6 s
}


class NothingPrinted(Exception):
    """The deck's reference has no displacements of its first step."""


def first_step(deck):
    """Is the first step of the deck nonlinear, and how long is it?"""
    lines = [l for l in deck.splitlines() if not l.startswith("**") and l.strip()]
    start = next(i for i, l in enumerate(lines) if l.upper().startswith("*STEP"))
    static = next(i for i, l in enumerate(lines) if i > start and l.upper().startswith("*STATIC"))
    numbers = [] if lines[static + 1].startswith("*") else lines[static + 1].split(",")
    return "NLGEOM" in lines[start].upper(), float(numbers[1]) if len(numbers) > 1 else 1.0


def compare(deck):
    """A row: elements, nodes compared, linear or not, largest |u|, difference, what was not read."""
    text = ccx.stored(deck + ".inp")
    nonlinear, period = first_step(text)
    ccx.write(deck + ".inp", re.split(r"^\*END *STEP.*$", text, maxsplit=1, flags=re.M | re.I)[0] + "*END STEP\n")
    left = [re.sub(r"^.*not read: | \(\d+.*$", "", line) for line in ccx.imported(deck)]
    with h5py.File("mesh.h5") as f:
        extent = np.ptp(f["/mesh/nodes/X"][:], axis=0).max()
    plotted = ccx.plotted(ccx.stored(deck + ".frd.ref").splitlines())
    blocks = ccx.printed(ccx.stored(deck + ".dat.ref").splitlines()) or {t: {n: u[:3] for n, u in f["DISP"].items()} for t, f in plotted.items() if "DISP" in f}
    times = [t for t in blocks if t <= period * (1 + 1e-6)]
    if not times:
        raise NothingPrinted("nothing is printed of the first step")  # beamwrite of Debian 13
    theirs = blocks[max(times)]
    factor = 1.0 if nonlinear else min(1.0, SMALL * extent / abs(np.array(list(theirs.values()))).max())
    nodes, largest, difference = ccx.apart(ccx.solved("\n[solver]\ntolerance = 1e-13\n", factor), theirs)
    elements = re.findall(r"^\*ELEMENT\b.*TYPE *= *(\w+)", text, re.M | re.I)
    return " ".join(sorted(set(e.upper() for e in elements))), nodes, "nonlinear" if nonlinear else "linear", largest, difference, left


def compare_factors(deck):
    """As compare, of the factors of buckling."""
    text = ccx.stored(deck + ".inp")
    ccx.write(deck + ".inp", text)
    left = [re.sub(r"^.*not read: | \(\d+.*$", "", line) for line in ccx.imported(deck)]
    theirs = [float(f) for f in re.findall(r"^ +\d+ +(\d\S*E\S+) *$", ccx.stored(deck + ".dat.ref"), re.M)][:FACTORS]
    ccx.solved("\n[solver]\ntolerance = 1e-13\n", 1.0)
    with h5py.File("run.h5") as f:
        ours = f["/history/buckling"][1:FACTORS + 1, 0]
    elements = re.findall(r"^\*ELEMENT\b.*TYPE *= *(\w+)", text, re.M | re.I)
    return " ".join(sorted(set(e.upper() for e in elements))), len(theirs), "buckling", theirs[0], max(abs(ours / theirs - 1)), left


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    ccx.tools(need_ccx=False)
    decks = sys.argv[3:] or list(DECKS)
    print(f"{'deck':<20}{'element':<9}{'nodes':>6}  {'analysis':<10}{'largest u':>11}{'difference':>12}{'limit':>9}")
    good = left_out = 0
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for deck in decks:
            limit = DECKS.get(deck, REDUCED)
            try:
                elements, nodes, analysis, largest, difference, left = (compare_factors if limit == BUCKLED else compare)(deck)
            except NothingPrinted as error:
                print(f"{deck:<20}{error}: left out")
                left_out += 1
                continue
            except (RuntimeError, StopIteration, ValueError) as error:
                print(f"{deck:<20}{error or 'no static step'}")
                continue
            agrees = difference <= limit
            good += agrees
            note = "" if agrees else "  DIFFERS"
            if sys.argv[3:] and left:
                note += "  not read: " + ", ".join(left)
            print(f"{deck:<20}{elements:<9}{nodes:>6}  {analysis:<10}{largest:>11.4g}{difference:>12.1e}{limit:>9.0e}{note}", flush=True)
        os.chdir("/")
    print(f"{good} of {len(decks) - left_out} decks agree")
    sys.exit(0 if good == len(decks) - left_out and (sys.argv[3:] or good >= WANTED) else 1)


main()
