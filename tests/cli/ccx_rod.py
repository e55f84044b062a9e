#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stress at the surface of a connecting rod (rod.geo, quadratic tetrahedra) against CalculiX, run here on the same cells: a peak at a fillet
must not come out low because nodal stress is the mean of what the cells have inside.

  ccx_rod.py REPO BIN [H]     H: edge of the cells, 0.008 m"""
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

repo, tools = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
edge = sys.argv[3] if len(sys.argv) > 3 else "0.008"
LIMIT_U, LIMIT_STRESS = 1e-5, 0.01  # of the peak: printed digits; extrapolation to a node is not the same in both


def run(*command):
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def deck(X, cells):
    """The big eye held in its bore, the small one pulled and pushed aside: 2 N and 0.1 N, so that the answer is linear."""
    held = np.where(abs(np.hypot(X[:, 0], X[:, 1]) - 0.025) < 1e-4)[0]
    pulled = np.where(abs(np.hypot(X[:, 0] - 0.15, X[:, 1]) - 0.011) < 1e-4)[0]
    lines = ["*NODE, NSET=ALL"] + [f"{i + 1}, {x[0]:.12g}, {x[1]:.12g}, {x[2]:.12g}" for i, x in enumerate(X)]
    lines += ["*ELEMENT, TYPE=C3D10, ELSET=ROD"] + [f"{i + 1}, " + ", ".join(str(k + 1) for k in c) for i, c in enumerate(cells)]
    for name, nodes in (("BIG", held), ("SMALL", pulled)):
        lines += [f"*NSET, NSET={name}"] + [f"{k + 1}," for k in nodes]
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "2.1e11, 0.3", "*DENSITY", "7850.", "*SOLID SECTION, ELSET=ROD, MATERIAL=STEEL"]
    lines += ["*BOUNDARY", "BIG, 1, 3", "*STEP", "*STATIC", "1., 1.", "*CLOAD"]
    lines += [f"SMALL, 1, {-2 / len(pulled):.12g}", f"SMALL, 2, {0.1 / len(pulled):.12g}"]
    return "\n".join(lines + ["*NODE FILE", "U", "*EL FILE", "S", "*END STEP", ""])


def plotted(path):
    """{field: {node: values}} of a .frd file: twelve columns for a number."""
    fields, name = {}, None
    for line in open(path):
        if line.startswith(" -4"):
            name = line.split()[1]
            fields[name] = {}
        elif line.startswith(" -1") and name:
            fields[name][int(line[3:13])] = [float(line[k:k + 12]) for k in range(13, len(line.rstrip()), 12)]
        elif line.startswith(" -3"):
            name = None
    return fields


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    run(tools + "/hilo-import", "--quiet", repo + "/tests/cli/rod.geo", "--define", "H=" + edge, "--order", "2", "-o", "cad.h5")
    with h5py.File("cad.h5") as f:
        X, cells = f["mesh/nodes/X"][:], f["mesh/cells/nodes"][:].reshape(-1, 10)
    open("rod.inp", "w").write(deck(X, cells))
    run("ccx", "rod")
    theirs = plotted("rod.frd")
    u, s = (np.array([theirs[k][i + 1] for i in range(len(X))]) for k in ("DISP", "STRESS"))
    mises = np.sqrt(((s[:, 0] - s[:, 1])**2 + (s[:, 1] - s[:, 2])**2 + (s[:, 2] - s[:, 0])**2) / 2 + 3 * (s[:, 3:]**2).sum(1))
    run(tools + "/hilo-import", "--quiet", "rod.inp", "-o", "mesh.h5", "--scene-out", "scene.toml")
    open("scene.toml", "a").write("\n[solver]\ntolerance = 1e-12\n")
    run(tools + "/hilo-solve", "--quiet", "scene.toml", "mesh.h5", "-o", "run.h5")
    with h5py.File("run.h5") as f:
        last = f["field"][sorted(f["field"])[-1]]
        ours, stress = last["displacement"][:], last["von_mises"][:]
    os.chdir("/")
apart, peak, node = abs(ours - u).max() / abs(u).max(), stress.max() / mises.max(), np.argmax(mises)
print(f"{len(cells)} cells: displacements differ by {apart:.1e}; peak von Mises stress over CalculiX's {peak:.4f}, at its node {stress[node] / mises[node]:.4f}")
sys.exit(0 if apart < LIMIT_U and max(abs(peak - 1), abs(stress[node] / mises[node] - 1)) < LIMIT_STRESS else 1)
