#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fidelity is a word: every region of every scene of data/ with a mesh, size S, runs at each of the three levels, the rest as its own tags
say, through a few steps; and where all materials are a hundred times as stiff the levels agree within 1 %, or what is left falls to 3/100
where they are a hundred times stiffer still.

Every run ends with exit 0 and an audit that passed, or it is refused since an entry asks of a region what only a rigid one has.  From
`nonlinear`, `linear` is a tenth as far as `rigid` or 1e-4 of the displacements of all nodes at the end.

  levels.py REPO BIN [SCENE ...]"""
import json
import os
import subprocess
import sys
import tempfile
import tomllib

import h5py
import numpy

names = sys.argv[3:]
sys.argv[3:] = []
from any_ranks import SCENES, mesh_of, prepare, run, step_of  # noqa: E402

LEVELS = ("rigid", "linear", "nonlinear")
STIFFER = 100


def tagged(mesh, levels, out):
    """`mesh` with these levels by region."""
    options = []
    for level in LEVELS:
        regions = [r for r, of in levels.items() if of == level]
        options += [f"--{level}", *regions] if regions else []
    run("hilo-tag", "--quiet", mesh, *options, "-o", out)


def solved(name, tags, sets=()):
    """Displacements at the end, or why there are none."""
    scene, _, _, own = SCENES[name]
    end = next((s for s in own if s.startswith("time.end")), f"time.end={8 * step_of(scene):.12g}")
    if not own and not step_of(scene):
        end = "time.end=1"  # statics
    interval = "output.interval=" + end.split("=")[1]
    options = [word for s in (end, interval, 'output.fields=["displacement", "von_mises"]', *sets) for word in ("--set", s)]
    done = subprocess.run(["hilo-solve", "--quiet", *options, scene, tags, "-o", "levels.h5"], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, timeout=900)
    if done.returncode:
        return None, f"exit {done.returncode}: {done.stdout.splitlines()[-1][:200]}"
    if not json.load(open("levels.json"))["audit"]["passed"]:
        return None, "its audit failed"
    with h5py.File("levels.h5") as f:
        return f["field"][sorted(f["field"])[-1]]["displacement"][:], ""


def stiff(scene, factor=STIFFER):
    """What makes every material of a scene stiffer."""
    with open(scene, "rb") as f:
        materials = tomllib.load(f).get("material", {})
    return [f"material.{m}.E={factor * v['E']:.17g}" for m, v in materials.items() if isinstance(v.get("E"), (int, float))]


def apart(a, b):
    return numpy.linalg.norm(a - b, axis=1).max()


def size_of(at):
    """Largest displacement, at least 1e-5 of the scene: below that it has hardly begun to move."""
    return max(numpy.linalg.norm(at, axis=1).max(), 1e-5 * json.load(open("levels.json"))["length"])


def looked_at(name):
    """Prints a row for each region; how many are wrong."""
    base = mesh_of(name)
    with h5py.File(base) as f:
        mesh = name + "-mesh.h5"
        own = {r.decode(): w.decode() for r, w in zip(h5py.File(mesh)["mesh/regions/name"][:], f["tags/fidelity"][:])}
    wrong = 0
    for region in own:
        at, why = {}, {}
        for level in LEVELS:
            tagged(mesh, own | {region: level}, "levels-tags.h5")
            at[level], why[level] = solved(name, "levels-tags.h5")
        words = [f"{level}: {why[level]}" for level in LEVELS if why[level]]
        bad = any(w and not (level != "rigid" and w.startswith("exit 2: ") and f'"{region}" is flexible' in w) for level, w in why.items())
        if all(at[level] is not None for level in LEVELS):
            rigid, linear = (apart(at[level], at["nonlinear"]) for level in LEVELS[:2])
            size = size_of(at["nonlinear"])
            words.append(f"from nonlinear: rigid {rigid / size:.1e}, linear {linear / size:.1e} of the displacements")
            if linear > max(0.1 * rigid, 1e-4 * size):
                bad = True
        wrong += bad
        print(f"{name}: {region}: {'; '.join(words)}{'  WRONG' if bad else ''}", flush=True)
    sets = stiff(SCENES[name][0])
    if sets:
        at = {}
        for level in LEVELS:
            tagged(mesh, {r: own[r] if own[r] == "rigid" else level for r in own}, "levels-tags.h5")
            at[level], why = solved(name, "levels-tags.h5", sets)
            if at[level] is None:
                print(f"{name}: {STIFFER:g} times as stiff, {level}: {why}  WRONG", flush=True)
                return wrong + 1
        size = size_of(at["rigid"])
        off = [apart(at[level], at["rigid"]) / size for level in LEVELS[1:]]
        bad, beside = max(off) > 1e-2, ""
        if bad:  # a scene that bends more than it moves: what is left falls as the stiffness rises
            tagged(mesh, {r: own[r] if own[r] == "rigid" else "nonlinear" for r in own}, "levels-tags.h5")
            left = apart(solved(name, "levels-tags.h5", stiff(SCENES[name][0], STIFFER**2))[0], at["rigid"]) / size
            bad, beside = left > 3 * off[1] / STIFFER, f", at {STIFFER**2:g} times {left:.1e}"
        print(f"{name}: {STIFFER:g} times as stiff, from rigid: linear {off[0]:.1e}, nonlinear {off[1]:.1e}{beside}{'  WRONG' if bad else ''}", flush=True)
        wrong += bad
    return wrong


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        prepare()
        chosen = names or [n for n, s in SCENES.items() if s[1] and not n.endswith(("-rigid", "-flexible")) and ".inp" not in str(s[1]) or n == "scaling-turning"]
        wrong = sum([looked_at(n) for n in chosen])
        print(f"{wrong} wrong")
        sys.exit(1 if wrong else 0)
