#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every number that a scene may hold, one after the other at values nobody means - 1e-300, 1e300, -1, 0, nan, inf, 3e9 - and the run ends in
seconds: complete with finite results (exit 0), refused with the place of the number (2), or stopped with a reason (3).  The keys come from
the schema (hilo-show --schema), so that a new one is tested too.

  extreme_keys.py BIN            the values that do, and a sixth of the others a day: in the suite
  extreme_keys.py BIN all        all: make -C tests faults
  extreme_keys.py BIN SECTION    those of one section"""
import json
import os
import re
import resource
import struct
import subprocess
import sys
import tempfile
import zlib

import h5py
import numpy

import share

tools = os.path.abspath(sys.argv[1])
VALUES = ("1e-300", "1e300", "-1.0", "0.0", "nan", "inf", "3e9")
MEMORY, SECONDS = 3 << 30, 30

# What a key is where it is not the one that is tried; others take the schema's default or are left out.
WORDS = {"card": "\"*TIE\"", "a": '"ground"', "b": '"arm"', "on": '"arm"', "joint": '"hinge"', "name": '"tried"', "at": "[0, 0, 0]", "axis": "[0, 1, 0]",
         "x": "[1, 0, 0]", "at_a": "[0, 0, 1]", "at_b": "[0.5, 0, 0]", "sensor": '"felt"', "measure": '"DRI"', "section": '"square"', "reactions": '"ground"', "carrier": '"wheel"', "material": '"plain"', "path": '"line"', "file": '"road.csv"'}
NUMBERS = {"E": "2e9", "nu": "0.3", "density": "1000", "mass": "1", "com": "[0.5, 0, 0]", "inertia": "[0.01, 0.1, 0.1]", "pitch": "0.1",
           "ratio": "2", "radius": "0.1", "stiffness": "100", "angular_stiffness": "100", "damping": "1", "angular_damping": "1",
           "lower": "-1", "upper": "1", "rate": "[0, 1]", "torque": "[1, 0]", "force": "[1, 0]", "coefficient": "0.1", "length": "1",
           "direction": "[1, 0, 0]", "edge": "[1, 0, 0]", "axle": "[1, 0, 0]", "axis_b": "[0, 1, 0]", "points": "[[0, 0, 0], [1, 0, 0], [2, 1, 0]]",
           "displacement": "0.1", "velocity": "[0.1, 0, 0]", "spin": "[0, 0.1, 0]", "angle": "0.1", "traction": "[10, 0, 0]", "pressure": "10",
           "t": "[0, 1]", "value": "[0, 1]", "scale": "1", "gravity": "[0, 0, -9.81]", "about": "[0, 0, 0]", "z": "[0, 0, 1]",
           "preload": "1", "area": "1", "mass_damping": "1", "clearance": "0.1", "tangential_stiffness": "[1, 1]",
           "tangential_damping": "[1, 1]", "axes": "[1, 0, 0, 0, 1, 0, 0, 0, 1]", "restitution": "0.5", "rest_speed": "1e-3",
           "slip_velocity": "1e-3", "yield": "1e6", "saturation": "2e6", "saturation_rate": "10",
           "E1": "2e9", "E2": "2e9", "E3": "2e9", "nu12": "0.3", "nu13": "0.3", "nu23": "0.3", "G12": "8e8", "G13": "8e8", "G23": "8e8",
            "diameter": "0.1", "thickness": "0.02", "width": "0.1", "height": "0.1", "flange": "0.02", "web": "0.02", "I1": "1e-5", "I2": "1e-5", "J": "1e-5",
           "bending": "[100, 100, 100]", "line_mass": "1", "cells": "[2]", "orientation": "[0, 1, 0]", "shear": "[1, 1]",
           "axis_1": "[1, 0, 0]", "axis_2": "[0, 1, 0]", "hardening_strain": "[0, 0.1]", "hardening_stress": "[1e6, 2e6]",
           "factors": "[1, 1]", "extension": "[0, 1]", "acceleration": "[1, 0, 0]", "force_per_length": "[1, 0, 0]", "from": "0", "to": "1", "speed": "1", "size": "[1, 1, 1]", "tube": "0.05", "modulus": "1e7", "layer": "0.1", "gap": "0.1", "factor": "1", "friction": "0.1", "fibres": "[[0.05, 0.1]]"}
BODIES = """[[body]]
name = "arm"
mass = 1
com = [0.5, 0, 0]
inertia = [0.01, 0.1, 0.1]
[[body]]
name = "wheel"
mass = 1
com = [0, 0, 1]
inertia = [0.1, 0.1, 0.1]
[[joint]]
kind = "%s"
name = "hinge"
b = "arm"
at = [0, 0, 0]
axis = [0, 1, 0]
x = [1, 0, 0]
"""
SKIN = """[[obstacle]]
kind = "sphere"
name = "skin"
on = "wheel"
radius = 0.1
at = [0.4, 3, 4]
"""
FLOOR = """[[obstacle]]
kind = "plane"
name = "floor"
at = [0, 0, 3.9]
"""
MESH = """*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
*ELEMENT, TYPE=C3D8, ELSET=block
1, 1, 2, 3, 4, 5, 6, 7, 8
*NSET, NSET=base
1, 2, 3, 4
*SURFACE, NAME=top
block, S2
"""
FACE = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
4
1 0 0 0
2 0.1 0 0
3 0.1 0.2 0
4 0 0.2 0
$EndNodes
$Elements
1
1 3 2 0 1 1 2 3 4
$EndElements
"""
LID = """*NODE
11, 0, 0, 1
12, 1, 0, 1
13, 1, 1, 1
14, 0, 1, 1
15, 0, 0, 2
16, 1, 0, 2
17, 1, 1, 2
18, 0, 1, 2
*ELEMENT, TYPE=C3D8, ELSET=lid
2, 11, 12, 13, 14, 15, 16, 17, 18
*SURFACE, NAME=sole
lid, S1
"""




def keys_of_schema():
    """(section, kind) -> [(key, type, default)], from the page that hilo-show --schema prints."""
    page = subprocess.run([tools + "/hilo-show", "--schema"], capture_output=True, text=True, check=True).stdout
    found, at = {}, None
    for line in page[page.index("## The scene"):].splitlines():
        if title := re.match(r'### (\w+)(?: kind = "([\w-]+)")?$', line):
            at = found.setdefault((title[1], title[2] or ""), [])
        elif row := re.match(r"\| `(\w+)` \| ([^|]*) \| [^|]* \| ([^|]*) \|", line):
            at.append((row[1], row[2].strip(), row[3].strip()))
    assert len(found) > 40, "the page has changed"
    return found


def good(key, kind):
    """A value that runs, of the type."""
    if key in WORDS:
        return WORDS[key]
    value = NUMBERS.get(key, "1")
    if kind == "3 numbers" and value.count(",") != 2:
        value = value.strip("[").split(",")[0].strip("]")
    if kind == "number":
        return value.strip("[").split(",")[0].strip("]")
    if kind in ("3 numbers", "numbers") and not value.startswith("["):
        return f"[{value}, 0, 0]" if kind == "3 numbers" else f"[{value}]"
    return value


def of_set(kind, key):
    """A value for which a set of the mesh below has nodes."""
    return "1" if key == "radius" else "[0.3, 0.4, 0]" if (kind, key) == ("near", "at") else ""


def bad(key, kind, value, default):
    if kind == "number":
        return [value]
    if kind == "history":
        return [f"{{t = [0, 0.02], value = [{value}, 1]}}", f"{{t = [0, {value}], value = [0, 1]}}"]
    if key == "points":
        return [f"[[{value}, 0, 0], [1, 0, 0], [2, 1, 0]]"]
    if key == "fibres":
        return [f"[[{value}, 0.1]]"]
    numbers = default.strip("[]").split(",")
    lists = ["[" + ", ".join([value] + numbers[1:]) + "]"]
    if len(numbers) > 1 and value in ("1e300", "3e9"):
        lists.append("[" + ", ".join([value] * len(numbers)) + "]")
    return lists


# Of a section that is given by its stiffness.
MATRIX = {"stiffness": "[1e6, 1e6, 1e6]", "coupling": "[0, 0, 0, 0, 0, 1, 0, 0, 0]", "inertia": "[0.01, 0.1]"}


# Of a field of heights that is an image.
IMAGE = {"file": '"road.png"', "size": "[9, 9]", "heights": "[0, 0.1]"}


def entry(section, kind, keys, tried, value):
    """The table of the tried key, with what it must have."""
    lines = [f'kind = "{kind}"'] if kind else []
    beside = {tried}
    if section == "joint" and tried in ("damping", "angular_damping", "stiffness", "angular_stiffness"):
        beside |= {"stiffness", "angular_stiffness"}
    if section == "joint" and tried == "history":
        beside.add("displacement" if kind == "prismatic" else "angle")
    if tried == "preload" and section == "spring":
        beside.add("stiffness")
    if tried == "axes":
        beside.add("inertia")
    if section in ("stop", "spring") and kind in ("angle", "slide", "stop"):
        beside |= {"lower", "upper"}
    if section == "friction" or tried in ("about", "spin"):
        beside |= {"radius", "about"}
    if kind == "point-on-curve":
        beside.add("points")
    if tried.endswith("_carrier"):
        beside.add("carrier")
    if section == "history":
        beside |= {"t", "value"}
    if section == "material":
        beside |= {"E", "nu", "density"}
        if tried.startswith("saturation"):
            beside |= {"saturation", "saturation_rate"}
        if tried.startswith("hardening_"):
            beside |= {"hardening_strain", "hardening_stress"}
    if section == "body":
        beside.add("inertia")
    if section == "quantity":
        beside.add("sensor")
    if kind == "matrix":
        beside.add("line_mass")
    if section == "section" and kind == "mesh":
        beside.add("file")
    of_image = kind == "height-field" and tried in ("size", "heights")
    if of_image:
        beside |= {"size", "heights"}
    if section == "contact" and tried not in ("modulus", "layer"):
        beside.add("stiffness")
    for key, type_, default in keys:
        if key == tried:
            lines.append(f"{key} = {value}")
        elif key != "kind" and (default == "must" or key in beside or (key in ("a", "b", "on") and section in ("joint", "spring"))):
            word = of_set(kind, key) if section == "set" and of_set(kind, key) else good(key, type_)
            if kind == "matrix":
                word = MATRIX.get(key, word)
            if of_image:
                word = IMAGE.get(key, word)
            if key == "name" and section == "body":
                word = '"arm"'
            if section == "load" and kind in ("traction", "pressure") and key == "on":
                word = '"top"'
            if section == "load" and kind == "centrifugal" and key == "on":
                word = '"block"'
            if kind == "mesh" and key == "file":
                word = '"face.msh"'
            if kind == "line" and key == "on":
                word = '"whip"'
            if kind in ("gear", "rack") and key == "a":
                word = '"wheel"'
            if section == "contact" and key in ("a", "b"):
                word = '"floor"' if key == "a" else '"skin"'
            if section == "tie" and key in ("a", "b"):
                word = '"top"' if key == "a" else '"sole"'
            lines.append(f"{key} = {word}")
    return lines


def scene(section, kind, keys, tried, value):
    """A small scene in which the key matters, and whether it has the mesh."""
    lines = entry(section, kind, keys, tried, value)
    with_mesh = section in ("material", "region", "set", "tie") or kind in ("traction", "pressure", "centrifugal")
    times, rest = "[time]\nend = 0.05\nstep = 0.01\n", ""
    joint_of = {"stop": {"slide": "prismatic"}, "motor": {"linear": "prismatic"}}.get(section, {}).get(kind, "revolute")
    if section == "scene":
        rest = "\n".join(lines) + "\n" + BODIES % joint_of
    elif section in ("time", "solver", "output"):
        own = {"end": "0.05", "step": "0.01"} if section == "time" else {}
        own.pop(tried, None)
        if tried in ("rho1", "rho2", "rho3", "averaged"):
            lines.append('integrator = "U0"')
        if tried in ("gamma", "beta"):
            lines.append('integrator = "newmark"')
        if tried == "steps":
            lines.append('analysis = "static"')
        table = f"[{section}]\n" + "\n".join(lines + [f"{k} = {v}" for k, v in own.items()]) + "\n"
        rest, times = BODIES % joint_of + table, "" if section == "time" else times
        with_mesh = tried in ("dissipation", "interval", "tolerance", "steps", "iterations")
    elif section == "history":
        table = '[history.tried]\n' + "\n".join(lines) + "\n"
        rest = BODIES % joint_of + '[[load]]\nkind = "force"\nname = "pull"\non = "arm"\nforce = [0, 0, 1]\nhistory = "tried"\n' + table
    elif section == "material":
        rest = "[material.tried]\n" + "\n".join(lines) + '\n[region."*"]\nmaterial = "tried"\n'
    elif section == "set":
        rest = "[set.tried]\n" + "\n".join(lines) + '\n[[probe]]\nname = "there"\non = "tried"\n'
    elif section in ("section", "beam"):
        beam = ["[beam.tried]", 'a = "ground"', 'section = "tried"', "points = [[0, 0, 0], [1, 0, 0]]", "cells = [2]"]
        beam += ['material = "plain"'] if kind != "matrix" else []
        square = '[section.square]\nkind = "rectangle"\nwidth = 0.1\nheight = 0.1\n'
        rest = "[section.tried]\n" + "\n".join(lines + beam) if section == "section" else square + "[beam.tried]\n" + "\n".join(lines)
        if section == "beam" and tried != "material":
            rest += '\nmaterial = "plain"'
        if section == "beam" and tried in ("a", "b"):
            rest = BODIES % joint_of + rest
        rest += "\n[material.plain]\nE = 2e9\nnu = 0.3\ndensity = 1000\n"
    elif section == "region":
        rest = '[region."*"]\nmaterial = "plain"\n' + "\n".join(lines) + "\n"
    else:
        alone = section in ("body", "joint", "motion") or (section == "initial")
        rest = "" if section == "body" else BODIES % joint_of
        if alone and section != "body":
            rest = rest[:rest.index("[[joint]]")]
        rest += f"[[{section}]]\n" + "\n".join(lines) + "\n"
        if section in ("obstacle", "contact"):
            rest += SKIN + (FLOOR if section == "contact" else '[[contact]]\nname = "c"\na = "tried"\nb = "skin"\nstiffness = 100\n')
        if kind == "line":
            rest += '[section.square]\nkind = "rectangle"\nwidth = 0.1\nheight = 0.1\n[beam.whip]\na = "ground"\nsection = "square"\npoints = [[0, 0, 0], [1, 0, 0]]\n'
            rest += 'cells = [2]\nmaterial = "plain"\n[material.plain]\nE = 2e9\nnu = 0.3\ndensity = 1000\n'
        if section == "quantity":
            rest += '[[sensor]]\nname = "felt"\non = "arm"\n'
    if with_mesh:
        held = '[[motion]]\nkind = "fixed"\nname = "held"\non = "base"\n'
        plain = '[material.plain]\nE = 2e9\nnu = 0.3\ndensity = 1000\n' + ("" if "[region" in rest else '[region."*"]\nmaterial = "plain"\n')
        rest += held + plain
    if section == "tie":
        return 'mesh = "two.h5"\n' + rest + times, False
    return rest + times, with_mesh


def limits():
    if "ASAN_OPTIONS" not in os.environ:  # whose shadow is larger than any limit
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def finite(path):
    def visit(name, item):
        if isinstance(item, h5py.Dataset) and item.dtype.kind == "f" and not numpy.isfinite(item[...]).all():
            wrong.append(name)
    wrong = []
    with h5py.File(path) as f:
        for group in ("history", "field"):
            if group in f:
                f[group].visititems(visit)
    report = json.load(open(path.replace(".h5", ".json")), parse_constant=lambda word: wrong.append(word))
    wrong += [key for key, x in report.items() if isinstance(x, float) and abs(x) > 1e200]
    return wrong


def judge(text, with_mesh):
    """What is wrong with how the scene ends, or nothing; and the exit code."""
    with open("scene.toml", "w") as f:
        f.write(text)
    for name in ("run.h5", "run.json"):
        if os.path.exists(name):
            os.remove(name)
    try:
        done = subprocess.run([tools + "/hilo-solve", "scene.toml"] + (["mesh.h5"] if with_mesh else []), capture_output=True, text=True,
                              timeout=SECONDS, preexec_fn=limits)
    except subprocess.TimeoutExpired:
        return f"not done in {SECONDS} s", -1
    code, last = done.returncode, (done.stderr.strip().splitlines() or [""])[-1]
    if code == 0:
        bad_arrays = finite("run.h5")
        return (f"complete, but not finite: {bad_arrays[:4]}" if bad_arrays else ""), code
    if code == 2:
        return ("" if re.match(r"hilo-solve: scene\.toml(:\d+:\d+)?: ", last) else f"no place: {last}"), code
    if code == 3:
        return ("" if "stopped at t = " in last else last), code
    return f"exit {code}: {last}", code


def make_mesh():
    with open("road.csv", "w") as f:
        f.write("y\\x,-9,0,9\n-9,0,0.1,0\n0,0.1,0,0\n9,0,0,0\n")
    with open("road.png", "wb") as f:  # 2 x 2 levels of grey
        def chunk(name, data):
            return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        f.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 2, 8, 0, 0, 0, 0)) +
                chunk(b"IDAT", zlib.compress(bytes([0, 1, 2, 0, 3, 4]))) + chunk(b"IEND", b""))
    with open("face.msh", "w") as f:
        f.write(FACE)
    for name, text, regions in (("mesh", MESH, ["block"]), ("two", MESH + LID, ["block", "lid"])):
        with open("deck.inp", "w") as f:
            f.write(text)
        subprocess.run([tools + "/hilo-import", "--quiet", "deck.inp", "--regions", ",".join(regions), "-o", name + ".h5"], check=True, stdout=subprocess.DEVNULL)


def usual(section, kind, key, type_):
    """A value of the key that runs."""
    value = of_set(kind, key) if section == "set" and of_set(kind, key) else good(key, type_)
    if kind == "mesh" and key == "file":
        return '"face.msh"'
    if kind == "matrix":
        return MATRIX.get(key, value)
    if kind == "height-field":
        return IMAGE.get(key, value)
    if kind == "bushing" and value.count(",") == 0 and type_ == "numbers":
        value = "[" + ", ".join(3 * [value.strip("[]")]) + "]"
    return "{t = [0, 0.02], value = [0, 1]}" if type_ == "history" else value


def main():
    failed, codes, number = 0, {}, 0
    for (section, kind), keys in keys_of_schema().items():
        if len(sys.argv) > 2 and sys.argv[2] not in ("all", section):
            continue
        for key, type_, default in [k for k in keys if k[1] in ("number", "3 numbers", "numbers", "history")]:
            value = usual(section, kind, key, type_)
            tries = [("good", value)] + [(v, b) for v in VALUES for b in bad(key, type_, v, good(key, type_) if type_ == "history" else value)]
            for name, value in tries:
                if name == "good" and (section in ("time", "solver", "output") or key in ("about", "layer")):
                    continue
                number += 1
                if name != "good" and len(sys.argv) == 2 and not share.today(number, 6):
                    continue
                text, with_mesh = scene(section, kind, keys, key, value)
                wrong, code = judge(text, with_mesh)
                if name == "good" and code != 0:
                    wrong = wrong or f"exit {code} of a value that should do"
                codes[code] = codes.get(code, 0) + 1
                if wrong:
                    failed += 1
                    print(f"{section} {kind} {key} = {value}: {wrong}", flush=True)
    print(f"{sum(codes.values())} scenes, exit codes {dict(sorted(codes.items()))}, {failed} wrong")
    return 1 if failed else 0


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        make_mesh()
        sys.exit(main())
