#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Of which order is a method with every kind of joint, spring, load, motion, and with regions and beams?  One small scene of each kind, each at
four steps, halved: how far the last two ends are apart [m], and the orders that differences of ends show.

  orders.py BIN [--methods gauss,radau] [--only WORD]...

A kind of which both orders are more than 0.8 below that of its method is marked, and the exit code is 1.  Kinks (a support that lifts off)
have no order."""
import argparse
import math
import os
import subprocess
import sys
import tempfile

import h5py
import numpy

ORDER = {"gauss": 6, "radau": 5}  # others: 2
SMOOTH = 'history = {t = [-0.3, 1.2], value = [0, 1], interpolation = "smoother"}\n'
CUBE = """*NODE
1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n5, 0, 0, 1\n6, 1, 0, 1\n7, 1, 1, 1\n8, 0, 1, 1
*ELEMENT, TYPE=C3D8, ELSET=cube\n1, 1, 2, 3, 4, 5, 6, 7, 8
*NSET, NSET=base\n1, 2, 3, 4\n*NSET, NSET=corner\n7\n*SURFACE, NAME=top, TYPE=ELEMENT\n1, S2
*SOLID SECTION, ELSET=cube, MATERIAL=M\n*MATERIAL, NAME=M\n*ELASTIC\n1e5, 0.3\n*DENSITY\n1000
"""
PLATE = """*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n*ELEMENT, TYPE=S4, ELSET=cube\n1, 1, 2, 3, 4
*NSET, NSET=base\n1, 4\n*NSET, NSET=corner\n3\n*SHELL SECTION, ELSET=cube, MATERIAL=M\n0.1
*MATERIAL, NAME=M\n*ELASTIC\n1e5, 0.3\n*DENSITY\n1000
"""
LAWS = {"stvk": "E = 1e5\nnu = 0.3\n", "neo-hookean": "E = 1e5\nnu = 0.3\n", "mooney-rivlin": "c10 = 1e4\nc01 = 5e3\nbulk = 1e5\n",
        "ogden": "mu = [3e4]\nalpha = [1.5]\nbulk = 1e5\n"}


def entry(section, **keys):
    def value(x):
        return f'"{x}"' if isinstance(x, str) else str(x).lower() if isinstance(x, bool) else repr(x)
    return f"[[{section}]]\n" + "".join(f"{key} = {value(x)}\n" for key, x in keys.items())


def joint(kind, smooth=False, **keys):
    if kind not in ("spherical", "fixed", "distance") and "axis" not in keys:
        keys["axis"] = [0.2, 1, 0.3]
    if kind != "distance":
        keys["at"] = [1, 0.1, 0]
    return entry("joint", kind=kind, name="j", a="one", b="two", **keys) + (SMOOTH if smooth else "")


def bodies():
    """Two bodies, the first on a ball joint: what joins the second to it, or acts on it."""
    ball, hinge, slide = joint("spherical"), joint("revolute"), joint("prismatic")
    soft = {"stiffness": [2000, 3000, 1000], "damping": [20, 30, 10]}
    turns = {"angular_stiffness": [200, 300, 100], "angular_damping": [3, 2, 4]}
    for kind in ("spherical", "revolute", "cylindrical", "prismatic", "constant-velocity", "planar", "in-plane", "in-line", "fixed"):
        yield kind, joint(kind)
    yield "universal", joint("universal", axis=[0, 1, 0], x=[1, 0, 0])
    yield "screw", joint("screw", pitch=0.2)
    yield "distance", joint("distance", at_a=[1, 0.1, 0], at_b=[1.3, 0.4, 0.1])
    yield "revolute, angle", joint("revolute", True, angle=1.5)
    yield "revolute, spin", joint("revolute", True, spin=3)
    yield "prismatic, displacement", joint("prismatic", True, displacement=0.4)
    yield "prismatic, velocity", joint("prismatic", True, velocity=1)
    yield "fixed, soft", joint("fixed", **soft, **turns)
    yield "spherical, soft", joint("spherical", **soft)
    yield "revolute, soft", joint("revolute", **soft, angular_stiffness=[200, 300, 0], angular_damping=[3, 2, 0.5])
    for name, keys in (("bushing", soft), ("bushing, three angles", turns), ("bushing, two angles", dict(turns, angular_stiffness=[20, 30, 0])),
                       ("bushing, an angle", dict(turns, angular_stiffness=[0, 0, 30])), ("bushing, drag", {"angular_damping": [2, 3, 1]})):
        yield name, ball + entry("spring", kind="bushing", name="s", a="one", b="two", at=[1.2, 0.1, 0] if keys is soft else [1, 0.1, 0], **keys)
    ends = {"a": "ground", "b": "two", "at_a": [0, 0, 2], "at_b": [1.6, 0.3, 0.1]}
    yield "axial", ball + entry("spring", kind="axial", name="s", **ends, stiffness=100, damping=10, length=2)
    yield "curve", ball + entry("spring", kind="curve", name="s", **ends, extension=[-3, 3], force=[-90, 90], damping=2)
    yield "torsion", hinge + entry("spring", kind="torsion", name="s", a="one", b="two", axis=[0.2, 1, 0.3], stiffness=10, damping=1)
    yield "motor", slide + entry("motor", kind="linear", name="m", joint="j", rate=[-100, 100], force=[200, -200])
    yield "friction", hinge + entry("friction", name="f", joint="j", coefficient=0.3, radius=0.1, preload=20, slip_velocity=1)
    yield "friction, pressed", hinge + entry("friction", name="f", joint="j", coefficient=0.3, radius=0.1, reaction=True, slip_velocity=1)
    yield "force", ball + entry("load", kind="force", name="l", on="two", force=[3, 5, 4], at=[1.6, 0.3, 0.1]) + SMOOTH
    yield "torque", ball + entry("load", kind="torque", name="l", on="two", torque=[3, 2, 1]) + SMOOTH
    yield "torque, follower", ball + entry("load", kind="torque", name="l", on="two", torque=[3, 2, 1], follower=True) + SMOOTH
    yield "acceleration", ball + entry("load", kind="acceleration", name="l", on="two", acceleration=[3, 2, 1]) + SMOOTH
    cart = entry("body", name="cart", mass=1, com=[1.5, 0, 0], inertia=[1, 1, 1]) + \
        entry("joint", kind="spherical", name="j", a="cart", b="two", at=[1.5, 0.1, 0])
    yield "motion, translation", cart + entry("motion", kind="translation", name="m", on="cart", displacement=[0.3, 0.2, 0.4]) + SMOOTH
    yield "motion, rotation", cart + entry("motion", kind="rotation", name="m", on="cart", at=[1.5, 0, 0], axis=[0.3, 0.2, 0.4], angle=1) + SMOOTH


def machine(more):
    return "gravity = [0.5, 1, -9.81]\n" + entry("body", name="one", mass=2, com=[0.5, 0.1, 0], inertia=[0.1, 0.2, 0.15]) + \
        entry("body", name="two", mass=1, com=[1.3, 0.2, 0.1], inertia=[0.05, 0.04, 0.06]) + \
        entry("joint", kind="spherical", name="top", a="ground", b="one", at=[0, 0, 0]) + more + \
        "".join(entry("initial", on=[name], spin=[0.3, 1, 0.5], about=[0, 0, 0]).replace("'", '"') for name in ("one", "two")) + \
        entry("probe", name="tip", on="two", at=[1.6, 0.3, 0.1]) + "[time]\nend = 0.6\nstep = 0.02\n"


def solid(law="stvk", region="", more=""):
    return f'gravity = [0, 0, -9.81]\n[material.m]\nkind = "{law}"\n{LAWS[law]}density = 1000\n[region.cube]\nmaterial = "m"\n{region}' + \
        entry("motion", kind="fixed", name="held", on="base") + more + entry("probe", name="tip", on="corner") + "[time]\nend = 0.4\nstep = 0.01\n"


def beam(keys="", more=""):
    return 'gravity = [0, 0.3, -9.81]\n[material.m]\nE = 1e7\nnu = 0.3\ndensity = 1000\n[section.s]\nkind = "rectangle"\nwidth = 0.1\n' \
        'height = 0.1\n[beam.arm]\npoints = [[0, 0, 0], [1, 0, 0]]\ncells = [1]\nsection = "s"\nmaterial = "m"\na = "ground"\n' + keys + more + \
        entry("probe", name="tip", on="arm.1") + "[time]\nend = 0.4\nstep = 0.01\n"


def parts():
    """Name, mesh and scene."""
    for law in LAWS:
        yield law, "cube.h5", solid(law)
        yield law + ", damping", "cube.h5", solid(law, "damping = 0.01\n")
    yield "mass_damping", "cube.h5", solid(region="mass_damping = 2\n")
    pressure = entry("load", kind="pressure", name="p", on="top", pressure=3000) + SMOOTH
    yield "pressure", "cube.h5", solid(more=pressure)
    yield "traction", "cube.h5", solid(more=entry("load", kind="traction", name="p", on="top", traction=[2000, 0, 1000]) + SMOOTH)
    yield "linear region", "linear.h5", solid(more=pressure)
    yield "linear region, damping", "linear.h5", solid(region="damping = 0.01\nmass_damping = 1\n")
    yield "linear region, modal_damping", "linear.h5", solid(region="modal_damping = 0.05\n")
    yield "shell, damping", "plate.h5", solid(region="damping = 0.01\n")
    line = entry("load", kind="line", name="l", on="arm", force_per_length=[3, 20, 5], follower=True) + SMOOTH
    yield "beam", "", beam()
    yield "beam, damping", "", beam("damping = 0.005\n")
    yield "beam, mass_damping", "", beam("mass_damping = 2\n")
    yield "beam, line load", "", beam(more=line)
    yield "linear beam, line load", "", beam('fidelity = "linear"\n', line)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("bin")
    arguments.add_argument("--methods", default="gauss,radau")
    arguments.add_argument("--only", action="append", default=[])
    o = arguments.parse_args()
    tools = os.path.abspath(o.bin)
    os.chdir(tempfile.mkdtemp())
    for name, text in (("cube", CUBE), ("plate", PLATE)):
        open(name + ".inp", "w").write(text)
        subprocess.run([tools + "/hilo-import", "--quiet", name + ".inp", "--units", "m-kg-s", "--thicken", "-o", name + ".h5"], check=True)
    subprocess.run([tools + "/hilo-tag", "--quiet", "cube.h5", "--linear", "cube", "-o", "linear.h5"], check=True)
    failed = False
    print(f"{'kind':30}" + "".join(f"{method:>20}" for method in o.methods.split(",")))
    for name, mesh, text, end, steps in [(n, "", machine(t), 0.6, 12) for n, t in bodies()] + [(n, m, t, 0.4, 20) for n, m, t in parts()]:
        if o.only and not any(word in name for word in o.only):
            continue
        open("scene.toml", "w").write(text)
        row = f"{name:30}"
        for method in o.methods.split(","):
            ends = []
            for n in (steps, 2 * steps, 4 * steps, 8 * steps):
                sets = (f"time.step={end / n!r}", f'time.integrator="{method}"', "solver.tolerance=1e-12", 'time.error_estimate="never"')
                ran = subprocess.run([tools + "/hilo-solve", "--quiet", "scene.toml", *([mesh] if mesh else []), "-o", "run.h5"] +
                                     [word for key in sets for word in ("--set", key)], capture_output=True)
                if ran.returncode:
                    break
                with h5py.File("run.h5") as f:
                    ends.append(f["history/probe/tip"][-1, :3])
            if len(ends) < 4:
                row += f"{'refused' if ran.returncode == 2 else 'exit ' + str(ran.returncode):>20}"
                continue
            apart = [numpy.linalg.norm(a - b) for a, b in zip(ends, ends[1:])]
            orders = [math.log2(max(a, 1e-16) / max(b, 1e-16)) for a, b in zip(apart, apart[1:])]
            wanted = ORDER.get(method, 2)
            low = max(orders) < wanted - 0.8 and apart[-1] > 1e-11
            failed = failed or low
            row += f"{apart[-1]:10.0e} {orders[0]:4.1f}{orders[1]:4.1f}" + ("!" if low else " ")
        print(row, flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
