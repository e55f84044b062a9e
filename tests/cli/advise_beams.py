#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""hilo-advise on beams: what it chooses is within its tolerance of all beams nonlinear at half the step, and linear where that serves.
Usage: advise_beams.py BIN"""
import json
import os
import subprocess
import sys
import tempfile

BIN = os.path.abspath(sys.argv[1])


def scene(sizes, turn, names="abc"):
    """Bars of square section on hinges, one behind the other; the first hinge turns within .4 s."""
    text = 'gravity = [0, 0, -9.81]\n[material.steel]\nE = 2e11\nnu = 0.3\ndensity = 7800\n'
    for k, name in enumerate(names):
        text += f'[section.{name}]\nkind = "rectangle"\nwidth = {sizes[k]}\nheight = {sizes[k]}\n'
        text += f'[beam.{name}]\npoints = [[{k}, 0, 0], [{k + 1}, 0, 0]]\ncells = [4]\nsection = "{name}"\nmaterial = "steel"\n'
        text += 'damping = 1.2e-5\n'
        text += f'[[joint]]\nkind = "revolute"\nname = "j{k}"\na = "{"ground" if k == 0 else names[k - 1] + ".end"}"\nb = "{name}.0"\n'
        text += f'at = [{k}, 0, 0]\naxis = [0, 1, 0]\n'
        if k == 0:
            text += f'angle = {turn}\nhistory = {{t = [0, 0.2, 0.4], value = [0, 0.5, 1], interpolation = "smoother"}}\n'
        text += f'[[quantity]]\nname = "R{k}"\nkind = "peak"\njoint = "j{k}"\n'
    return text + '[time]\nend = 0.4\nstep = 1e-3\n'


def run(*command):
    return subprocess.run([os.path.join(BIN, command[0]), "--quiet", *command[1:]], capture_output=True, text=True, timeout=300)


def values(*more):
    done = run("hilo-solve", "scene.toml", "-o", "run.h5", *more)
    assert done.returncode == 0, done.stderr
    return {q["quantity"]: q["value"] for q in json.load(open("run.json"))["quantities"]}


def advice(*options):
    done = run("hilo-advise", "scene.toml", "--json", "--apply", "rules.toml", *options)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def write(text):
    with open("scene.toml", "w") as file:
        file.write(text)


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for sizes, turn, level in (((0.05, 0.05, 0.05), 1, "linear"), ((0.004, 0.02, 0.05), 1.5, "nonlinear")):
        write(scene(sizes, turn))
        told = advice("--work", f"{level}.work")
        levels = {r["region"]: r["level"] for r in told["regions"]}
        assert set(levels.values()) <= {"rigid", "linear", "nonlinear"}, levels
        assert levels["a"] == level, (levels, "of a slender bar that a fast hinge turns" if level == "nonlinear" else "of a stout one")
        truth = values("--set", "time.step=5e-4")
        for q in told["quantities"]:
            off = abs(q["value"] - truth[q["quantity"]])
            assert off <= q["allowed"], (sizes, q["quantity"], q["value"], truth[q["quantity"]], q["allowed"])
        # what it says to write is what it ran
        with open("rules.toml") as file:
            rules = [line for line in file if line.startswith("# in the scene: [beam.")]
        assert [line.split('"')[3] for line in rules if "fidelity" in line] == [levels[n] for n in "abc"], rules
        chosen = values(*(part for n in "abc" for part in ("--set", f'beam.{n}.fidelity="{levels[n]}"')))
        for q in told["quantities"]:
            assert abs(chosen[q["quantity"]] - q["value"]) <= 0.1 * q["allowed"], (q, chosen)
        print(f"{sizes}: {levels}")
    kept = advice("--keep", "a=linear", "--keep", "b=nonlinear", "--keep-rigid", "c", "--work", "kept.work")
    assert [r["level"] for r in kept["regions"]] == ["linear", "nonlinear", "rigid"], kept["regions"]
    for options, what in ((("--keep", "a=stiffening"), "cannot stiffen"), (("--finer", "no.h5"), "there is no mesh")):
        done = run("hilo-advise", "scene.toml", *options)
        assert done.returncode == 1 and what in done.stderr, (options, done.returncode, done.stderr)
    write('[[body]]\nname = "b"\nmass = 1\ncom = [0, 0, 0]\ninertia = [1, 1, 1]\n[[quantity]]\nname = "e"\nkind = "peak"\njoint = "j"\n'
          '[[joint]]\nkind = "revolute"\nname = "j"\na = "ground"\nb = "b"\nat = [0, 0, 0]\naxis = [0, 1, 0]\n[time]\nend = 1\nstep = 0.1\n')
    done = run("hilo-advise", "scene.toml")
    assert done.returncode == 1 and "neither a mesh nor beams" in done.stderr, done.stderr
print("advice on beams holds")
