#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The stability catalogue: rules of its runs for make, and its table from what the runs left.

catalogue.py rules          writes out/rules.mk, and out/SCENE/METHOD.args where they changed
catalogue.py picture SCENE  writes out/SCENE/energy.csv for hilo-post chart
catalogue.py table          writes out/table.txt, out/table.csv, out/table.md; exit 1 when a row is not what it must be

Energy is kinetic + elastic + potential - work of loads and motions, summed here from the results; the scale is the default's
largest kinetic energy.  held: |dE| <= 1e-10 of it to the end; fails: stopped, or more than a tenth gained; otherwise the drift.
"""
import csv
import json
import os
import sys
import tomllib

limit, gain = 1e-10, 0.1
with open("catalogue.toml", "rb") as f:
    catalogue = tomllib.load(f)
methods, scenes, locking = catalogue["method"], catalogue["scene"], catalogue["locking"]


def runs_of(scene):
    return [m for m in methods if m["name"] not in scene.get("skip", []) and not (m.get("meshes_only") and "mesh" not in scene)]


def write(path, text):
    """Only where the text is new, so that make redoes only what changed."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    if not os.path.exists(path) or open(path).read() != text:
        with open(path, "w") as f:
            f.write(text)


def rules():
    lines, tables, pictures, meshes = [], [], [], {}
    for s in scenes:
        name, mesh = s["name"], "-"
        if "mesh" in s:
            stem, kind = s["mesh"].split(".")
            mesh = f"out/{stem}{''.join('-' + d.replace('=', '') for d in s.get('define', []))}.h5"
            more = " ".join(["--define " + d for d in s.get("define", [])] + (["--rest bars"] if kind == "inp" else []))
            meshes[mesh] = f"{mesh}: {s['mesh']} $(BIN)/hilo-import\n\t$(BIN)/hilo-import --quiet $< -o $@ {more} > /dev/null\n"
        for m in runs_of(s):
            stem = f"out/{name}/{m['name']}"
            histories = "energy constraint " + s.get("column", "")
            args = " ".join("--set '" + a + "'" for a in m["set"])
            write(stem + ".args", histories + args + "\n")
            lines.append(f"{stem}.csv: scenes/{name}.toml {'' if mesh == '-' else mesh} {stem}.args run.sh $(BIN)/hilo-solve $(BIN)/hilo-post\n"
                         f"\t@./run.sh $< {mesh} {stem} '{histories}' {args}\n")
            tables.append(stem + ".csv")
        picture = f"out/{name}.png"
        pictures.append(picture)
        shown = " ".join(f"out/{name}/{m}.csv" for m in s["picture"])
        low, high = s.get("shown", [-1.05, 1.1])
        what = s.get("column", "").split(".")[-1]
        label = f"{what}/{what}_rigid [1]" if what else "change of energy / largest kinetic energy [1]"
        lines.append(f"{picture}: {shown} catalogue.toml catalogue.py $(BIN)/hilo-post\n\t@./catalogue.py picture {name}\n"
                     f"\t$(BIN)/hilo-post chart out/{name}/picture.csv --size 960x540 --by method --yrange {low},{high} --ylabel '{label}'"
                     f" --title '{s['row']}: {s['what']}' -o $@\n")
    for case in locking["case"]:
        for e in locking["element"]:
            stem = f"out/locking/{case['name']}-{e['name']}"
            size = ["L=10", "B=1", f"H={case['height']}"] + [f"{a}={n}" for a, n in zip(("NX", "NY", "NZ"), case["cells"])]
            more = " ".join(["--define " + d for d in size] + e["options"])
            meshes[stem] = f"{stem}-mesh.h5: block.geo $(BIN)/hilo-import\n\t@mkdir -p $(@D)\n\t@$(BIN)/hilo-import --quiet $< -o $@ {more} > /dev/null\n"
            lines.append(f"{stem}.csv: scenes/cantilever.toml {stem}-mesh.h5 run.sh $(BIN)/hilo-solve $(BIN)/hilo-post\n"
                         f"\t@./run.sh $< {stem}-mesh.h5 {stem} probe.tip.z --set material.soft.nu={case['nu']}\n")
            tables.append(stem + ".csv")
    write("out/rules.mk", "TABLES := " + " ".join(tables) + "\nPICTURES := " + " ".join(pictures) + "\n" + "".join(meshes.values()) + "".join(lines))


def read(scene, method):
    """Columns of a run by name, without their units."""
    with open(f"out/{scene}/{method}.csv") as f:
        rows = list(csv.reader(f))
    return {name.split(" [")[0]: [float(r[i]) for r in rows[1:]] for i, name in enumerate(rows[0])}


def energy(run):
    return [t + e + g - w for t, e, g, w in zip(*(run["energy." + c] for c in ("kinetic", "elastic", "gravity", "external_work")))]


def scale_of(scene):
    return max(read(scene["name"], "energy-momentum")["energy.kinetic"])


def percent(x):
    return f"{100 * x:+.0f} %" if abs(x) > 0.095 else f"{100 * x:+.1g} %"


def judge(scene, method, scale):
    run, stem = read(scene["name"], method), f"out/{scene['name']}/{method}"
    E, t = energy(run), run["t"]
    d = [(e - E[0]) / scale for e in E]
    with open(stem + ".json") as f:
        report = json.load(f)
    stopped = int(open(stem + ".exit").read()) != 0
    worst = max(d, key=abs)
    gained = next((t[i] for i, x in enumerate(d) if not x <= gain), None)
    r = {"t": t[-1], "worst": worst, "last": d[-1], "violation": max(run["constraint.violation"]), "steps": report["steps"],
         "seconds": report["seconds"]["all"], "redundant": report["redundant_rows"], "low": None, "high": None}
    if scene.get("measure") == "range":
        a = [x / scene["unit"] for x, at in zip(run[scene["column"]], t) if at > scene["from"]]
        r["low"], r["high"] = min(a), max(a)
        inside = scene["range"][0] <= r["low"] and r["high"] <= scene["range"][1]
        r["verdict"], r["cell"] = "held" if inside and not stopped else "fails", f"{r['low']:.2f} .. {r['high']:.2f}"
        return r
    if stopped or gained is not None:
        r["t"] = t[-1] if gained is None else gained
        r["verdict"], r["cell"] = "fails", f"fails {r['t']:.3g} s"
    elif abs(worst) <= limit:
        r["verdict"], r["cell"] = "held", f"held {abs(worst):.0e}"
    else:
        r["verdict"], r["cell"] = "drift", percent(worst)
    return r


def picture(name):
    scene = next(s for s in scenes if s["name"] == name)
    scale = scale_of(scene)
    out = ["time [s],value,method"]
    for m in (m for m in methods if m["name"] in scene["picture"]):
        run = read(name, m["name"])
        if "column" in scene:
            y = [x / scene["unit"] for x in run[scene["column"]]]
        else:
            E = energy(run)
            y = [max(-9, min(9, (e - E[0]) / scale)) for e in E]
        stride = max(1, len(y) // 4000)
        out += [f"{t:.9g},{v:.9g},{m['short']}" for t, v in list(zip(run["t"], y))[::stride]]
    write(f"out/{name}/picture.csv", "\n".join(out) + "\n")


def deflection(case, element, wrong):
    """Deflection of the cantilever over Timoshenko's, P L^3/(3 E I) + P L/(5/6 G A)."""
    E, P, L, h, nu = 1e7, 1e-3, 10, case["height"], case["nu"]
    beam = P * L**3 / (3 * E * h**3 / 12) + P * L / (5 / 6 * E / (2 + 2 * nu) * h)
    with open(f"out/locking/{case['name']}-{element}.csv") as f:
        ratio = float(f.read().split()[-1].split(",")[-1]) / beam
    low, high = locking["holds_within"]
    if element in locking["fails"] and not ratio < locking["fails_below"]:
        wrong.append(f"B9 {case['name']}, {element}: was to lock, it reaches {ratio:.3f}")
    if element not in locking["fails"] and not low <= ratio <= high:
        wrong.append(f"B9 {case['name']}, {element}: was not to lock, it reaches {ratio:.3f}")
    return f"{ratio:.3f}"


def aligned(rows):
    widths = [max(len(r[i]) for r in rows) for i in range(len(rows[0]))]
    return "".join("  ".join(c.ljust(w) for c, w in zip(r, widths)).rstrip() + "\n" for r in rows)


def piped(rows):
    return "".join("| " + " | ".join(r) + " |\n" for r in [rows[0], ["---"] * len(rows[0])] + rows[1:])


def table():
    wrong, text, long_form = [], [], [["row", "scene", "method", "verdict", "t [s]", "largest dE/E", "last dE/E", "constraint [m]",
                                       "lowest", "highest", "steps", "seconds"]]
    for s in scenes:
        scale, cells = scale_of(s), []
        for m in methods:
            if m not in runs_of(s):
                cells.append("")
                continue
            r = judge(s, m["name"], scale)
            cells.append(r["cell"])
            long_form.append([s["row"], s["name"], m["name"], r["verdict"]] + [("" if r[k] is None else f"{r[k]:.6g}") for k in
                             ("t", "worst", "last", "violation", "low", "high", "steps", "seconds")])
            where = f"{s['row']} {s['name']}, {m['name']}: "
            if m["name"] == "energy-momentum":
                if r["verdict"] != "held" or abs(r["worst"]) > limit:
                    wrong.append(where + f"the default must hold, it is \"{r['cell']}\", |dE/E| {abs(r['worst']):.2e}")
                if r["violation"] > s.get("gap", 1):
                    wrong.append(where + f"constraints are off by {r['violation']:.1e} m, allowed {s['gap']:.1e} m")
                if r["redundant"] != s.get("redundant", r["redundant"]):
                    wrong.append(where + f"{r['redundant']} redundant rows, not {s['redundant']}")
            if m["name"] in s.get("fails", []) and r["verdict"] != "fails":
                wrong.append(where + f"was to fail, it is \"{r['cell']}\"")
            if m["name"] in s.get("drifts", []) and (r["verdict"] == "held" or abs(r["worst"]) < 0.01):
                wrong.append(where + f"was to drift by a hundredth, it is \"{r['cell']}\"")
        if not s.get("fails") and not s.get("drifts"):
            wrong.append(f"{s['row']} {s['name']}: names no method that fails")
        text.append([s["row"], s["what"]] + cells)
    head = ["", "scene"] + [m["short"] for m in methods]
    locks = [["B9", f"locking: {c['what']}"] + [deflection(c, e["name"], wrong) for e in locking["element"]] for c in locking["case"]]
    locks_head = ["", "deflection / beam theory"] + [e["name"] for e in locking["element"]]
    write("out/table.txt", aligned([head] + text) + "\n" + aligned([locks_head] + locks))
    write("out/table.md", piped([head] + text) + "\n" + piped([locks_head] + locks))
    write("out/table.csv", "".join(",".join(f'"{c}"' if "," in c else c for c in r) + "\n" for r in long_form))
    for w in wrong:
        print("not as it must be:", w, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit({"rules": rules, "picture": picture, "table": table}[sys.argv[1]](*sys.argv[2:]))
