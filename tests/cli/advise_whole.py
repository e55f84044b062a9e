#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""hilo-advise judges whole runs: peaks that come late with half the step or smaller cells count, and so does what the solver says of positions;
a finer mesh is the same part; all cells are chosen where they are the cheapest.  Usage: advise_whole.py BIN"""
import math
import os
import sys
import tempfile

import advised
from advised import imported, levels, refused, told, values, write

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "bench"))
from advice import Deck  # noqa: E402

SMOOTH = ', interpolation = "smooth"'


def bar(names="a", n=1, side=0.02, length=0.3):
    """Bars of one piece along x, with a set of nodes at each end."""
    deck = Deck(bonded=True)
    for k, name in enumerate(names):
        deck.beam(name, (k * length, 0, 0), ((k + 1) * length, 0, 0), side, 2e11, n)
    return deck.text()


def load(name, on, force, t, value, more=""):
    return f'[[load]]\nkind = "force"\nname = "{name}"\non = "{on}"\nforce = {force}\nhistory = {{t = {t}, value = {value}{more}}}\n'


def way(formula, tolerance, on="a1", at=""):
    return f'[[probe]]\nname = "tip"\non = "{on}"\n{at}[[quantity]]\nname = "way"\nkind = "peak"\nformula = "v [mm] = {formula}"\ntolerance = "{tolerance}"\n'


def fixed(on):
    return f'[[motion]]\nkind = "fixed"\nname = "root"\non = "{on}"\n'


def times(end, step):
    return f"[time]\nend = {end}\nstep = {step}\n"


BEAM = ('[material.steel]\nE = 2e11\nnu = 0.3\ndensity = 7850\n[section.s]\nkind = "rectangle"\nwidth = 0.02\nheight = 0.02\n'
        '[beam.a]\npoints = [[0, 0, 0], [0.3, 0, 0]]\ncells = [2]\nsection = "s"\nmaterial = "steel"\n' + fixed("a.0"))
UP = "1000*(probe.tip.z - start(probe.tip.z))"

with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)

    # a slow push, then a small force at the first frequency, which this step misses: with half of it a later peak is far larger
    write(BEAM + '[[quantity]]\nname = "f"\nkind = "frequency"\nmode = 1\n[time]\nanalysis = "modes"\n')
    f = values()["f"]
    t, value = [0, 0.05], [0, 0]
    for k in range(1, 12 * 25):
        t.append(round(0.05 + k / 12 / f, 9)), value.append(round(math.sin(math.pi * k / 6), 6))
    late = BEAM + load("push", "a.end", [0, 0, 1000], [0, 0.02, 0.04], [0, 1, 0], SMOOTH) + load("shake", "a.end", [0, 0, 24], t, value)
    write(late + times(0.18, 5e-4) + way(UP, "5%", "a.end"))
    refused([2], ["the step alone makes"], "--no-full")
    coarse, fine = (values("--set", f"time.step={h}")["way"] for h in (5e-4, 1e-4))
    print(f"late peak: {coarse:.3g} mm, with a fifth of the step {fine:.3g} mm")
    assert fine > 1.3 * coarse

    # a pull, then a bend that smaller cells let go further: the mesh is judged by the second one
    pulled = (fixed("a0") + load("pull", "a1", [1e5, 0, 0], [0, 0.01, 0.02], [0, 1, 0], SMOOTH)
              + load("bend", "a1", [0, 0, 400], [0, 0.02, 0.04], [0, 0, 1], SMOOTH) + '[region."*"]\nmass_damping = 300\n' + times(0.05, 2.5e-4)
              + way(f"2900*(probe.tip.x - start(probe.tip.x)) + {UP}", "5%"))
    for n in (1, 2):
        imported(bar(n=n), f"mesh-{n}.h5")
    write(pulled)
    advised.done("hilo-tag", "mesh-1.h5", "--rest", "linear", "-o", "tags-1.h5")
    advised.done("hilo-tag", "mesh-2.h5", "--rest", "linear", "-o", "tags-2.h5")
    coarse, fine = (values(f"tags-{n}.h5")["way"] for n in (1, 2))
    q = told("mesh-1.h5", "--finer", "mesh-2.h5", "--keep", "a=linear", "--no-full")["quantities"][0]
    r = 2 ** (2 / 3)  # cells half as long along one direction of three
    print(f"mesh: {coarse:.4g} mm, with cells half as long {fine:.4g} mm; told {-q['mesh']:.3g} mm, of {q['allowed']:.3g} mm")
    assert abs(q["value"] - coarse) < 1e-3 * coarse and abs(q["mesh"] * (r - 1) / r - (coarse - fine)) < 0.01 * coarse, (q, coarse, fine)
    assert abs(q["mesh"]) > q["allowed"], q

    # what is finer is the same part
    advised.done("hilo-import", "deck.inp", "--scale", "1000", "-o", "large.h5")
    refused([2], ["1e+03 times as large", "--units", "--scale"], "mesh-1.h5", "--finer", "large.h5")
    imported(bar(n=2, side=0.015), "thin.h5")
    refused([2], ["is not the same part", "volume"], "mesh-1.h5", "--finer", "thin.h5")

    # the peak of a bar that rings is right, while its positions lag by a twentieth of the motion
    write(BEAM + load("step", "a.end", [0, 0, 100], [0, 1], [1, 1]) + times(0.2, 2e-4) + way(UP, "5%", "a.end"))
    off = told("--no-full")["positions_off"]
    print(f"a bar that rings: positions off by {off:.3g} of the motion")
    assert off > 0.05 and "positions of it are off by" in advised.done("hilo-advise", "scene.toml", "--no-full"), off

    # beams of one cell: as modes they have more unknowns
    frame, at = "", [(0.1 * k, 0, 0) for k in range(4)] + [(0.3, 0.1 * k, 0) for k in range(1, 4)]
    for k, p in enumerate(at):
        frame += f'[[body]]\nname = "g{k}"\nmass = {0.1 if k == 6 else 0}\ncom = {list(p)}\n'
    for k in range(6):
        frame += f'[beam.b{k}]\npoints = [{list(at[k])}, {list(at[k + 1])}]\ncells = [1]\nsection = "s"\nmaterial = "steel"\na = "g{k}"\nb = "g{k + 1}"\n'
    write("gravity = [0, 0, -9.81]\n" + BEAM.split("[beam.a]")[0] + frame + fixed("g0") + times(0.02, 2e-4) + way(UP, "2%", "g6"))
    advice = told()
    chosen = next(m for m in advice["models"] if m["choice"] == "chosen")
    print(f"frame: {chosen['model']}, {chosen['unknowns']} unknowns, {chosen['s']} s; all cells {advice['all_cells_seconds']:.3g} s")
    assert set(levels(advice).values()) == {"nonlinear"} or chosen["s"] < advice["all_cells_seconds"], advice["models"]
    dearer = told("--no-full", *(w for k in range(6) for w in ("--keep", f"b{k}=linear")))
    assert set(levels(dearer).values()) == {"linear"}, dearer["regions"]  # what is kept stays

    # cells that ended once nothing reaches half of the peak any more run once to the end, when they are chosen
    imported(bar("ab"))
    write(fixed("a0") + load("pull", "b1", [1e3, 0, 0], [0, 0.002, 0.004, 0.02], [0, 1, 0, 0]) + '[region."*"]\nmass_damping = 3000\n'
          + times(0.02, 1e-4) + way("1000*(probe.tip.x - start(probe.tip.x))", "60%", "b1"))
    models = [m["model"] for m in told("mesh.h5", "--no-full", "--keep", "a=nonlinear")["models"]]
    assert "nonlinear a" in models and any(m.startswith("nonlinear a, to 0.00") for m in models), models

    # a stiffening region beside cells has so many modes at its interfaces that few vibrations are left
    imported(bar("ab", 3, length=0.1))
    write(fixed("a0") + load("bend", "b1", [0, 0, 100], [0, 0.001], [0, 1], SMOOTH) + times(0.001, 5e-5) + way(UP, "5%", "b1"))
    advice = told("mesh.h5", "--no-full", "--keep", "a=stiffening", "--keep", "b=nonlinear")
    assert levels(advice) == {"a": "stiffening", "b": "nonlinear"}, advice["regions"]
print("advise_whole: well")
