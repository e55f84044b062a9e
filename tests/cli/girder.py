#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The box girder of data/girder on a coarse mesh: buckling under a moment and a force beside finite strips (data/girder/strips.py), the first
shape that of the moment as given, and the path of the pressed girder, bent by its first shape, beside the stiffness beyond buckling of a wall
whose edges pull in, by one term of von Karman's plate.

  tests/cli/girder.py REPO BIN"""
import math
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

repo, tools = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
sys.path.insert(0, repo + "/data/girder")
sys.dont_write_bytecode = True
import strips

B, T, L, E, NU = 0.3, 0.003, 1.8, 2.1e11, 0.3
PRESSED = [f"load.moment_{side}.torque=[0,0,0]" for side in ("left", "right")] + ["load.press.force=[-400e3,0,0]"]


def run(tool, *words):
    ran = subprocess.run([f"{tools}/{tool}", *words], capture_output=True, text=True)
    if ran.returncode:
        sys.exit(f"{tool} {' '.join(words)}\n{ran.stderr}")


def solve(mesh, results, *overrides):
    both = [f"{section}.at=[{L},0,0]" for section in ("joint.support_right", "load.press", "probe.right")] + list(overrides)
    run("hilo-solve", "--quiet", f"{repo}/data/girder/scene.toml", mesh, "-o", results, *(w for o in both for w in ("--set", o)))


def stiffness_beyond():
    """Of a long wall on hinges over that before.  w = f sin(pi x/b) sin(pi y/b) makes (E f^2 pi^4/2b^4)(cos 2kx + cos 2ky) of del^4 F, k = pi/b.
    The second part is that of straight edges.  The first is g(y) cos 2kx with g = g' = 0 at edges without stress, whose mean counts."""
    z = math.pi
    b = -1 / (math.cosh(z) + z / math.sinh(z))
    a = -b * (1 + z / math.tanh(z))
    mean = 1 - a * math.sinh(z) / z - b * (math.cosh(z) - math.sinh(z) / z)
    return (1 + mean) / (3 + mean)


def check_bend():
    """Nodes move by the shapes, each of the size asked for; what cannot be is refused and leaves nothing."""
    run("hilo-post", "bend", "force.h5", "--shape", "1=0.2e-3", "--shape", "2=-0.1e-3", "-o", "two.h5")
    with h5py.File("force.h5") as r, h5py.File("mesh.h5") as mesh, h5py.File("two.h5") as two:
        shapes = [r[f"field/{k:06}/displacement"][:] - r["field/000000/displacement"][:] for k in (1, 2)]
        want = sum(size * s / np.linalg.norm(s, axis=1).max() for size, s in zip((0.2e-3, -0.1e-3), shapes))
        off = np.abs(two["mesh/nodes/X"][:] - mesh["mesh/nodes/X"][:] - want).max()
        points = np.linalg.norm(two["mesh/blocks/X"][:] - mesh["mesh/blocks/X"][:], axis=1).max()
    faults = off > 1e-12 or points > 1e-4
    print(f"two shapes: nodes are off by {off:.1e} m, points of folds moved by {points:.1e} m")
    for shape, said in (("1", "is not a step and the size"), ("1=0", "is not a step"), ("1=nan", "is not a step"), ("1=2mm", "is not a step"),
                        ("0=1e-3", "nothing moves"), ("all=1e-3", "not one step"), ("9=1e-3", "no step 9")):
        ran = subprocess.run([f"{tools}/hilo-post", "bend", "force.h5", "--shape", shape, "-o", "not.h5"], capture_output=True, text=True)
        if ran.returncode not in (1, 2) or said not in ran.stderr or os.path.exists("not.h5"):
            print(f"--shape {shape}: exit {ran.returncode}, {ran.stderr}")
            faults = True
    return faults


wrong = 0
def judge(what, value, truth, limit):
    global wrong
    off = abs(value / truth - 1)
    wrong += not off < limit
    print(f"{what:44} {value:10.4f}  known {truth:10.4f}  off {off:.1e} (limit {limit:g})")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    run("hilo-import", f"{repo}/data/girder/girder.geo", "--quiet", "--define", "N=8", "--define", f"L={L}", "--thickness", str(T), "-o", "mesh.h5")
    for what, bends, overrides, load in (("moment", True, [], 60e3 / (4 / 3 * B * B * T)), ("force", False, PRESSED, 400e3 / (4 * B * T))):
        solve("mesh.h5", f"{what}.h5", 'time.analysis="buckling"', "time.modes=2", *overrides)
        factor = h5py.File(f"{what}.h5")["history/buckling"][1, 0]
        judge(f"stress where it buckles under a {what} [MPa]", factor * load / 1e6, strips.buckling_stress(B, T, L, E, NU, bends) / 1e6, 0.025)
    wrong += check_bend()
    run("hilo-post", "bend", "force.h5", "--shape", "1=0.15e-3", "-o", "bent.h5")
    solve("bent.h5", "path.h5", "time.steps=10", *PRESSED)
    with h5py.File("path.h5") as r:
        force, way = 400e3 * r["history/path"][:, 0], L - r["history/probe/right"][:, 0]
    judge("stiffness at first [kN/mm]", force[1] / way[1] / 1e6, E * 4 * B * T / L / 1e6, 0.03)
    at = np.interp(np.array([1.15, 1.4]) * 400e3 * factor, force, way)
    judge("stiffness beyond buckling over that", 0.25 * 400e3 * factor / (at[1] - at[0]) / (force[1] / way[1]), stiffness_beyond(), 0.08)
sys.exit(1 if wrong else 0)
