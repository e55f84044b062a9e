#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Decks of calculix-ccx-test through hilo-import and hilo-solve, against the reference results the package brings along.

  tests/cli/ccx_reference.py REPO BIN [DECK...]

Compared are the displacements of all printed nodes at the end of the first step (NAME.dat.ref, or NAME.frd.ref where the deck prints none).
Difference = largest component of u - u_ref over the largest component of u_ref.  A deck without NLGEOM asks for the linear answer: its loads and
prescribed displacements are multiplied by a factor that makes the displacements SMALL of the model's extent, and the displacements divided by it.

Limits: where CalculiX integrates the same element by the same points the two answers are one number, up to its printed digits (SAME).  C3D20R
leaves six modes of a cell without stiffness, hilo's hex20r holds them by a tenth of theirs (REDUCED); beampic was solved by iteration (ITERATED)."""
import gzip, os, re, subprocess, sys, tempfile
import h5py
import numpy as np

FOLDER = "/usr/share/doc/calculix-ccx-test/examples/test/"
SMALL, SAME, REDUCED, ITERATED, WANTED = 1e-6, 1e-5, 3e-4, 3e-3, 15
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
    "beamdynamic": REDUCED,      # static first step of a dynamic deck, in 1e-6 s
}
SCALED = re.compile(r"^((?:force|pressure|gravity|displacement|torque) = )(.*)$", re.M)


def read(name):
    if os.path.exists(FOLDER + name):
        return open(FOLDER + name, errors="replace").read()
    if os.path.exists(FOLDER + name + ".gz"):
        return gzip.open(FOLDER + name + ".gz", "rt", errors="replace").read()
    return ""


def printed(text):
    """{time: {node: u}} of a .dat file."""
    blocks, block = {}, None
    for line in text.splitlines():
        field = line.split()
        if line.startswith(" displacements (vx,vy,vz)"):
            block = blocks.setdefault(float(field[-1]), {})
        elif block is not None and len(field) == 4 and field[0].isdigit():
            block[int(field[0])] = [float(x) for x in field[1:]]
        elif field:
            block = None
    return blocks


def plotted(text):
    """{time: {node: u}} of a .frd file: twelve columns for a number."""
    blocks, block, time = {}, None, 0.0
    for line in text.splitlines():
        if line.startswith("  100CL"):
            time = float(line[12:24])
        elif line.startswith(" -4"):
            block = blocks.setdefault(time, {}) if line.split()[1] == "DISP" else None
        elif line.startswith(" -1") and block is not None:
            block[int(line[3:13])] = [float(line[13 + 12 * i:25 + 12 * i]) for i in range(3)]
    return blocks


class NothingPrinted(Exception):
    """The deck's reference has no displacements of its first step."""


def first_step(deck):
    """Is the first step of the deck nonlinear, and how long is it?"""
    lines = [l for l in deck.splitlines() if not l.startswith("**") and l.strip()]
    start = next(i for i, l in enumerate(lines) if l.upper().startswith("*STEP"))
    static = next(i for i, l in enumerate(lines) if i > start and l.upper().startswith("*STATIC"))
    numbers = [] if lines[static + 1].startswith("*") else lines[static + 1].split(",")
    return "NLGEOM" in lines[start].upper(), float(numbers[1]) if len(numbers) > 1 else 1.0


def run(*command):
    ran = subprocess.run(command, capture_output=True, text=True)
    if ran.returncode:
        raise RuntimeError(f"{os.path.basename(command[0])} exit {ran.returncode}: {(ran.stderr.strip().splitlines() or ['-'])[-1]}")
    return ran.stderr


def compare(binaries, deck):
    """A row: elements, nodes compared, linear or not, largest |u|, difference, what was not read."""
    nonlinear, period = first_step(read(deck + ".inp"))
    with open(deck + ".inp", "w") as f:
        f.write(re.split(r"^\*END *STEP.*$", read(deck + ".inp"), maxsplit=1, flags=re.M | re.I)[0] + "*END STEP\n")
    talk = run(binaries + "/hilo-import", deck + ".inp", "-o", "mesh.h5", "--scene-out", "scene.toml")
    left = [re.sub(r"^.*not read: | \(\d+.*$", "", l) for l in talk.splitlines() if "not read" in l and "request for output" not in l]
    with h5py.File("mesh.h5") as f:
        row_of = {int(n): i for i, n in enumerate(f["/mesh/nodes/id"][:])}
        extent = np.ptp(f["/mesh/nodes/X"][:], axis=0).max()
    blocks = printed(read(deck + ".dat.ref")) or plotted(read(deck + ".frd.ref"))
    times = [t for t in blocks if t <= period * (1 + 1e-6)]
    if not times:
        raise NothingPrinted("nothing is printed of the first step")  # beamwrite of Debian 13
    theirs = blocks[max(times)]
    nodes = [n for n in theirs if n in row_of]
    if not nodes:
        raise RuntimeError("no node in common with the reference")
    b = np.array([theirs[n] for n in nodes])
    largest = abs(b).max()
    factor = 1.0 if nonlinear else min(1.0, SMALL * extent / largest)
    scale = lambda m: m[1] + re.sub(r"[-+.\deE]+", lambda number: repr(float(float(number[0]) * factor)), m[2])
    with open("scene.toml") as f:
        scene = SCALED.sub(scale, f.read())
    with open("scene.toml", "w") as f:
        f.write(scene + "\n[solver]\ntolerance = 1e-13\n")
    run(binaries + "/hilo-solve", "--quiet", "scene.toml", "mesh.h5", "-o", "run.h5")
    with h5py.File("run.h5") as f:
        ours = f["field"][sorted(f["field"])[-1]]["displacement"][:] / factor
    difference = abs(ours[[row_of[n] for n in nodes]] - b).max() / largest
    elements = re.findall(r"^\*ELEMENT\b.*TYPE *= *(\w+)", read(deck + ".inp"), re.M | re.I)
    return " ".join(sorted(set(e.upper() for e in elements))), len(nodes), "nonlinear" if nonlinear else "linear", largest, difference, left


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    if not os.path.isdir(FOLDER):
        sys.exit(f"ccx_reference.py: no {FOLDER} (apt-get install calculix-ccx-test)")
    binaries, decks = os.path.abspath(sys.argv[2]), sys.argv[3:] or list(DECKS)
    print(f"{'deck':<20}{'element':<9}{'nodes':>6}  {'analysis':<10}{'largest u':>11}{'difference':>12}{'limit':>9}")
    good = left_out = 0
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for deck in decks:
            limit = DECKS.get(deck, REDUCED)
            try:
                elements, nodes, analysis, largest, difference, left = compare(binaries, deck)
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
