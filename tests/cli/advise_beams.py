#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""hilo-advise on beams: what it chooses is within its tolerance of all beams nonlinear at half the step, and linear where that serves.
Usage: advise_beams.py BIN"""
import os
import subprocess
import tempfile

from advised import BIN, hinge, levels, peak, refused, told, values, write


def scene(sizes, turn, names="abc", metre=1, second=1, cells=4):
    """Bars of square section on hinges, one behind the other; the first hinge turns within .4 s."""
    text = f'gravity = [0, 0, {-9.81 * metre / second**2}]\n[material.steel]\nE = {2e11 / metre / second**2}\nnu = 0.3\ndensity = {7800 / metre**3}\n'
    for k, name in enumerate(names):
        text += f'[section.{name}]\nkind = "rectangle"\nwidth = {sizes[k] * metre}\nheight = {sizes[k] * metre}\n'
        text += f'[beam.{name}]\npoints = [[{k * metre}, 0, 0], [{(k + 1) * metre}, 0, 0]]\ncells = [{cells}]\nsection = "{name}"\nmaterial = "steel"\n'
        text += f'damping = {1.2e-5 * second}\n'
        text += hinge(f"j{k}", "ground" if k == 0 else names[k - 1] + ".end", name + ".0", [k * metre, 0, 0])
        if k == 0:
            text += f'angle = {turn}\nhistory = {{t = [0, {0.2 * second}, {0.4 * second}], value = [0, 0.5, 1], interpolation = "smoother"}}\n'
        text += peak(f"R{k}", f"j{k}")
    return text + f'[time]\nend = {0.4 * second}\nstep = {1e-3 * second}\n'


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    # of few cells a run of all of them is the cheapest: those of stout bars are many
    for sizes, turn, cells, level in (((0.05, 0.05, 0.05), 1, 24, "linear"), ((0.004, 0.02, 0.05), 1.5, 4, "nonlinear")):
        write(scene(sizes, turn, cells=cells))
        advice = told("--apply", "rules.toml", "--work", f"{level}.work")
        chosen = levels(advice)
        assert set(chosen.values()) <= {"rigid", "linear", "nonlinear"}, chosen
        assert chosen["a"] == level, (chosen, "of a slender bar that a fast hinge turns" if level == "nonlinear" else "of a stout one")
        truth = values("--set", "time.step=5e-4")
        for q in advice["quantities"]:
            off = abs(q["value"] - truth[q["quantity"]])
            assert off <= q["allowed"], (sizes, q["quantity"], q["value"], truth[q["quantity"]], q["allowed"])
        # what it says to write is what it ran
        with open("rules.toml") as file:
            rules = [line for line in file if line.startswith("# in the scene: [beam.")]
        assert [line.split('"')[3] for line in rules if "fidelity" in line] == [chosen[n] for n in "abc"], rules
        ran = values(*(part for n in "abc" for part in ("--set", f'beam.{n}.fidelity="{chosen[n]}"')))
        for q in advice["quantities"]:
            assert abs(ran[q["quantity"]] - q["value"]) <= 0.1 * q["allowed"], (q, ran)
        print(f"{sizes}: {chosen}")
    kept = told("--keep", "a=linear", "--keep", "b=nonlinear", "--keep-rigid", "c", "--work", "kept.work")
    assert [r["level"] for r in kept["regions"]] == ["linear", "nonlinear", "rigid"], kept["regions"]
    for options, what in ((("--keep", "a=stiffening"), "cannot stiffen"), (("--finer", "no.h5"), "there is no mesh")):
        refused([1], [what], *options)
    # in other units it is the same: steps, ends and frequencies of its runs are those of the scene
    ran = []
    for units, size in (("m-kg-s", (1, 1)), ("mm-kg-ms", (1000, 1000))):
        write(f'units = "{units}"\n' + scene((0.05, 0.05), 1, "ab", *size))
        ran.append(told("--tol", "2%", "--work", units))
    assert levels(ran[0]) == levels(ran[1]), ran
    for one, other in zip(*(r["quantities"] for r in ran)):
        assert abs(one["value"] / other["value"] - 1) < 1e-3, (one, other)
    # and what it says to write
    write(f'units = "mm-kg-ms"\n' + scene((0.05, 0.05), 1, "ab", 1000, 1000).replace("step = 1.0", "step = 20"))
    refused([2], ["time.step = 0.6"], "--tol", "0.1%")
    # what no level mends is told once, as the solver tells it
    write(scene((0.05, 0.05), 1, "ab").replace('name = "j1"', 'name = "j1"\nstiffness = [1e6, 0, 0]'))
    ran = subprocess.run([os.path.join(BIN, "hilo-advise"), "scene.toml"], capture_output=True, text=True)
    told_why = [line for line in ran.stderr.splitlines() if "leaves a row" in line]
    assert ran.returncode == 2 and len(told_why) == 1 and "no model to judge by runs" in told_why[0], ran.stderr
    write('[[body]]\nname = "b"\nmass = 1\ncom = [0, 0, 0]\ninertia = [1, 1, 1]\n[[quantity]]\nname = "e"\nkind = "peak"\njoint = "j"\n'
          + hinge("j", "ground", "b", [0, 0, 0]) + "[time]\nend = 1\nstep = 0.1\n")
    refused([1], ["neither a mesh nor beams"])
print("advice on beams holds")
