#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""hilo-advise on beams: what it chooses is within its tolerance of all beams nonlinear at half the step, and linear where that serves.
Usage: advise_beams.py BIN"""
import os
import tempfile

from advised import hinge, levels, peak, refused, told, values, write


def scene(sizes, turn, names="abc"):
    """Bars of square section on hinges, one behind the other; the first hinge turns within .4 s."""
    text = 'gravity = [0, 0, -9.81]\n[material.steel]\nE = 2e11\nnu = 0.3\ndensity = 7800\n'
    for k, name in enumerate(names):
        text += f'[section.{name}]\nkind = "rectangle"\nwidth = {sizes[k]}\nheight = {sizes[k]}\n'
        text += f'[beam.{name}]\npoints = [[{k}, 0, 0], [{k + 1}, 0, 0]]\ncells = [4]\nsection = "{name}"\nmaterial = "steel"\n'
        text += 'damping = 1.2e-5\n'
        text += hinge(f"j{k}", "ground" if k == 0 else names[k - 1] + ".end", name + ".0", [k, 0, 0])
        if k == 0:
            text += f'angle = {turn}\nhistory = {{t = [0, 0.2, 0.4], value = [0, 0.5, 1], interpolation = "smoother"}}\n'
        text += peak(f"R{k}", f"j{k}")
    return text + '[time]\nend = 0.4\nstep = 1e-3\n'


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for sizes, turn, level in (((0.05, 0.05, 0.05), 1, "linear"), ((0.004, 0.02, 0.05), 1.5, "nonlinear")):
        write(scene(sizes, turn))
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
    write('[[body]]\nname = "b"\nmass = 1\ncom = [0, 0, 0]\ninertia = [1, 1, 1]\n[[quantity]]\nname = "e"\nkind = "peak"\njoint = "j"\n'
          + hinge("j", "ground", "b", [0, 0, 0]) + "[time]\nend = 1\nstep = 0.1\n")
    refused([1], ["neither a mesh nor beams"])
print("advice on beams holds")
