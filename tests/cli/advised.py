# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of the tools for the tests of hilo-advise, in the folder that holds scene.toml: the first argument of the script is where the tools are."""
import json
import os
import subprocess
import sys

BIN = os.path.abspath(sys.argv[1])


def run(tool, *words):
    return subprocess.run([os.path.join(BIN, tool), "--quiet", *words], capture_output=True, text=True, timeout=300)


def done(*command):
    """What a command prints; it ends well."""
    ran = run(*command)
    assert ran.returncode == 0, (command, ran.returncode, ran.stderr)
    return ran.stdout


def write(text):
    with open("scene.toml", "w") as file:
        file.write(text)


def imported(deck, mesh="mesh.h5"):
    with open("deck.inp", "w") as file:
        file.write(deck)
    done("hilo-import", "deck.inp", "-o", mesh)


def values(*words):
    """The quantities of a run, by name."""
    done("hilo-solve", "scene.toml", *words, "-o", "run.h5")
    return {q["quantity"]: q["value"] for q in json.load(open("run.json"))["quantities"]}


def told(*words):
    """What hilo-advise says of the scene."""
    return json.loads(done("hilo-advise", "scene.toml", *words, "--json"))


def levels(advice):
    return {r["region"]: r["level"] for r in advice["regions"]}


def refused(codes, said, *words):
    """It ends so, with one line that has all that was to be said."""
    ran = run("hilo-advise", "scene.toml", *words)
    assert ran.returncode in codes and all(w in ran.stderr for w in said), (said, ran.returncode, ran.stderr)
    assert len(ran.stderr.splitlines()) == 1, ran.stderr


def hinge(name, a, b, at):
    return f'[[joint]]\nkind = "revolute"\nname = "{name}"\na = "{a}"\nb = "{b}"\nat = {at}\naxis = [0, 1, 0]\n'


def peak(name, joint):
    return f'[[quantity]]\nname = "{name}"\nkind = "peak"\njoint = "{joint}"\n'
