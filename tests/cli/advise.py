#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""hilo-advise on three bars: what it chooses is within its tolerance of the run with all cells at half the step, it keeps rigid what may be
and refuses what it cannot say.  Usage: advise.py BIN"""
import os
import signal
import subprocess
import sys
import tempfile
import time

import advised
from advised import BIN, hinge, imported, levels, peak, told, values, write

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "bench"))
from advice import PUBLISHED, Deck  # noqa: E402


def deck(n=4):
    """Bars a, b, c of 1 m along x, one behind the other, n hexahedra of 20 nodes each, with the sets of their ends: a0, a1, ..."""
    bars = Deck()
    for k, name in enumerate("abc"):
        bars.beam(name, (k, 0, 0), (k + 1, 0, 0), 0.05, 2e11, n)
    return bars.text()


def scene(more=""):
    """The first joint turns by 1 rad within .4 s."""
    text = "gravity = [0, 0, -9.81]\n"
    for k, (a, b) in enumerate((("ground", "a0"), ("a1", "b0"), ("b1", "c0"))):
        text += hinge(f"j{k}", a, b, [k, 0, 0])
        text += 'angle = 1\nhistory = {t = [0, 0.2, 0.4], value = [0, 0.5, 1], interpolation = "smoother"}\n' if k == 0 else ""
        text += peak(f"R{k}", f"j{k}")
    return text + '[time]\nend = 0.4\nstep = 1e-3\n[region."*"]\ndamping = 1.2e-5\n' + more


def tagged(*rules, mesh="mesh.h5"):
    advised.done("hilo-tag", mesh, *rules, "-o", "tags.h5")
    return "tags.h5"


def refused(what, *options):
    advised.refused((1, 2), [what], "mesh.h5", *options)


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    imported(deck())
    write(scene())

    # modes of a folder are those found: the same values, and nothing in it is written again
    os.mkdir("modes")
    alone = values(tagged("--rest", "linear"))
    for kept in (0, 3, 3):
        assert len(os.listdir("modes")) == kept
        before = {f: os.stat("modes/" + f).st_mtime_ns for f in os.listdir("modes")}
        assert values("tags.h5", "--modes", "modes") == alone
        assert all(os.stat("modes/" + f).st_mtime_ns == t for f, t in before.items())

    advice = told("mesh.h5", "--tol", "2%", "--apply", "choice.toml")
    level = levels(advice)
    assert level == {"a": "linear", "b": "rigid", "c": "rigid"}, level
    errors = {m["model"]: m["error over allowed"] for m in advice["models"]}
    assert errors["all rigid"] > 1 and errors["linear a"] < 1 and len(errors) < 8, errors
    assert all(q["modes"] != 0 for q in advice["quantities"]), advice["quantities"]  # there were more modes to find
    assert advice["checked"] and "nonlinear a; linear b, c" in " ".join(errors), errors  # it bends enough for doubt of linear strains

    assert "nonlinear a; linear b, c, by twice the step" in " ".join(errors), errors  # what cells change is known at half the price
    whole = {q["quantity"]: q for q in told("mesh.h5", "--tol", "2%", "--full", "--work", "full.work")["quantities"]}
    for q in advice["quantities"]:
        print(f"{q['quantity']}: cells change {-q['linear strains']:.4g} at twice the step, {-whole[q['quantity']]['linear strains']:.4g} at the step")
        assert abs(q["linear strains"] - whole[q["quantity"]]["linear strains"]) < 0.02 * q["allowed"], (q, whole)

    truth = values(tagged("--rest", "nonlinear"), "--set", "time.step=5e-4")
    chosen, rigid = values(tagged("choice.toml")), values(tagged("--rest", "rigid"))
    off = {q: abs(chosen[q] / truth[q] - 1) for q in truth}
    assert max(off.values()) < 0.02, off
    assert max(abs(rigid[q] / truth[q] - 1) for q in truth) > 0.1  # that there was something to choose
    print(f"chosen: bar a; off by {100 * max(off.values()):.2f} %, all rigid by {100 * max(abs(rigid[q] / truth[q] - 1) for q in truth):.0f} %")

    before = {f: os.stat("advise.work/" + f).st_mtime_ns for f in os.listdir("advise.work")}
    again = told("mesh.h5", "--tol", "2%")
    assert {**again, "spent_seconds": 0} == {**advice, "spent_seconds": 0}
    assert before == {f: os.stat("advise.work/" + f).st_mtime_ns for f in os.listdir("advise.work")}  # nothing ran again

    # kept runs that are damaged run again
    for f in before:
        if f.endswith(".json"):
            open("advise.work/" + f, "w").write('{"complete": true, "bend": 3, "processor_seconds": "x"}')
            open("advise.work/" + f.replace(".json", ".h5"), "r+b").truncate(3000)
            break
    again = told("mesh.h5", "--tol", "2%")
    assert levels(again) == level and again["quantities"] == advice["quantities"], again
    before = {f: os.stat("advise.work/" + f).st_mtime_ns for f in os.listdir("advise.work")}

    # the error of the mesh, by cells half as long: as four times as many say
    a_bends = ("--keep", "a=linear", "--keep-rigid", "b", "--keep-rigid", "c")
    for n in (2, 4, 8):
        imported(deck(n), f"mesh-{n}.h5")
    advice = told("mesh-2.h5", "--tol", "2%", "--finer", "mesh-4.h5", "--work", "finer.work", *a_bends)
    got = {q["quantity"]: q for q in advice["quantities"]}
    fine = values(tagged("--rigid", "b", "c", "--rest", "linear", mesh="mesh-8.h5"))
    for name, q in got.items():
        r = 2 ** (2 / 3)  # cells half as long along one direction of three
        at_4 = q["value"] - q["mesh"] * (r - 1) / r
        print(f"{name}: {q['value']:.2f}, mesh {q['mesh']:.3g}; half as long {at_4:.2f}, a quarter {fine[name]:.2f}")
        assert abs(at_4 - fine[name]) < 0.5 * abs(q["value"] - fine[name]) and q["mesh"] * (q["value"] - fine[name]) > 0, (name, q, fine)
    refused("too near", "--finer", "mesh.h5")

    # the error of modes left out: what runs with one and with two modes differ by; at a wide tolerance the strain that they lack bounds it
    one, two = (values(tagged("--rigid", "b", "c", "--rest", "linear"), "--set", f"region.*.modes={n}") for n in (1, 2))
    for tolerance in (0.02, 0.002):
        advice = told("mesh.h5", "--tol", f"{100 * tolerance:g}%", "--no-full", "--set", "region.*.modes=1", "--work", "modes.work", *a_bends)
        at_most = advice["modes_at_most_over_allowed"]
        for q in advice["quantities"]:
            wanted = one[q["quantity"]] - two[q["quantity"]]
            print(f"{q['quantity']}: one mode, two: {one[q['quantity']]:.3f}, {two[q['quantity']]:.3f}, told {q['modes']}, at most {at_most}")
            assert 0 < abs(wanted) < at_most * tolerance * one[q["quantity"]], (q, at_most)
            if tolerance == 0.02:
                assert at_most < 0.1 and q["modes"] is None, (q, at_most)
            else:
                assert at_most > 0.1 and abs(q["modes"] - wanted) < 1e-4 * abs(wanted) + 1e-9 * one[q["quantity"]], (q, wanted)

    # a title and other quantities change no run
    write('title = "another"\n' + scene('[[quantity]]\nname = "r.m.s."\nkind = "rms"\njoint = "j0"\n'))
    advised.done("hilo-advise", "scene.toml", "mesh.h5", "--tol", "2%")
    assert before == {f: os.stat("advise.work/" + f).st_mtime_ns for f in before}

    # the bar that bends too far for linear strains: all cells check it, and what is chosen serves
    write(scene('[region.b]\nmaterial = "soft"\n[material.soft]\nE = 2e9\nnu = 0.3\ndensity = 7850\n'))
    advice = told("mesh.h5", "--tol", "2%", "-j", "2", "--apply", "choice.toml", "--csv", "models.csv")
    assert advice["checked"] and {r["region"]: r["reference"] for r in advice["regions"]}["b"] == "nonlinear", advice["regions"]
    truth = values(tagged("--rest", "nonlinear"), "--set", "time.step=5e-4")
    chosen, linear = values(tagged("choice.toml")), values(tagged("--rest", "linear"))
    off = [max(abs(v[q] / truth[q] - 1) for q in truth) for v in (chosen, linear)]
    print(f"bar b soft, checked by all cells: off by {100 * off[0]:.2f} %, all linear by {100 * off[1]:.1f} %")
    assert off[0] < 0.02, off
    assert open("models.csv").read().count("\n") >= len([m for m in advice["models"] if m["choice"] not in ("check",)]), advice["models"]

    # a pull of 20 ms that the soft bar keeps from the others: with that bar rigid the first peak is far too large, and that run ends early
    pulled = scene('[region.b]\nmaterial = "soft"\n[material.soft]\nE = 2e7\nnu = 0.3\ndensity = 7850\n[[load]]\nkind = "force"\nname = "pull"\n'
                   'on = "c1"\nforce = [1e4, 0, 0]\nhistory = {t = [0, 0.01, 0.02], value = [0, 1, 0], interpolation = "smooth"}\n')
    write(pulled.replace("-9.81", "0").replace("angle = 1", "angle = 0").replace("step = 1e-3", "step = 2e-4"))
    advice = told("mesh.h5", "--tol", "5%", "--keep", "a=nonlinear", "--keep-rigid", "c", "--no-full", "--regions", "regions.csv")
    off = [m for m in advice["models"] if isinstance(m["error over allowed"], (int, float)) and m["error over allowed"] > 1.2]
    early = [m for m in off if "ended at" in m["model"]] or off[:1]  # a fast machine has it done before it is looked at
    assert off and len(early) == 1 and early[0]["choice"] == "-", advice["models"]
    assert levels(advice)["b"] == "linear"
    assert open("regions.csv").read().splitlines()[1].startswith('b,'), open("regions.csv").read()
    print(f"b rigid: {early[0]['model']}, {early[0]['error over allowed']:.3g} times what is allowed")

    # a joint that names a region as a whole: that one stays rigid, and it is told; regions that are not to be tried
    write(scene().replace('b = "b0"', 'b = "b"'))
    advice = told("mesh.h5", "--tol", "2%", "--keep", "a=linear", "--keep-rigid", "c")
    assert levels(advice) == {"a": "linear", "b": "rigid", "c": "rigid"}, advice["regions"]
    assert {r["region"]: r["why"] for r in advice["regions"]}["b"] == "a joint, spring, load or mass takes it as one body", advice["regions"]
    write(scene())

    # where cells are needed and one bar of them is enough, all cells run at twice the step alone; what is chosen serves
    os.mkdir("struck")
    os.chdir("struck")
    PUBLISHED["c7"]("c7").write()
    advised.done("hilo-import", "deck.inp", "-o", "mesh.h5")
    advice = told("mesh.h5", "--tol", "2%")
    assert levels(advice) == {"a": "linear", "b": "linear", "c": "nonlinear"}, levels(advice)
    models = [m["model"] for m in advice["models"]]
    assert "nonlinear a, b, c, by twice the step" in models and "nonlinear a, b, c" not in models, models
    chosen = {q["quantity"]: q["value"] for q in advice["quantities"]}
    for name, v in values(tagged("--rest", "nonlinear"), "--set", "time.step=1.25e-4", "--set", 'time.error_estimate="never"').items():
        assert abs(chosen[name] / v - 1) < 0.02, (name, chosen[name], v)
    os.chdir("..")

    # a signal ends its solvers too
    advise = subprocess.Popen([os.path.join(BIN, "hilo-advise"), "--quiet", "scene.toml", "mesh.h5", "--set", "time.step=1e-6", "--work", "ended.work"],
                              stderr=subprocess.PIPE, text=True)
    solvers = []
    while not solvers and advise.poll() is None:
        time.sleep(0.02)
        solvers = [int(word) for word in open(f"/proc/{advise.pid}/task/{advise.pid}/children").read().split()]
    advise.send_signal(signal.SIGTERM)
    said = advise.communicate(timeout=60)[1]
    assert advise.returncode == 6 and "its runs have ended" in said, (advise.returncode, said)
    assert solvers and not any(os.path.exists(f"/proc/{solver}") for solver in solvers), solvers

    refused("the step alone makes", "--tol", "0.001%")
    write(scene('[[quantity]]\nname = "s"\nkind = "peak"\nstress = "a"\n[output]\ninterval = 10\n'))
    refused("output.interval = 0.008")
    write(scene())
    refused("no region", "--keep-rigid", "d")
    refused("says twice", "--keep", "a=linear", "--keep-rigid", "a")
    advised.refused([4], ["cannot make the folder"], "mesh.h5", "--work", "scene.toml")
    refused("no level", "--keep", "a=soft")
    refused("has no level", "--keep", "a")
    refused("contradicts", "--full", "--no-full")
    refused("no positive number", "--tol", "-1%")
    refused("has no unit", "--tol", "2")
    refused("only runs in time", "--set", 'time.analysis="static"')
    write(scene('[[quantity]]\nname = "s"\nkind = "peak"\nstress = "d"\n'))
    refused('no region "d"')
    write(scene().replace('name = "R1"\nkind = "peak"\njoint = "j1"', 'name = "R1"\nkind = "peak"\njoint = "jay"'))
    refused('no joint "jay"')
print("advise: well")
