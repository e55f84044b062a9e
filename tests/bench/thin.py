#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Thin parts by beams, shells and solids: error, unknowns and processor seconds of one small load step, the least of three runs.

  thin.py BIN [--slenderness 100]

A clamped square plate under gravity, against thin plates, 0.00126532 p a^4 / D [timoshenko-woinowsky-krieger-1959]; a cantilever under a
force at its end, against P L^3/(3 E I) + P L/(k G A).  hex20r and tet10 are one layer of cells."""
import argparse
import json
import os
import subprocess
import sys
import tempfile

E, NU, RHO = 2.1e11, 0.3, 7850
MATERIAL = f"[material.steel]\nE = {E}\nnu = {NU}\ndensity = {RHO}\n"
STEP = '[time]\nanalysis = "static"\nsteps = 1\n'


def mesh(tools, folder, cell, a, b, nx, ny, h):
    """A rectangle of cells as shells or drawn out to solids, with the edge x = 0 or all of it as the set `held`, the other end as `tip`."""
    text = (f"Point(1) = {{0, 0, 0}}; Point(2) = {{{a}, 0, 0}}; Point(3) = {{{a}, {b}, 0}}; Point(4) = {{0, {b}, 0}};\n"
            "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};\n"
            f"Transfinite Curve{{1, 3}} = {nx + 1}; Transfinite Curve{{2, 4}} = {ny + 1}; Transfinite Surface{{1}};\n")
    bricks = cell != "tet10"
    text += "Recombine Surface{1};\n" if bricks else ""
    if cell == "shell8":
        text += 'Physical Surface("part") = {1};\n'
        options = ["--thickness", repr(h)]
    else:
        text += f"v[] = Extrude {{0, 0, {h}}} {{ Surface{{1}}; Layers{{1}};{' Recombine;' if bricks else ''} }};\n"
        text += 'Physical Volume("part") = {v[1]};\n'
        options = ["--order", "2"]
    open(f"{folder}/part.geo", "w").write(text)
    subprocess.run([f"{tools}/hilo-import", "part.geo", "-o", "part.h5", *options], cwd=folder, check=True, capture_output=True)


def solve(tools, folder, scene, meshed=True):
    """Unknowns, seconds and the largest displacement of anything, across."""
    open(f"{folder}/scene.toml", "w").write(scene)
    least = 1e300
    for _ in range(3):
        subprocess.run([f"{tools}/hilo-solve", "scene.toml", *(["part.h5"] if meshed else []), "-o", "run.h5", "--quiet"], cwd=folder, check=True,
                       capture_output=True)
        told = json.load(open(f"{folder}/run.json"))
        least = min(least, told["processor_seconds"])
    series = subprocess.run([f"{tools}/hilo-post", "series", "run.h5", "probe.tip.z", "-o", "tip.csv"], cwd=folder, capture_output=True, text=True)
    if series.returncode:
        sys.exit(series.stderr)
    rows = [line.split(",") for line in open(f"{folder}/tip.csv") if line[:1] in "0123456789"]
    return told["unknowns"], least, abs(float(rows[-1][1]) - float(rows[0][1]))


def box(name, low, high):
    return f'[set.{name}]\nkind = "box"\nlow = {low}\nhigh = {high}\n'


def region(cell):
    return MATERIAL + '[region.part]\nmaterial = "steel"\n' + ("shell = true\n" if cell == "shell8" else "")


def plate(tools, folder, cell, n, h):
    gravity = 1e-3 * h * E * h**3 / 12 / (1 - NU**2) / (0.00126532 * RHO * h)  # a thousandth of the thickness
    mesh(tools, folder, cell, 1, 1, n, n, h)
    tiny = 1e-6
    sides = {"w": ([-tiny, -1, -1], [tiny, 2, 1]), "e": ([1 - tiny, -1, -1], [1 + tiny, 2, 1]),
             "s": ([tiny, -tiny, -1], [1 - tiny, tiny, 1]), "n": ([tiny, 1 - tiny, -1], [1 - tiny, 1 + tiny, 1])}
    scene = f"gravity = [0, 0, {-gravity!r}]\n" + region(cell)
    for name, (low, high) in sides.items():
        scene += box(name, low, high) + f'[[motion]]\nkind = "fixed"\nname = "{name}"\non = "{name}"\n'
    scene += box("middle", [0.5 - tiny, 0.5 - tiny, -1], [0.5 + tiny, 0.5 + tiny, 1]) + '[[probe]]\nname = "tip"\non = "middle"\n' + STEP
    unknowns, seconds, w = solve(tools, folder, scene)
    return unknowns, seconds, w / (1e-3 * h) - 1


def cantilever(tools, folder, cell, n, h):
    force = 1e-3 * h * 3 * E * h**4 / 12
    k = 10 * (1 + NU) / (12 + 11 * NU)
    want = force / (3 * E * h**4 / 12) + force / (k * E / 2 / (1 + NU) * h * h)
    load = f'[[load]]\nkind = "force"\nname = "end"\non = "{{}}"\nforce = [0, 0, {-force!r}]\n[[probe]]\nname = "tip"\non = "{{}}"\n'
    if cell == "beam":
        scene = (MATERIAL + f'[section.s]\nkind = "rectangle"\nwidth = {h}\nheight = {h}\n[beam.arm]\npoints = [[0, 0, 0], [1, 0, 0]]\n'
                 f'cells = [{n}]\nsection = "s"\nmaterial = "steel"\na = "ground"\n' + load.format("arm.end", "arm.end") + STEP)
        unknowns, seconds, w = solve(tools, folder, scene, False)
    else:
        mesh(tools, folder, cell, 1, h, n, 1, h)
        scene = region(cell) + box("root", [-1e-6, -1, -1], [1e-6, 1, 1]) + box("tip", [1 - 1e-6, -1, -1], [1 + 1e-6, 1, 1])
        scene += '[[motion]]\nkind = "fixed"\nname = "root"\non = "root"\n' + load.format("tip", "tip") + STEP
        unknowns, seconds, w = solve(tools, folder, scene)
    return unknowns, seconds, w / want - 1


def main():
    options = argparse.ArgumentParser(usage=__doc__)
    options.add_argument("bin")
    options.add_argument("--slenderness", type=float, default=100)
    o = options.parse_args()
    tools, h = os.path.abspath(o.bin), 1 / o.slenderness
    print(f"{'part':12} {'cell':8} {'cells':>7} {'unknowns':>9} {'error':>9} {'seconds':>8}")
    for name, what, rows in (("plate", plate, {"shell8": (8, 16, 32, 64), "hex20r": (8, 16, 32, 64), "tet10": (8, 16, 32)}),
                             ("cantilever", cantilever, {"beam": (1, 4, 16), "shell8": (8, 32, 100), "hex20r": (8, 32, 100), "tet10": (32, 100)})):
        for cell, sizes in rows.items():
            for n in sizes:
                with tempfile.TemporaryDirectory() as folder:
                    unknowns, seconds, error = what(tools, folder, cell, n, h)
                print(f"{name:12} {cell:8} {n if name != 'plate' else f'{n}x{n}':>7} {unknowns:9} {100 * error:+8.3f}% {seconds:8.3f}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
