#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""One answer at three fidelities: random machines of stiff blocks with damped materials, bushings, compliant joints, dampers and motors.
All blocks rigid, all linear and all nonlinear move alike, within 1e-3 of how far they move; where they do not, what is left falls to 1/30
when the material is a hundred times as stiff.
Usage: three_levels.py BIN SEED [SEED | FIRST-LAST ...]"""
import json
import os
import random
import subprocess
import sys
import tempfile

import h5py
import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "bench"))
from advice import Deck, course, table  # noqa: E402

LEVELS = ("rigid", "linear", "nonlinear")


def drawn(seed):
    """Deck and scene of a machine; what it is made of."""
    r = random.Random(seed)
    deck, n, kinds = Deck(), r.choice([1, 2, 2, 3, 4]), []
    text = "gravity = [0, %g, -9.81]\n[time]\nend = 0.4\nstep = 2e-3\n[output]\nfields = [\"displacement\"]\n" % r.choice([0, 3])

    def number(low, high):
        return float(f"{10 ** r.uniform(low, high):.4g}")

    def three(low, high):
        return [number(low, high) for _ in range(3)]

    at = [0.0, 0.0, 0.0]
    for k in range(n):
        name, side = "abcd"[k], r.uniform(0.08, 0.15)
        along = [r.uniform(-1, 1) for _ in range(3)]
        size = sum(c * c for c in along) ** 0.5
        end = [p + c / size * r.uniform(0.4, 0.8) for p, c in zip(at, along)]
        deck.beam(name, at, end, side, 2e13, 2, across=(0, 1, 0) if abs(along[1]) < 0.8 * size else (1, 0, 0))
        damped = {}
        if r.random() < 0.6:
            damped["mass_damping"] = number(-0.5, 1)
        if r.random() < 0.5:
            damped["damping"] = number(-6, -4)
        kinds += damped
        text += f"[region.{name}]\n" + "".join(f"{key} = {value}\n" for key, value in damped.items())
        a, b, joint = "ground" if k == 0 else "abcd"[k - 1] + "1", name + "0", f"j{k}"
        kind = r.choice(["bushing", "fixed", "revolute", "revolute", "spherical"])
        axis = [round(r.uniform(-1, 1), 3) for _ in range(3)]
        if kind == "bushing":
            text += table("spring", joint, kind=kind, a=a, b=b, at=at, axis=axis, stiffness=three(4, 6), damping=three(1, 3),
                          angular_stiffness=three(2, 4), angular_damping=three(-0.5, 1))
        else:
            more = {} if kind in ("spherical", "fixed") else {"axis": axis}
            gives_way = kind == "fixed" or r.random() < 0.4
            if gives_way:
                more |= dict(stiffness=three(4, 6), damping=three(1, 3))
                if kind != "spherical":
                    more |= dict(angular_stiffness=three(2, 4), angular_damping=three(-0.5, 1))
            text += table("joint", joint, kind=kind, a=a, b=b, at=at, **more)
            kind += " that gives way" if gives_way else ""
            if kind == "revolute" and r.random() < 0.6:
                text += table("motor", f"m{k}", kind="rotary", joint=joint, rate=[0, 20], torque=[number(0.5, 1.7), 0])
                kinds.append("motor")
        kinds.append(kind)
        text += table("probe", name, on=name + "1")
        if r.random() < 0.3:
            text += table("spring", f"d{k}", kind="axial", b=name + "1", at_a=[0.3, 1.2, 0.4], at_b=end, stiffness=number(2, 4), damping=number(1, 3))
            kinds.append("damper")
        if r.random() < 0.3:
            text += table("load", f"f{k}", kind="force", on=name + "1", force=[r.uniform(-50, 50) for _ in range(3)],
                          history=course([0, 0.05, 0.1], [0, 1, 0]))
        at = end
    return deck, text, sorted(set(kinds))


def call(tools, tool, *more):
    return subprocess.run([os.path.join(tools, tool), "--quiet", *more], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300)


def ways(tools, level, stiffer=1):
    """Positions of all probes over time, or why there are none."""
    if stiffer != 1:
        text = open("deck.inp").read().replace("*ELASTIC\n2e+13", f"*ELASTIC\n{2e13 * stiffer:g}")
        open("stiff.inp", "w").write(text)
        call(tools, "hilo-import", "stiff.inp", "-o", "stiff.h5")
    mesh = "mesh.h5" if stiffer == 1 else "stiff.h5"
    done = call(tools, "hilo-tag", mesh, "--rest", level, "-o", "tags.h5")
    if done.returncode == 0:
        done = call(tools, "hilo-solve", "scene.toml", "tags.h5", "-o", "run.h5")
    if done.returncode:
        return None, f"{level}: exit {done.returncode}: {done.stdout.strip().splitlines()[-1][:160]}"
    if not json.load(open("run.json"))["audit"]["passed"]:
        return None, f"{level}: its audit failed"
    with h5py.File("run.h5") as f:
        return numpy.hstack([f["history/probe"][p][:, :3] for p in sorted(f["history/probe"])]), ""


def judged(tools, seed):
    """Whether the machine has one answer; prints a row where it has not."""
    deck, text, kinds = drawn(seed)
    open("deck.inp", "w").write(deck.text())
    open("scene.toml", "w").write(text)
    done = call(tools, "hilo-import", "deck.inp", "-o", "mesh.h5")
    assert done.returncode == 0, done.stdout
    off = {}
    for stiffer in (1, 100):
        at = {}
        for level in LEVELS:
            at[level], why = ways(tools, level, stiffer)
            if why:
                print(f"{seed}: {why}  ({', '.join(kinds)})  WRONG", flush=True)
                return False
        size = max(numpy.abs(at["rigid"] - at["rigid"][0]).max(), 1e-4)
        off[stiffer] = [numpy.abs(at[level] - at["rigid"]).max() / size for level in LEVELS[1:]]
        if max(off[1]) < 1e-3:
            return True
    falls = max(off[100]) < max(off[1]) / 30
    print(f"{seed}: from rigid: linear {off[1][0]:.1e}, nonlinear {off[1][1]:.1e}; a hundred times as stiff {off[100][0]:.1e}, {off[100][1]:.1e}"
          f"  ({', '.join(kinds)}){'' if falls else '  WRONG'}", flush=True)
    return falls


def main():
    tools, wrong, seen = os.path.abspath(sys.argv[1]), 0, 0
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for word in sys.argv[2:]:
            first, _, last = word.partition("-")
            for seed in range(int(first), int(last or first) + 1):
                wrong, seen = wrong + (not judged(tools, seed)), seen + 1
    print(f"{seen} machines at three fidelities, {wrong} wrong")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
