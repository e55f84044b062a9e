#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Work-precision: error of a probe's position at the end, against steps and against processor time, for every method and scene.

charts.py rules                  writes out/rules.mk, and out/SCENE/*.args where they changed
charts.py reference SCENE        writes out/SCENE/reference.csv
charts.py measure SCENE METHOD   writes out/SCENE/METHOD.csv: one row for each run that came to its end
charts.py join SCENE             writes out/SCENE.csv from all of them; exit 1 where the default is below second order
charts.py summary                writes out/summary.md: steps and milliseconds to an error of 1e-4, interpolated between runs

Processor time is user + system of the whole process, less that of the same scene run for one step: start-up is not counted, writing
histories is.  The smaller of two runs counts.
"""
import csv
import json
import math
import os
import resource
import subprocess
import sys
import tomllib

import truth

with open("charts.toml", "rb") as f:
    charts = tomllib.load(f)
methods, scenes = charts["method"], {s["name"]: s for s in charts["scene"]}


def slug(name):
    return "".join(c if c.isalnum() else "_" for c in name)


def write(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    if not os.path.exists(path) or open(path).read() != text:
        with open(path, "w") as f:
            f.write(text)


def methods_of(scene):
    return [m for m in methods if not m.get("rigid_only" if "mesh" in scene else "meshes_only")]


def rules():
    lines, pictures = [], []
    for name, s in scenes.items():
        mesh = f"out/{s['mesh']}.h5" if "mesh" in s else ""
        own = {k: v for k, v in s.items() if k != "title"}
        curves = []
        for m in methods_of(s):
            stem = f"out/{name}/{slug(m['name'])}"
            write(stem + ".args", json.dumps([own, m, charts["budget"]]) + "\n")
            lines.append(f"{stem}.csv: {s['file']} {mesh} out/{name}/reference.csv {stem}.args $(BIN)/hilo-solve\n"
                         f"\t@./charts.py measure {name} '{m['name']}'\n")
            curves.append(stem + ".csv")
        write(f"out/{name}/reference.args", json.dumps(own) + "\n")
        lines.append(f"out/{name}/reference.csv: {s['file']} {mesh} truth.py out/{name}/reference.args $(BIN)/hilo-solve\n\t@./charts.py reference {name}\n")
        lines.append(f"out/{name}.csv: {' '.join(curves)}\n\t@./charts.py join {name}\n")
        for kind, column, label in (("steps", "steps", "steps"), ("time", "processor time", "processor time [s]")):
            picture = f"out/{name}-{kind}.png"
            pictures.append(picture)
            slopes = "--slope -2 --slope -5" if kind == "steps" else "--slope -2"
            lines.append(f"{picture}: out/{name}.csv charts.toml $(BIN)/hilo-post\n\t@$(BIN)/hilo-post chart $< -x '{column}' -y error --by method --log xy --markers"
                         f" {slopes} --xlabel '{label}' --ylabel 'error of position / length of the scene' --size 1100x680 --title \"{s['title']}\" -o $@\n")
    write("out/rules.mk", f"PICTURES := {' '.join(pictures)}\nCSVS := {' '.join(f'out/{n}.csv' for n in scenes)}\n" + "".join(lines))


def run(scene, out, sets):
    """Exit code, processor seconds and what run.json says."""
    command = ["hilo-solve", "--quiet", scene["file"]] + ([f"out/{scene['mesh']}.h5"] if "mesh" in scene else []) + ["-o", out + ".h5"]
    sets = sets + [f"output.interval={scene['end']}", "output.fields=[\"displacement\"]", "solver.tolerance=1e-12"]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    code = subprocess.run(command + [a for s in sets for a in ("--set", s)], stderr=subprocess.DEVNULL).returncode
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    if code not in (0, 3):
        sys.exit(f"charts.py: {' '.join(command)} ended with {code}")
    with open(out + ".json") as f:
        return code, seconds, json.load(f)


def position(scene, out):
    """Last row of the probe."""
    text = subprocess.run(["hilo-post", "series", out + ".h5"] + [f"probe.{scene['probe']}.{c}" for c in "xyz"], capture_output=True, text=True, check=True).stdout
    return [float(x) for x in text.split()[-1].split(",")[1:]]


def reference(name):
    scene = scenes[name]
    if scene["truth"] == "radau":
        out, where = f"out/{name}/reference", []
        for n in (scene["reference"] // 2, scene["reference"]):
            code, _, _ = run(scene, out, ["time.integrator=\"radau\"", f"time.end={scene['end']}", f"time.step={scene['end'] / n!r}", "solver.cuts=0"])
            if code:
                sys.exit(f"charts.py: the reference of {name} stopped")
            where.append(position(scene, out))
        doubt = math.dist(*where)  # of the coarser one: the finer is better by an order or more
        x = where[-1]
    else:
        x, doubt = getattr(truth, scene["truth"])(scene["end"]), 0
    write(f"out/{name}/reference.csv", "x [m],y [m],z [m],doubt [m]\n" + ",".join(f"{v:.17g}" for v in [*x, doubt]) + "\n")


def measure(name, method):
    scene, m = scenes[name], next(m for m in methods if m["name"] == method)
    with open(f"out/{name}/reference.csv") as f:
        *x, doubt = [float(v) for v in list(csv.reader(f))[1]]
    floor = max(1e-10 * scene["unit"], 5 * doubt)
    out = f"out/{name}/{slug(method)}"
    end, h = f"time.end={scene['end']}", scene["end"] / scene["steps"]
    start = min(run(scene, out, m["set"] + [f"time.end={h!r}", f"time.step={h!r}", 'time.error_estimate="never"'])[1] for _ in range(3))
    rows, last, n, tolerances = [], math.inf, scene["steps"], list(m.get("tolerances", []))
    while True:
        if "tolerances" in m:
            if not tolerances:
                break
            sets = m["set"] + [end, f"time.step={h!r}", f"time.tolerance={tolerances.pop(0)}", 'time.error_estimate="never"']
        else:
            sets = m["set"] + [end, f"time.step={scene['end'] / n!r}", "solver.cuts=0", 'time.error_estimate="never"']
        code, seconds, report = run(scene, out, sets)
        if code == 0:
            at = position(scene, out)
            error = math.dist(at, x)
            if seconds < 0.3:
                seconds = min(seconds, run(scene, out, sets)[1])
            seconds -= start
            if error < floor or error > 0.7 * last and last < 1e-6 * scene["unit"]:  # round-off, here or in the truth
                break
            last = error
            if error < 0.5 * scene["unit"]:  # one that has blown up and yet ended is no result
                shown = f"{seconds:.5g}" if seconds > 2e-3 else ""  # less is not told from start-up
                rows.append(f"{method},{report['steps']},{shown},{error / scene['unit']:.5g}\n")
        n *= 2
        if seconds > charts["budget"] / 2 or n > 1 << 22:
            break
    write(out + ".csv", "method,steps,processor time [s],error\n" + "".join(rows))
    for kind in (".h5", ".xdmf", ".json"):
        if os.path.exists(out + kind):
            os.remove(out + kind)


def join(name):
    text, wrong = "method,steps,processor time [s],error\n", []
    for m in methods_of(scenes[name]):
        with open(f"out/{name}/{slug(m['name'])}.csv") as f:
            rows = f.read().splitlines()[1:]
        text += "".join(r + "\n" for r in rows or [m["name"] + ",,,"])  # without a point it keeps its name and colour
        if m["name"] == methods[0]["name"] and not scenes[name].get("rings"):
            clean = [r.split(",") for r in rows if float(r.split(",")[3]) > 1e-7]
            (_, n0, _, e0), (_, n1, _, e1) = clean[-2:]
            order = math.log(float(e0) / float(e1)) / math.log(int(n1) / int(n0))
            if order < 1.8:
                wrong.append(f"charts.py: {name}: the default is of order {order:.2f} over its last doubling, below 2")
    write(f"out/{name}.csv", text)
    for w in wrong:
        print(w, file=sys.stderr)
    return 1 if wrong else 0


def reached(rows, column, goal):
    """Where the last crossing of the goal lies, by straight lines between logarithms; "" where none was seen."""
    points = [(math.log(float(r["error"])), math.log(float(r[column]))) for r in rows if r["error"] and r[column]]
    for (e0, c0), (e1, c1) in reversed(list(zip(points, points[1:]))):
        if e1 <= math.log(goal) <= e0:
            return math.exp(c0 + (c1 - c0) * (math.log(goal) - e0) / (e1 - e0))
    return None


def milliseconds(t):
    return format(float(f"{1e3 * t:.2g}"), "g")


def summary():
    shown = [m["name"] for m in methods if not m.get("meshes_only")]
    lines = ["| steps / ms to 1e-4 | " + " | ".join(shown) + " |", "|---" * (len(shown) + 1) + "|"]
    for name in scenes:
        with open(f"out/{name}.csv") as f:
            rows = list(csv.DictReader(f))
        cells = []
        for m in shown:
            own = [r for r in rows if r["method"] == m]
            n, t = reached(own, "steps", 1e-4), reached(own, "processor time [s]", 1e-4)
            first = next((r for r in own if r["error"] and float(r["error"]) < 1e-4), None)
            if n is None and own and first is own[0]:  # the coarsest step is good enough
                cells.append(f"< {first['steps']} / < {milliseconds(float(first['processor time [s]'] or 2e-3))}")
                continue
            cells.append("" if n is None else f"{float(f'{n:.2g}'):.0f} / {'< 2' if t is None else milliseconds(t)}")
        lines.append(f"| {name.replace('_', ' ')} | " + " | ".join(cells) + " |")
    write("out/summary.md", "\n".join(lines) + "\n")


if __name__ == "__main__":
    sys.exit({"rules": rules, "reference": reference, "measure": measure, "join": join, "summary": summary}[sys.argv[1]](*sys.argv[2:]))
