#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What could an adjoint of the linear level tell hilo-advise?  At best the slope of each quantity along the flexibility of a region.  This
finds that slope by central differences in its modulus (2 %), without an adjoint, takes the change to no flexibility by it, and prints it
beside what the region rigid changes.
Usage: adjoint.py BIN FOLDER [SCENE...]      SCENE: of advice.py; without any: c1 s2 f3 w2 c8 93100 93101"""
import json
import math
import os
import re
import subprocess
import sys

import advice

STEP = 1.02


def call(tool, *words):
    done = subprocess.run([os.path.join(TOOLS, tool), "--quiet", *words], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr


def values(name, tags):
    call("hilo-solve", "scene.toml", tags, "--set", 'time.error_estimate="never"', "-o", name + ".h5")
    return {q["quantity"]: q["value"] for q in json.load(open(name + ".json"))["quantities"]}


def with_modulus(region, factor):
    deck = open("deck.inp").read()
    E = re.search(rf"\*MATERIAL, NAME=m{region}\n\*ELASTIC\n([0-9.e+]+),", deck)
    open("other.inp", "w").write(deck[: E.start(1)] + f"{float(E.group(1)) * factor:.9g}" + deck[E.end(1) :])
    call("hilo-import", "other.inp", "-o", "other-mesh.h5")
    call("hilo-tag", "other-mesh.h5", "--rest", "linear", "-o", "other-tags.h5")
    return values("other", "other-tags.h5")


TOOLS = os.path.abspath(sys.argv[1])
top = os.path.abspath(sys.argv[2])
print("scene  rigid  quantity    rigid, %  by slope, %")
for name in sys.argv[3:] or "c1 s2 f3 w2 c8 93100 93101".split():
    s = advice.PUBLISHED[name](name) if name in advice.PUBLISHED else advice.drawn(int(name))
    os.makedirs(os.path.join(top, name), exist_ok=True)
    os.chdir(os.path.join(top, name))
    s.write()
    call("hilo-import", "deck.inp", "-o", "mesh.h5")
    call("hilo-tag", "mesh.h5", "--rest", "linear", "-o", "base-tags.h5")
    base = values("base", "base-tags.h5")
    for region in s.regions:
        call("hilo-tag", "mesh.h5", "--rigid", region, "--rest", "linear", "-o", "rigid-tags.h5")
        rigid = values("rigid", "rigid-tags.h5")
        more, less = with_modulus(region, STEP), with_modulus(region, 1 / STEP)
        for q in base:
            slope = (more[q] - less[q]) / (2 * math.log(STEP))
            print(f"{name:6} {region:6} {q:10} {100 * (rigid[q] / base[q] - 1):9.2f} {100 * slope / base[q]:12.2f}", flush=True)
