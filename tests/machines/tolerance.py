#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""time.tolerance on random machines: the true error at the end over what was asked.  Truth: gauss in 3000 and radau in 6000 steps, where they
agree to a fiftieth of what is asked.  A row for each run, and OUT.csv and OUT.png where OUT is given.
Usage: tolerance.py BIN [--tolerances 1e-3,1e-4] [--out OUT] FAMILY:SEED | FAMILY:FIRST-LAST ..."""
import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
import time

import h5py
import numpy

END = 100  # sensible steps


def solve(tools, scene, out, *more):
    """run.json of a run, {} where there is none."""
    sets = [word for key in more for word in ("--set", key)]
    try:
        subprocess.run([os.path.join(tools, "hilo-solve"), "--quiet", scene, "-o", out, *sets], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=300)
    except subprocess.TimeoutExpired:
        return {}
    try:
        with open(out.replace(".h5", ".json")) as f:
            said = json.load(f)
    except OSError:
        return {}
    return said if said["complete"] else {}


def ends(out):
    """Four points of each body at the end, as far from its centre as its radii of inertia."""
    with h5py.File(out) as f:
        return numpy.vstack([numpy.array(rows[-1]).reshape(-1)[-12:].reshape(4, 3) for _, rows in sorted(f["history/body"].items())])


def apart(a, b):
    return float(numpy.linalg.norm(a - b, axis=1).max())


def judged(tools, family, seed, tolerances):
    """(label, tolerance, true and told over asked, word, steps) of every run of a machine."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([os.path.join(tools, "machines"), "--family", family, "--from", str(seed), "--to", str(seed), "--steps", str(END), "--write", folder],
                       check=True, stdout=subprocess.DEVNULL)
        scene = os.path.join(folder, f"{family}-{seed}-x1", "machine.toml")
        out = os.path.join(folder, "run.h5")
        end = [float(line.split("=")[1]) for line in open(scene) if line.startswith("end")][0]
        truth = []
        for method, n in (("gauss", 3000), ("radau", 6000)):
            if solve(tools, scene, out, f'time.integrator="{method}"', f"time.step={end / n!r}", 'time.error_estimate="never"'):
                truth.append(ends(out))
        known = apart(*truth) if len(truth) == 2 else math.inf
        for tolerance in tolerances:
            began = time.time()
            said = solve(tools, scene, out, f"time.tolerance={tolerance:g}", f"time.step={end / 4!r}")
            took = time.time() - began
            if not said:
                yield f"{family}-{seed}", tolerance, math.nan, math.nan, "stopped", 0, known, took
                continue
            e = said["error_estimate"]
            asked = e["asked"]
            if "end" not in e:
                word, told = "not known: " + e["why_not"], math.nan
            else:
                word, told = ("chaotic" if e["chaotic"] else "" if e["met"] else "not met"), e["end"] / asked
            if known > asked / 50:
                yield f"{family}-{seed}", tolerance, math.nan, told, word or "truth not known", said["steps"], known / asked, took
                continue
            true = apart(ends(out), truth[0]) / asked
            yield f"{family}-{seed}", tolerance, true, told, word, said["steps"], e.get("largest", math.nan) / asked, took, " ".join(f"{p['integrator']} {p['steps']} {p['end']/asked:.2g}" for p in e["passes"])


def main():
    p = argparse.ArgumentParser()
    p.add_argument("bin"), p.add_argument("machines", nargs="+")
    p.add_argument("--tolerances", default="1e-3,1e-4")
    p.add_argument("--out")
    a = p.parse_args()
    for word in a.machines:
        family, _, seeds = word.partition(":")
        first, _, last = seeds.partition("-")
        for seed in range(int(first), int(last or first) + 1):
            for row in judged(os.path.abspath(a.bin), family, seed, [float(x) for x in a.tolerances.split(",")]):
                print(" | ".join(f"{x:.3g}" if isinstance(x, float) else str(x) for x in row), flush=True)


if __name__ == "__main__":
    main()
