#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run costs against the number of its bodies, for six families of scenes: processor seconds (user and system) before the first
step and of a step, memory of a body, and the slopes of log cost over log N, fitted to the larger half of the sizes.

  growth.py BIN [--sizes 100,1000] [--families chain,star] [--steps 10] [--set KEY=VALUE]... [--keep FOLDER] [--limit SECONDS]

  chain     bodies in a row from ground, revolutes across and balls by turns
  star      bodies on revolutes around one that floats
  four-bars a row of them: each crank on ground and on two couplers, all on parallel revolutes (three redundant rows a loop)
  grid      rods of a square net pinned to each other by parallel revolutes, hung on its corner (three redundant rows a mesh)
  flexible  bars of one hexahedron each, on revolutes in a row from ground
  frame     a ladder of beams clamped to ground, its bodies their sections: two stringers of eight cells and a rung of four in a bay

A step's cost is that of runs of 2 and of 2 + STEPS steps, start-up the rest of the first; the difference of two starts falls into neither."""
import argparse
import math
import os
import sys
import tempfile

from costs import cost, slope


def body(name, x, y, z=0.0, mass=1.0):
    return f'[[body]]\nname = "{name}"\nmass = {mass}\ncom = [{x!r}, {y!r}, {z!r}]\ninertia = [0.02, 0.03, 0.04]\n'


def joint(kind, name, a, b, x, y, axis=None):
    held = f'[[joint]]\nkind = "{kind}"\nname = "{name}"\na = "{a}"\nb = "{b}"\nat = [{x!r}, {y!r}, 0.0]\n'
    return held + (f"axis = {axis}\n" if axis else "")


def chain(n):
    for i in range(n):
        yield body(f"b{i}", i + 0.5, 0.0)
        yield joint("revolute" if i % 2 == 0 else "spherical", f"j{i}", "ground" if i == 0 else f"b{i - 1}", f"b{i}", float(i), 0.0,
                    "[0, 0, 1]" if i % 2 == 0 else None)


def star(n):
    yield body("hub", 0.0, 0.0, 0.0, float(n))
    for i in range(n - 1):
        c, s = math.cos(2 * math.pi * i / (n - 1)), math.sin(2 * math.pi * i / (n - 1))
        yield body(f"b{i}", 1.5 * c, 1.5 * s)
        yield joint("revolute", f"j{i}", "hub", f"b{i}", c, s, f"[{-s!r}, {c!r}, 0]")


def four_bars(n):
    z, m = "[0, 0, 1]", n // 2
    for i in range(m + 1):
        yield body(f"c{i}", float(i), 0.5)
        yield joint("revolute", f"A{i}", "ground", f"c{i}", float(i), 0.0, z)
    for i in range(1, m + 1):
        yield body(f"k{i}", i - 0.5, 1.0)
        yield joint("revolute", f"L{i}", f"c{i - 1}", f"k{i}", i - 1.0, 1.0, z)
        yield joint("revolute", f"R{i}", f"c{i}", f"k{i}", float(i), 1.0, z)


def grid(n):
    """Nodes (i, j), rods to the right and up; at each node a chain of revolutes through the rods that meet there."""
    z, m = "[0, 0, 1]", max(1, round(math.sqrt(n / 2)))
    meets = {}
    for i in range(m + 1):
        for j in range(m + 1):
            for name, di, dj in (("h", 1, 0), ("v", 0, 1)):
                if i + di > m or j + dj > m:
                    continue
                rod = f"{name}{i}_{j}"
                yield body(rod, i + di / 2, j + dj / 2)
                meets.setdefault((i, j), []).append(rod), meets.setdefault((i + di, j + dj), []).append(rod)
    for (i, j), rods in meets.items():
        rods = ["ground"] * ((i, j) == (0, m)) + rods
        for k in range(1, len(rods)):
            yield joint("revolute", f"p{i}_{j}_{k}", rods[k - 1], rods[k], float(i), float(j), z)


def flexible(n):
    yield '[material.rubber]\nE = 1e6\nnu = 0.3\ndensity = 1000\n'
    for i in range(n):
        yield f'[region.r{i}]\nmaterial = "rubber"\n'
        yield joint("revolute", f"j{i}", "ground" if i == 0 else f"right{i - 1}", f"left{i}", 1.0 * i, 0.0, "[0, 0, 1]")


def flexible_mesh(n, path):
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    with open(path, "w") as f:
        f.write("*MATERIAL, NAME=rubber\n*ELASTIC\n1e6, 0.3\n*DENSITY\n1000\n*NODE\n")
        for i in range(n):
            for k, x in enumerate((i, i + 1.0)):
                for m, (y, z) in enumerate(corners):
                    f.write(f"{8 * i + 4 * k + m + 1}, {x}, {0.1 * y}, {0.1 * z}\n")
        for i in range(n):
            f.write(f"*ELEMENT, TYPE=C3D8, ELSET=r{i}\n{i + 1}, " + ", ".join(str(8 * i + m + 1) for m in range(8)) + "\n")
            f.write(f"*SOLID SECTION, ELSET=r{i}, MATERIAL=rubber\n")
        for i in range(n):
            for k, name in enumerate(("left", "right")):
                f.write(f"*NSET, NSET={name}{i}\n" + ", ".join(str(8 * i + 4 * k + m + 1) for m in range(4)) + "\n")


def frame(n):
    yield '[material.steel]\nE = 2.1e11\nnu = 0.3\ndensity = 7850\n[section.pipe]\nkind = "tube"\ndiameter = 0.06\nthickness = 0.003\n'

    def beam(name, start, end, cells, a, b=None):
        held = f'[beam.{name}]\npoints = [{start}, {end}]\ncells = [{cells}]\nsection = "pipe"\nmaterial = "steel"\na = "{a}"\n'
        return held + (f'b = "{b}"\n' if b else "")
    for i in range(max(1, round(n / 19))):
        for name, y in (("l", 0.0), ("r", 1.0)):
            yield beam(f"{name}{i}", [float(i), y, 0.0], [i + 1.0, y, 0.0], 8, "ground" if i == 0 else f"{name}{i - 1}.end")
        yield beam(f"x{i}", [i + 1.0, 0.0, 0.0], [i + 1.0, 1.0, 0.0], 4, f"l{i}.end", f"r{i}.end")


FAMILIES = {"chain": chain, "star": star, "four-bars": four_bars, "grid": grid, "flexible": flexible, "frame": frame}
MOST = {"flexible": 55000}  # a million unknowns


def scene_of(family, n, steps=2):
    with open("scene.toml", "w") as f:
        if family == "flexible":
            f.write('mesh = "mesh.h5"\n')
        f.write("gravity = [0, -9.81, 0]\n[time]\nend = " + repr(steps * 0.001) + "\nstep = 0.001\n[output]\ninterval = 1e3\n")
        for part in FAMILIES[family](n):
            f.write(part)
        if family == "flexible":
            flexible_mesh(n, "mesh.inp")


def end_slope(points):
    """Of the larger half of the sizes."""
    points = [p for p in points if p[1] > 0]
    return slope(points[len(points) // 2 - (len(points) > 1):] if len(points) > 2 else points)


arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
arguments.add_argument("bin")
arguments.add_argument("--sizes", default="100,1000,10000,100000")
arguments.add_argument("--families", default=",".join(FAMILIES))
arguments.add_argument("--steps", type=int, default=10)
arguments.add_argument("--set", action="append", default=[])
arguments.add_argument("--keep", help="leave scene.toml, mesh and results of the last run here")
arguments.add_argument("--limit", type=int, default=600, help="processor seconds of a run")
o = arguments.parse_args()
binaries = os.path.abspath(o.bin)
folder = tempfile.TemporaryDirectory()
os.makedirs(o.keep or folder.name, exist_ok=True)
os.chdir(o.keep or folder.name)
solve = [f"{binaries}/hilo-solve", "--quiet", "scene.toml", "-o", "run.h5"] + [w for s in o.set for w in ("--set", s)]
print(f"{'family':10} {'N':>7} {'start-up s':>11} {'step s':>10} {'us/body,step':>12} {'kB/body':>8}")
for family in o.families.split(","):
    start, step = [], []
    for n in (min(int(size), MOST.get(family, 10**9)) for size in o.sizes.split(",")):
        scene_of(family, n)
        if family == "flexible" and not cost([f"{binaries}/hilo-import", "--quiet", "mesh.inp", "-o", "mesh.h5"], o.limit):
            sys.exit("hilo-import: " + open("words").read())
        steps = max(o.steps, 5000 // n)
        few = cost(solve, o.limit)
        scene_of(family, n, 2 + steps)
        more = few and cost(solve, o.limit)
        if not more:
            print(f"{family:10} {n:7} fails or takes more than {o.limit} s: {open('words').read().strip()[-200:]}", flush=True)
            break
        each = (more[0] - few[0]) / steps
        start.append((n, few[0] - 2 * each)), step.append((n, each))
        print(f"{family:10} {n:7} {start[-1][1]:11.3f} {each:10.5f} {1e6 * each / n:12.2f} {few[1] / 1000 / n:8.2f}", flush=True)
    print(f"{family:10}   slope {end_slope(start):11.2f} {end_slope(step):10.2f}", flush=True)
