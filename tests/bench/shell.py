#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A clamped square plate of shells under its weight, one static step: each linear solver against the number of cells, and the deflection
against thin plates, 0.00126532 q a^4 / D [timoshenko-woinowsky-krieger-1959].

  shell.py BIN [--cells 100,408] [--slenderness 100] [--kinds auto,bddc:64,bddc:2x16] [--limit SECONDS]

A kind may state subdomains, or ranks x subdomains of each.  408 cells a side have 993 894 unknowns.  Seconds are of processors, all ranks."""
import argparse
import json
import os
import subprocess
import sys
import tempfile

SURFACE = """Point(1) = {{0, 0, 0}}; Point(2) = {{1, 0, 0}}; Point(3) = {{1, 1, 0}}; Point(4) = {{0, 1, 0}};
Line(1) = {{1, 2}}; Line(2) = {{2, 3}}; Line(3) = {{3, 4}}; Line(4) = {{4, 1}};
Curve Loop(1) = {{1, 2, 3, 4}}; Plane Surface(1) = {{1}};
Transfinite Curve{{1:4}} = {points}; Transfinite Surface{{1}}; Recombine Surface{{1}};
Physical Surface("plate") = {{1}}; Physical Curve("edge") = {{1:4}};
"""
SCENE = """gravity = [0, 0, {gravity}]

[material.steel]
E = 2.1e11
nu = 0.3
density = 7850

[region.plate]
material = "steel"

[[motion]]
kind = "fixed"
name = "wall"
on = "edge"

[time]
analysis = "static"
"""


def measure(tools, folder, kind, limit):
    name, _, parts = kind.partition(":")
    ranks, _, subdomains = parts.rpartition("x")
    tool = [f"{tools}/hilo-solve"]
    if ranks:
        subprocess.run([f"{tools}/hilo-part", "plate.h5", "plate.toml", "-n", ranks, "-o", "parts.h5"], cwd=folder, check=True, capture_output=True)
        tool = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", ranks] + tool
    command = tool + ["plate.toml", "parts.h5" if ranks else "plate.h5", "-o", "run.h5", "--quiet", "--set", f'solver.kind="{name}"']
    if subdomains:
        command += ["--set", f"solver.subdomains={subdomains}"]
    try:
        subprocess.run(command, cwd=folder, check=True, timeout=limit, capture_output=True, text=True)
    except subprocess.TimeoutExpired:
        return f"more than {limit:g} s"
    except subprocess.CalledProcessError as error:
        return error.stderr.strip().splitlines()[-1][:100]
    told = json.load(open(f"{folder}/run.json"))
    table = subprocess.run([f"{tools}/hilo-post", "peak", "run.h5", "--field", "displacement", "--unit", "m"], cwd=folder, check=True,
                           capture_output=True, text=True).stdout
    return told, float(table.splitlines()[-1].split()[1])


def main():
    options = argparse.ArgumentParser(usage=__doc__)
    options.add_argument("bin")
    options.add_argument("--cells", default="100,408")
    options.add_argument("--slenderness", type=float, default=100)
    options.add_argument("--kinds", default="auto,bddc:64,bddc:2x16")
    options.add_argument("--limit", type=float, default=600)
    o = options.parse_args()
    tools, h = os.path.abspath(o.bin), 1 / o.slenderness
    gravity = -9.81 * (100 * h) ** 3  # deflects by the same share of the thickness, half a percent
    thin = 0.00126532 * 7850 * gravity * h / (2.1e11 * h**3 / 12 / (1 - 0.3**2))
    print(f"{'cells':>8} {'kind':10} {'solver':24} {'Newton':>6} {'iterations':>10} {'set-up':>7} {'solve':>7} {'all':>7} {'MB':>6} {'over thin':>9}")
    wrong = 0
    for n in map(int, o.cells.split(",")):
        with tempfile.TemporaryDirectory() as folder:
            open(f"{folder}/plate.geo", "w").write(SURFACE.format(points=n + 1))
            open(f"{folder}/plate.toml", "w").write(SCENE.format(gravity=gravity))
            subprocess.run([f"{tools}/hilo-import", "plate.geo", "--thickness", repr(h), "-o", "plate.h5"], cwd=folder, check=True, capture_output=True)
            for kind in o.kinds.split(","):
                found = measure(tools, folder, kind, o.limit)
                if isinstance(found, str):
                    print(f"{n * n:8} {kind:10} {found}")
                    wrong += 1
                    continue
                told, w = found
                parts = told["profile"]
                print(f"{n * n:8} {kind:10} {told['solver']:24} {told['newton_iterations']:6} {told['counts']['linear_iterations']:10} "
                      f"{parts['set-up']['seconds']:7.1f} {parts['solve']['seconds']:7.1f} {told['processor_seconds']:7.1f} "
                      f"{told['peak_memory_bytes'] / 1e6:6.0f} {-w / thin:9.4f}", flush=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
