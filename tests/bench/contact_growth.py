#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cost of a step against the number of what is in contact: processor seconds (user and system) of a step, its Newton iterations, and the
slope of log seconds over log N.

  contact_growth.py BIN [--balls 100,316,1000] [--facets 10000,30000,100000] [--steps 10] [--set KEY=VALUE]... [--limit SECONDS]

  balls   rigid balls in a square net on a plane, every one touching its neighbours and pushed about at random, `a = b = "all"`
  plates  two plates of one layer of hexahedra that hit each other face to face, one mesh shifted by .27 of a facet: N facets in all
  strip   such plates of 10 000 facets, both held at an end and in vibration, that hit each other along a twentieth of their faces, beside
          the same without [[contact]]

A step's cost is the difference of runs of 2 and of 2 + STEPS steps, divided by STEPS."""
import argparse
import json
import math
import os
import random
import sys
import tempfile

from costs import cost, slope

os.environ["OPENBLAS_NUM_THREADS"] = "1"


def balls(n, steps):
    random.seed(1)
    R, E, h, across = 0.01, 1e7, 1e-4, math.ceil(math.sqrt(n))
    m = 4 / 3 * math.pi * R**3 * 2500
    high = R - (m * 9.81 / (4 / 3 * E * math.sqrt(R)))**(2 / 3)  # pressed by its weight
    yield f"gravity = [0, 0, -9.81]\n[time]\nend = {steps * h!r}\nstep = {h}\n[output]\ninterval = 1e3\n"
    yield '[[obstacle]]\nkind = "plane"\nname = "ground"\n'
    yield f'[[contact]]\nname = "c"\na = "all"\nb = "all"\nmodulus = {E}\nfriction = 0.3\n'
    for i in range(n):
        at = [i % across * 2 * R * (1 - 1e-5), i // across * 2 * R * (1 - 1e-5), high]
        yield f'[[body]]\nname = "b{i}"\nmass = {m!r}\ncom = {at!r}\ninertia = {[0.4 * m * R * R] * 3!r}\n'
        yield f'[[obstacle]]\nkind = "sphere"\nname = "s{i}"\non = "b{i}"\nat = {at!r}\nradius = {R}\n'
        yield f'[[initial]]\non = ["b{i}"]\nvelocity = [{random.uniform(-0.05, 0.05)!r}, {random.uniform(-0.05, 0.05)!r}, 0]\n'


def plates(facets, kind):
    """Of n x n cells each; `strip`: the upper one is up by two facets but for a twentieth."""
    n = max(2, round(math.sqrt(facets / 4 + 1) - 1))
    a, m = 0.01, n + 1
    lines, cell = ["*NODE"], 1

    def node(s, i, j, k):
        return 1 + s * 2 * m * m + i + m * (j + m * k)
    for s in range(2):
        for k in range(2):
            for j in range(m):
                for i in range(m):
                    gap = 2 * a if kind != "plates" and i > 0.05 * n else 1e-5
                    lines.append(f"{node(s, i, j, k)}, {(i + 0.27 * s) * a:.9g}, {(j + 0.27 * s) * a:.9g}, {(gap if s else -a) + k * a:.9g}")
    corners = [(i, j, k) for k in (0, 1) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
    for s, name in ((0, "A"), (1, "B")):
        lines.append(f"*ELEMENT, TYPE=C3D8, ELSET={name}")
        for j in range(n):
            for i in range(n):
                lines.append(f"{cell}, " + ", ".join(str(node(s, i + p, j + q, k)) for p, q, k in corners))
                cell += 1
        lines += [f"*NSET, NSET={name}END"] + [f"{node(s, n, j, k)}," for j in range(m) for k in (0, 1)]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", "1e7, .3", "*DENSITY", "1000."]
    with open("mesh.inp", "w") as f:
        f.write("\n".join(lines + [f"*SOLID SECTION, ELSET={s}, MATERIAL=M" for s in "AB"] + [""]))
    return 4 * n * n + 8 * n


def plates_scene(steps, contact, vibrating=False):
    h = 2e-5
    yield f'mesh = "mesh.h5"\ngravity = [0, 0, -9.81]\n[time]\nend = {steps * h!r}\nstep = {h}\n[output]\ninterval = 1e3\n'
    yield '[material.M]\nE = 1e7\nnu = 0.3\ndensity = 1000\n[region."*"]\nmaterial = "M"\n'
    yield '[[motion]]\nkind = "fixed"\nname = "end"\non = "AEND"\n[[initial]]\non = ["B"]\nvelocity = [0, 0, -1]\n'
    if vibrating:
        yield '[[motion]]\nkind = "fixed"\nname = "other end"\non = "BEND"\n[[initial]]\non = ["A"]\nvelocity = [0, 0, 1]\n'
    if contact:
        yield '[[contact]]\nname = "c"\na = "A"\nb = "B"\nfriction = 0.3\n'


arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
arguments.add_argument("bin")
arguments.add_argument("--balls", default="100,316,1000")
arguments.add_argument("--facets", default="10000,30000,100000")
arguments.add_argument("--families", default="balls,plates,strip")
arguments.add_argument("--steps", type=int, default=10)
arguments.add_argument("--set", action="append", default=[])
arguments.add_argument("--limit", type=int, default=900, help="processor seconds of a run")
o = arguments.parse_args()
binaries = os.path.abspath(o.bin)
folder = tempfile.TemporaryDirectory()
os.chdir(folder.name)


def command(*words):
    """Processor seconds."""
    took = cost(words, o.limit)
    if not took:
        sys.exit(f"{' '.join(words)}: fails or takes more than {o.limit} s: {open('words').read().strip()[-300:]}")
    return took[0]


def step_of(scene):
    """Processor seconds of a step and Newton iterations of one."""
    cost, count = [], []
    for steps in (2, 2 + o.steps):
        with open("scene.toml", "w") as f:
            f.writelines(scene(steps))
        cost.append(command(f"{binaries}/hilo-solve", "--quiet", "scene.toml", "-o", "run.h5", *(w for s in o.set for w in ("--set", s))))
        count.append(json.load(open("run.json"))["newton_iterations"])
    return [(x[1] - x[0]) / o.steps for x in (cost, count)]


def tell(family, n, step, each):
    print(f"{family:10} {n:7} {step[0]:10.4f} {1e6 * step[0] / n:10.2f} {step[1]:10.1f}   {each}", flush=True)


print(f"{'family':10} {'N':>7} {'step s':>10} {'us/N,step':>10} {'iterations':>10}")
if "balls" in o.families:
    points = []
    for n in map(int, o.balls.split(",")):
        step = step_of(lambda steps: balls(n, steps))
        points.append((n, step[0]))
        tell("balls", n, step, "")
    print(f"{'balls':10} slope {slope(points):.2f}")
if "plates" in o.families:
    points = []
    for wished in map(int, o.facets.split(",")):
        n = plates(wished, "plates")
        command(f"{binaries}/hilo-import", "--quiet", "mesh.inp", "-o", "mesh.h5")
        step = step_of(lambda steps: plates_scene(steps, True))
        points.append((n, step[0]))
        tell("plates", n, step, "")
    print(f"{'plates':10} slope {slope(points):.2f}")
if "strip" in o.families:
    n = plates(int(o.facets.split(",")[0]), "strip")
    command(f"{binaries}/hilo-import", "--quiet", "mesh.inp", "-o", "mesh.h5")
    without, touching = (step_of(lambda steps: plates_scene(steps, contact, True)) for contact in (False, True))
    tell("alone", n, without, "")
    tell("strip", n, touching, f"{touching[0] / without[0]:.2f} times")
