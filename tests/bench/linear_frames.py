#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random frames and chains of beams that move little, linear and nonlinear: at rest, in modes and in time they answer alike.
Usage: linear_frames.py BIN FIRST-LAST   prints of each seed and analysis the largest difference, over the largest value of its kind."""
import os
import random
import subprocess
import sys
import tempfile

import h5py
import numpy as np

BIN = os.path.abspath(sys.argv[1])
FIRST, LAST = (int(x) for x in sys.argv[2].split("-"))


def entry(table, **keys):
    def text(v):
        return f'"{v}"' if isinstance(v, str) and not v.startswith("{") else str(v).lower() if isinstance(v, bool) else str(v)

    return f"[{table}]\n" + "".join(f"{k} = {text(v)}\n" for k, v in keys.items())


def scene(seed, linear, analysis):
    """A tree of points with a few loops; some beams stay nonlinear, some are arcs; knots with and without mass; joints between beams."""
    r = random.Random(seed)
    u = r.uniform
    points = [[0, 0, 0]]
    while len(points) < 3 + seed % 4:
        p = [u(-1, 1), u(-1, 1), u(0, 1.5)]
        if min(sum((a - b) ** 2 for a, b in zip(p, q)) for q in points) > 0.15:
            points.append(p)
    n = len(points)
    edges = [(i, r.randrange(i)) for i in range(1, n)]
    for _ in range(r.randint(0, 2)):
        i, j = r.sample(range(n), 2)
        if (i, j) not in edges and (j, i) not in edges:
            edges.append((i, j))
    pulse = {"history": '{t = [0, 0.01, 0.02], value = [0, 1, 0], interpolation = "smooth"}'} if analysis == "time" else {}
    out = entry("section.s", kind="tube", diameter=u(0.02, 0.05), thickness=0.002)
    out += entry("section.b", kind="box", width=u(0.02, 0.04), height=u(0.03, 0.06), thickness=0.002)
    out += entry("material.m", E=2e11, nu=0.3, density=7800)
    foot = r.choice(["fixed", "revolute", "spherical", "bushing"])
    for i, p in enumerate(points):
        mass = r.choice([0, 0, 2]) if i else 1
        out += entry("[body]", name=f"k{i}", mass=mass, com=p, inertia=[0.01 * mass] * 3)
    if foot != "bushing":
        out += entry("[joint]", kind=foot, name="foot", a="ground", b="k0", at=[0, 0, 0], **({"axis": [0, 1, 0]} if foot == "revolute" else {}))
    out += entry("[spring]", kind="bushing", name="hold", a="ground", b="k0", at=[0, 0, 0], stiffness=[1e5] * 3, angular_stiffness=[1e3] * 3)
    for e, (i, j) in enumerate(edges):
        keys = {"section": r.choice("sb"), "material": "m", "b": f"k{j}"}
        how = r.choice(["ride", "ride", "revolute", "spherical"])
        if how == "ride":
            keys["a"] = f"k{i}"
        if r.random() < 0.8 and linear:
            keys |= {"fidelity": "linear", "modes": 400, "up_to": 1e8}
        if seed % 2:
            keys["damping"] = 1e-4
        line, cells = [points[i], points[j]], r.randint(2, 4)
        if r.random() < 0.3:
            line.insert(1, [(x + y) / 2 + u(-0.1, 0.1) for x, y in zip(points[i], points[j])])
            keys["path"], cells = "arc", 2 * cells
        out += entry(f"beam.b{e}", points=line, cells=[cells], **keys)
        if how != "ride":
            axis = {"axis": [u(-1, 1) for _ in range(3)]} if how == "revolute" else {}
            out += entry("[joint]", kind=how, name=f"j{e}", a=f"k{i}", b=f"b{e}.0", at=points[i], **axis)
            out += entry("[spring]", kind="bushing", name=f"h{e}", a=f"k{i}", b=f"b{e}.0", at=points[i], stiffness=[1e4] * 3,
                         angular_stiffness=[5e2] * 3)
        if r.random() < 0.4:
            out += entry("[point_mass]", name=f"w{e}", on=f"b{e}.1", mass=u(0.1, 2))
        if r.random() < 0.6:
            out += entry("[probe]", name=f"p{e}", on=f"b{e}.{r.randint(1, cells - 1)}")
        if analysis != "modes" and r.random() < 0.3:
            out += entry("[load]", kind="line", name=f"l{e}", on=f"b{e}", force_per_length=[u(-0.01, 0.01) for _ in range(3)],
                         follower=r.random() < 0.5, **pulse)
    e = r.randrange(len(edges))
    out += entry("[load]", kind="force", name="f", on=f"b{e}.1", force=[u(-0.01, 0.01) for _ in range(3)], **pulse)
    out += entry("[load]", kind="torque", name="t", on=f"b{e}.1", torque=[u(-0.01, 0.01) for _ in range(3)], follower=r.random() < 0.5, **pulse)
    out += entry("[probe]", name="tip", on=f"b{e}.1")
    if analysis == "time":
        return out + "[time]\nend = 0.05\nstep = 5e-4\n[solver]\ntolerance = 1e-9\n"
    return out + f'[time]\nanalysis = "{analysis}"\n' + ("modes = 10\n" if analysis == "modes" else "steps = 1\n[solver]\ntolerance = 1e-10\n")


def histories(text):
    """Of a static run the end alone: it may have taken smaller steps."""
    with open("scene.toml", "w") as file:
        file.write(text)
    done = subprocess.run([os.path.join(BIN, "hilo-solve"), "--quiet", "scene.toml", "-o", "run.h5"], capture_output=True, text=True, timeout=100)
    if done.returncode != 0:
        raise RuntimeError(done.stderr)
    out = {}
    with h5py.File("run.h5") as file:
        rows = [0, -1] if '"static"' in text else slice(None)
        file["history"].visititems(lambda name, item: out.update({name: item[:][rows]}) if isinstance(item, h5py.Dataset) else None)
    return out


def difference(mine, its, analysis):
    if analysis == "modes":
        a, b = mine["mode"][-10:, 0], its["mode"][-10:, 0]
        return float((np.abs(a - b) / np.maximum(b, 1e-3 * b[-1]))[:6].max()), "frequency"
    worst = 0.0, ""
    for kinds in (("probe",), ("beam", "spring", "joint")):  # ways and their rates, and forces
        names = [n for n in its if n.split("/")[0] in kinds]
        moved = {n: its[n] - (its[n][0] if "probe" in kinds else 0) for n in names}
        largest = max((np.abs(v).max() for v in moved.values()), default=0)
        for name in names:
            worst = max(worst, (float(np.abs(mine[name] - its[name]).max() / max(largest, 1e-300)), name))
    return worst


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    most = 0.0
    for seed in range(FIRST, LAST + 1):
        for analysis in ("static", "modes", "time"):
            off, where = difference(histories(scene(seed, True, analysis)), histories(scene(seed, False, analysis)), analysis)
            print(f"{seed:6} {analysis:7} {off:8.1e} {where}", flush=True)
            most = max(most, off)
    print(f"largest {most:.1e}")
