#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Decks of calculix-ccx-test with *EQUATION of several terms, and one without any, through ccx and through hilo: the same displacements.

  tests/cli/ccx_equations.py REPO BIN

C3D20R becomes C3D20, which both programs integrate alike.  ccx answers linearly, so hilo's loads are multiplied by 1e-4, and its displacements
divided by that.  The limit is that of the digits which ccx prints."""
import gzip, os, re, shutil, subprocess, sys, tempfile
import h5py
import numpy as np

FOLDER = "/usr/share/doc/calculix-ccx-test/examples/test/"
SMALL, LIMIT = 1e-4, 1e-6
binaries = os.path.abspath(sys.argv[2])
if not os.path.isdir(FOLDER):
    sys.exit("ccx_equations: no decks (apt-get install calculix-ccx-test)")
if not shutil.which("ccx"):
    print("ccx_equations: no ccx (apt-get install calculix-ccx)")
    sys.exit(77)


def printed(text):
    found, on = {}, False
    for line in text.splitlines():
        words = line.split()
        on = "displacements" in line or (on and (not words or words[0].isdigit()))
        if on and len(words) == 4 and words[0].isdigit():
            found[int(words[0])] = [float(w) for w in words[1:]]
    return found


def run(*command):
    ran = subprocess.run(command, capture_output=True, text=True)
    if ran.returncode:
        sys.exit(f"{' '.join(command)}: exit {ran.returncode}\n{ran.stdout[-500:]}{ran.stderr[-500:]}")
    return ran.stderr


bad = 0
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for deck in ("achtelp", "achtel2", "achtel9", "achtelcas", "achtel29"):
        path = FOLDER + deck + ".inp"
        text = open(path).read() if os.path.exists(path) else gzip.open(path + ".gz", "rt").read()
        with open(deck + ".inp", "w") as f:
            f.write(text.replace("C3D20R", "C3D20"))
        run("ccx", deck)
        theirs = printed(open(deck + ".dat").read())
        talk = run(binaries + "/hilo-import", deck + ".inp", "-o", "mesh.h5", "--scene-out", "scene.toml")
        lost = [line for line in talk.splitlines() if "not read" in line and "request for output" not in line]
        scale = lambda m: m[1] + re.sub(r"[-+.\deE]+", lambda n: repr(float(float(n[0]) * SMALL)), m[2])
        scene = re.sub(r"^((?:force|pressure|displacement) = )(.*)$", scale, open("scene.toml").read(), flags=re.M)
        with open("scene.toml", "w") as f:
            f.write(scene + "\n[solver]\ntolerance = 1e-12\n")
        run(binaries + "/hilo-solve", "--quiet", "scene.toml", "mesh.h5", "-o", "run.h5")
        with h5py.File("run.h5") as f:
            ours = f["field"][sorted(f["field"])[-1]]["displacement"][:] / SMALL
        with h5py.File("mesh.h5") as f:
            row = {int(n): i for i, n in enumerate(f["/mesh/nodes/id"][:])}
        nodes = [n for n in theirs if n in row]
        exact = np.array([theirs[n] for n in nodes])
        off = abs(np.array([ours[row[n]] for n in nodes]) - exact).max() / abs(exact).max()
        wrong = bool(lost) or len(nodes) < 50 or not off < LIMIT
        bad += wrong
        print(f"{deck:<12}{scene.count('weighted-sum'):>4} rows {len(nodes):>4} nodes  largest u {abs(exact).max():.4g}  difference {off:.1e}{'  WRONG ' if wrong else ''}"
              + "".join(lost))
sys.exit(bad > 0)
