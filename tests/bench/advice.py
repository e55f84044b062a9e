#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Does hilo-advise choose well?  It advises on scenes of beams, those of a published study by name (c1 .. e6) and others drawn at random
(numbers), and every model it ran is judged by a truth outside it: all regions nonlinear at half the step. No run has the second solution
that estimates its error: costs are of like runs.
Usage: advice.py BIN FOLDER SCENE... [--tol 2%] [--every] [--kept] [-- options of hilo-advise]      SCENE: c1, f2, all26, 7, 100-160
Columns: true error of the chosen model over the tolerance, largest of all quantities; that of all rigid and all linear; processor seconds of
the chosen one over those of the cheapest model that meets the tolerance in truth of those that ran, and over those of all nonlinear; of the
advice, in runs of all nonlinear; true error of the quantity that is off most, with its sign, and what the budget adds up to; whether cells
checked it. At the end the sums. A refusal is right where all nonlinear at this step is off by more than 0.6 of the tolerance."""
import argparse
import itertools
import json
import math
import os
import random
import resource
import statistics
import subprocess
import sys

RHO, NU = 7850, 0.3


def unit(v):
    size = math.sqrt(sum(c * c for c in v))
    return [c / size for c in v]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


class Deck:
    """Beams of hexahedra of 20 nodes; those whose faces are at one place share its nodes where `bonded`."""

    def __init__(self, bonded=False):
        self.bonded, self.nodes, self.place, self.elements, self.sets, self.cells = bonded, [], {}, "", "", 0

    def beam(self, name, start, end, side, E, n, across=(0, 1, 0)):
        """Sets NAME0 and NAME1 at its ends, NAMEm in its middle."""
        along = [e - s for s, e in zip(start, end)]
        x = unit(along)
        z = unit(cross(x, across))
        y = cross(z, x)
        ids = {}

        def node(i, j, k):
            if (i, j, k) not in ids:
                p = [s + d * i / (2 * n) + side * ((j / 2 - 0.5) * b + (k / 2 - 0.5) * c) for s, d, b, c in zip(start, along, y, z)]
                key = (tuple(round(v, 9) for v in p), "" if self.bonded else name)
                if key not in self.place:
                    self.nodes.append(p)
                    self.place[key] = len(self.nodes)
                ids[i, j, k] = self.place[key]
            return ids[i, j, k]

        self.elements += f"*ELEMENT, TYPE=C3D20, ELSET={name}\n"
        for i in range(0, 2 * n, 2):
            corner = [(i, 0, 0), (i + 2, 0, 0), (i + 2, 2, 0), (i, 2, 0), (i, 0, 2), (i + 2, 0, 2), (i + 2, 2, 2), (i, 2, 2)]
            edges = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
            middle = [tuple((p + q) // 2 for p, q in zip(corner[a], corner[b])) for a, b in edges]
            self.cells += 1
            row = [self.cells] + [node(*p) for p in corner + middle]
            self.elements += ", ".join(map(str, row[:16])) + ",\n" + ", ".join(map(str, row[16:])) + "\n"
        for at, tag in ((0, "0"), (n, "m"), (2 * n, "1")):
            self.sets += f"*NSET, NSET={name}{tag}\n" + ",\n".join(str(v) for p, v in ids.items() if p[0] == at) + "\n"
        self.sets += f"*MATERIAL, NAME=m{name}\n*ELASTIC\n{E:.6g}, {NU}\n*DENSITY\n{RHO}\n*SOLID SECTION, ELSET={name}, MATERIAL=m{name}\n"

    def text(self):
        rows = "".join(f"{i + 1}, {p[0]:.9g}, {p[1]:.9g}, {p[2]:.9g}\n" for i, p in enumerate(self.nodes))
        return "*NODE\n" + rows + self.elements + self.sets


def damping(E, length, side):
    """beta of 1 % at the first frequency of the beam between pins  [s]"""
    f = math.pi / 2 * math.sqrt(E * side**2 / 12 / RHO) / length**2
    return 0.01 / (math.pi * f)


def table(section, name, **keys):
    text = f'[[{section}]]\nname = "{name}"\n'
    for key, value in keys.items():
        text += f"{key} = {value if str(value).startswith('{') else json.dumps(value)}\n"
    return text


def course(t, value, interpolation="linear"):
    return "{t = %s, value = %s, interpolation = \"%s\"}" % ([round(v, 12) for v in t], [round(v, 12) for v in value], interpolation)


def half_sine(T):
    n = 64
    return course([T * i / n for i in range(n + 1)] + [2 * T], [math.sin(math.pi * i / n) for i in range(n + 1)] + [0])


class Scene:
    def __init__(self, name, deck, end, step, equilibrium=False):
        self.name, self.deck, self.end, self.step, self.equilibrium, self.text, self.regions = name, deck, end, step, equilibrium, "", []

    def beam(self, name, start, stop, side, E, n=6):
        self.deck.beam(name, start, stop, side, E, n)
        self.text += f'[region.{name}]\ndamping = {damping(E, math.dist(start, stop), side):.6g}\n'
        self.regions.append(name)

    def joint(self, kind, name, a, b, at, **more):
        self.text += table("joint", name, kind=kind, a=a, b=b, at=at, **more) + table("quantity", f"R {name}", kind="peak", joint=name)

    def sensor(self, on):
        self.text += table("sensor", "A", on=on) + table("quantity", "A", kind="peak", sensor="A", cfc=60)

    def write(self):
        start = 'start = "equilibrium"\n' if self.equilibrium else ""
        open("deck.inp", "w").write(self.deck.text())
        open("scene.toml", "w").write(f"gravity = [0, 0, -9.81]\n[time]\nend = {self.end:.9g}\nstep = {self.step:.9g}\n{start}" + self.text)


def chain(name, Es, F, Tp, end, step, equilibrium=False, axes=None, force=(1, 0, 0), length=1, side=0.05):
    """Hangs from the ground and is struck at its tip for Tp."""
    s = Scene(name, Deck(), end, step, equilibrium)
    for k, E in enumerate(Es):
        r, z = "abcdefgh"[k], -k * length
        s.beam(r, [0, 0, z], [0, 0, z - length], side, E)
        s.joint("revolute", f"j{k}", "ground" if k == 0 else "abcdefgh"[k - 1] + "1", r + "0", [0, 0, z], axis=axes[k] if axes else [0, 1, 0])
    s.text += table("load", "strike", kind="force", on=r + "1", force=[F * c for c in force], history=half_sine(Tp))
    s.sensor(r + "m")
    return s


def spun(name, Es, spin, end=0.4, step=5e-4, ramp=0.2, axes=None, length=1, side=0.05):
    """Along x; the first joint is brought to its spin."""
    s = Scene(name, Deck(), end, step)
    for k, E in enumerate(Es):
        r, x = "abcdefgh"[k], k * length
        s.beam(r, [x, 0, 0], [x + length, 0, 0], side, E)
        drive = dict(spin=spin, history=course([0, ramp], [0, 1], "smoother")) if k == 0 else {}
        s.joint("revolute", f"j{k}", "ground" if k == 0 else "abcdefgh"[k - 1] + "1", r + "0", [x, 0, 0],
                axis=axes[k] if axes else [0, 1, 0], **drive)
    s.sensor(r + "m")
    return s


def four_bar(name, Es, spin, ramp, end, step, side=0.02, crank=0.3, coupler=1.0, rocker=0.7, base=0.9):
    s = Scene(name, Deck(), end, step)
    d = math.hypot(base, crank)
    along = (coupler**2 - rocker**2 + d**2) / (2 * d)
    high = math.sqrt(coupler**2 - along**2)
    ex, ez = base / d, -crank / d
    P, Q, R = [0, 0, crank], [along * ex - high * ez, 0, crank + along * ez + high * ex], [base, 0, 0]
    s.beam("a", [0, 0, 0], P, side, Es[0])
    s.beam("b", P, Q, side, Es[1])
    s.beam("c", Q, R, side, Es[2])
    y = [0, 1, 0]
    s.joint("revolute", "crank", "ground", "a0", [0, 0, 0], axis=y, spin=spin, history=course([0, ramp], [0, 1], "smoother"))
    s.joint("revolute", "pin", "a1", "b0", P, axis=y)
    s.joint("spherical", "ball", "b1", "c0", Q)
    s.joint("cylindrical", "rocker", "ground", "c1", R, axis=y)
    s.sensor("bm")
    return s


def bonded(name, Es, spin, ramp, tip, end, step, side=0.05, length=0.6):
    """Segments that share nodes on a hub that turns, stays and stops; a mass at the tip."""
    s = Scene(name, Deck(bonded=True), end, step)
    for k, E in enumerate(Es):
        s.beam("abcdefgh"[k], [k * length, 0, 0], [(k + 1) * length, 0, 0], side, E, 4)
    last, x = s.regions[-1], len(Es) * length
    s.joint("revolute", "hub", "ground", "a0", [0, 0, 0], axis=[0, 1, 0], spin=spin,
            history=course([0, ramp, 2 * ramp, 3 * ramp], [0, 1, 1, 0], "smoother"))
    s.text += table("body", "tip", mass=tip, com=[x, 0, 0], inertia=[tip * 0.01] * 3)
    s.joint("fixed", "weld", last + "1", "tip", [x, 0, 0])
    s.sensor(last + "m")
    return s


PUBLISHED = {
    "c1": lambda n: chain(n, [2e11] * 3, 2000, 0.1, 0.3, 5e-4),
    "c2": lambda n: chain(n, [2e10] * 3, 1000, 0.1, 0.3, 5e-4),
    "c3": lambda n: chain(n, [2e9] * 3, 300, 0.1, 0.4, 1e-3),
    "c4": lambda n: chain(n, [2e8] * 3, 40, 0.1, 0.5, 1e-3),
    "c5": lambda n: chain(n, [2e11] * 3, 10000, 0.004, 0.1, 1e-4),
    "c6": lambda n: chain(n, [2e10] * 3, 5000, 0.004, 0.15, 2e-4),
    "c7": lambda n: chain(n, [2e9] * 3, 1000, 0.004, 0.2, 2.5e-4),
    "c8": lambda n: chain(n, [2e11, 2e9, 2e10], 300, 0.1, 0.3, 5e-4),
    "c9": lambda n: chain(n, [2e9, 2e11, 2e10], 2000, 0.01, 0.2, 2.5e-4),
    "s1": lambda n: spun(n, [2e11] * 3, 10),
    "s2": lambda n: spun(n, [2e9] * 3, 6),
    "s3": lambda n: spun(n, [2e10, 2e9, 2e11], 15),
    "f1": lambda n: four_bar(n, [2e11] * 3, 40, 0.1, 0.4, 5e-4),
    "f2": lambda n: four_bar(n, [2e11, 2e10, 2e11], 30, 0.1, 0.4, 5e-4),
    "f3": lambda n: four_bar(n, [2e11, 2e9, 2e11], 12, 0.2, 0.6, 1e-3),
    "f4": lambda n: four_bar(n, [2e11, 2e11, 2e10], 80, 0.1, 0.3, 2.5e-4),
    "f5": lambda n: four_bar(n, [2e9] * 3, 10, 0.2, 0.6, 1e-3),
    "w1": lambda n: bonded(n, [2e11] * 3, 4, 0.1, 20, 0.5, 1e-3),
    "w2": lambda n: bonded(n, [2e11, 2e10, 2e10], 4, 0.1, 20, 0.5, 1e-3),
    "w3": lambda n: bonded(n, [2e10] * 3, 3, 0.02, 5, 0.3, 5e-4),
    "e1": lambda n: chain(n, [2e10] * 3, 1000, 0.1, 0.3, 5e-4, True),
    "e2": lambda n: chain(n, [2e9] * 3, 300, 0.1, 0.4, 1e-3, True),
    "e3": lambda n: chain(n, [2e8] * 3, 40, 0.1, 0.5, 1e-3, True),
    "e4": lambda n: chain(n, [2e10] * 3, 5000, 0.004, 0.12, 2e-4, True),
    "e5": lambda n: chain(n, [2e9] * 3, 1000, 0.004, 0.15, 2.5e-4, True),
    "e6": lambda n: chain(n, [2e11, 2e9, 2e10], 300, 0.1, 0.3, 5e-4, True),
}


def drawn(seed):
    """A scene at random: three to six beams, in a plane or in space, stiff to soft, loads slow and fast."""
    r = random.Random(seed)
    kind = r.choice(["chain", "chain", "spun", "four_bar", "bonded"])
    n = 3 if kind == "four_bar" else r.choice([3, 3, 4, 5, 6] if kind == "chain" else [2, 3, 4])
    Es = [10 ** r.uniform(9.5, 11.3) if r.random() < 0.5 else 2e11 for _ in range(n)]
    axes = None
    if r.random() < 0.8 and kind in ("chain", "spun"):
        axes = [[0, 1, 0]] + [r.choice([[0, 1, 0], [1, 0, 0] if kind == "chain" else [0, 0, 1]]) for _ in range(n - 1)]
    if kind == "chain":
        Tp = 10 ** r.uniform(-2, -0.5)
        soft = min(Es)
        F = 2000 * math.sqrt(soft / 2e11) * r.uniform(0.3, 1)
        force = [1, 0, 0] if axes is None else [0.8, 0.6, 0]
        return chain(f"r{seed}", Es, F, Tp, max(0.1, 2 * Tp), min(5e-4, Tp / 60), r.random() < 0.5, axes, force, r.uniform(0.4, 1), 0.05)
    if kind == "spun":
        return spun(f"r{seed}", Es, r.uniform(2, 12), 0.4, 5e-4, r.uniform(0.1, 0.3), axes, r.uniform(0.4, 1))
    if kind == "four_bar":
        return four_bar(f"r{seed}", Es, r.uniform(5, 30), r.uniform(0.1, 0.3), 0.4, 5e-4, r.uniform(0.02, 0.05))
    return bonded(f"r{seed}", Es, r.uniform(1, 4), r.uniform(0.03, 0.12), r.uniform(1, 20), 0.4, 5e-4)


class Judge:
    def __init__(self, tools, tolerance, is_every, options):
        self.tools, self.tolerance, self.is_every, self.options = os.path.abspath(tools), tolerance, is_every, options

    def call(self, tool, *more, limit=3000):
        return subprocess.run([os.path.join(self.tools, tool), "--quiet", *more], capture_output=True, text=True, timeout=limit)

    def cells(self, s, part):
        """All regions nonlinear at this part of the step; None where that does not run."""
        name = "truth" if part == 0.5 else f"cells-{part:g}"
        if not os.path.exists(name + ".json"):
            done = self.call("hilo-tag", "mesh.h5", "--rest", "nonlinear", "-o", "truth-tags.h5")
            assert done.returncode == 0, done.stderr
            self.call("hilo-solve", "scene.toml", "truth-tags.h5", "--set", f"time.step={s.step * part:.9g}", "--set", 'time.error_estimate="never"', "-o", name + ".h5")
        run = json.load(open(name + ".json")) if os.path.exists(name + ".json") else {}
        return run if run.get("complete") else None

    def is_right(self, s):
        """Of a refusal: do all cells do no better with this step, 4/3 of what half of it changes being above 0.6 of the tolerance?"""
        runs = [self.cells(s, part) for part in (1, 0.5)]
        if None in runs:
            return True, "all cells do not run"
        whole, half = ([q["value"] for q in run["quantities"]] for run in runs)
        step = max(4 / 3 * abs(b / a - 1) / self.part() for a, b in zip(half, whole))
        return step > 0.6, f"the step makes {step:.2f} of the tolerance with all cells"

    def every(self, s, chosen):
        """Models of each region rigid, linear or nonlinear, with no more regions nonlinear than the chosen one has."""
        for levels in itertools.product(("rigid", "linear", "nonlinear"), repeat=len(s.regions)):
            if levels.count("nonlinear") > sum(r["level"] == "nonlinear" for r in chosen["regions"]):
                continue
            name = "every-" + "".join(level[0] for level in levels)
            if not os.path.exists(name + ".json"):
                rules = [word for r, level in zip(s.regions, levels) for word in ("--" + level, r)]
                done = self.call("hilo-tag", "mesh.h5", *rules, "-o", "every-tags.h5")
                assert done.returncode == 0, done.stderr
                self.call("hilo-solve", "scene.toml", "every-tags.h5", "--modes", "advise.work/modes", "-o", name + ".h5")
            if os.path.exists(name + ".json"):
                yield json.load(open(name + ".json"))["processor_seconds"], name + ".h5"

    def part(self):
        return float(self.tolerance.strip("%")) / 100

    def judged(self, s):
        """What became of a scene: its row, and what is summed."""
        s.write()
        if not os.path.exists("mesh.h5"):
            done = self.call("hilo-import", "deck.inp", "-o", "mesh.h5")
            assert done.returncode == 0, done.stderr
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = self.call("hilo-advise", "scene.toml", "mesh.h5", "--tol", self.tolerance, "--json", *self.options)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode != 0:
            right, why = self.is_right(s)
            said = done.stderr.strip().splitlines()[-1].removeprefix("hilo-advise: ")[:150]
            return {"right": right, "row": f"refused{'' if right else ' WRONGLY'}: {said}; {why}"}
        advice = json.loads(done.stdout)
        truth = self.cells(s, 0.5)
        if truth is None:
            return {"right": True, "row": "no truth: all nonlinear at half the step does not run"}
        want = {q["quantity"]: q["value"] for q in truth["quantities"]}
        full = truth["processor_seconds"] / 2
        spent = max(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, advice["spent_seconds"])  # runs may be kept

        def error(path):
            run = json.load(open(path.replace(".h5", ".json")))
            if not run["complete"]:
                return math.inf  # ended early
            got = {q["quantity"]: q["value"] for q in run["quantities"]}
            return max(abs(got[q] / want[q] - 1) for q in want) / self.part()

        models = [(m["s"], error(m["run"]), m) for m in advice["models"] if m["s"] is not None and "twice the step" not in m["model"]]
        chosen = next(row for row in models if "chosen" in row[2]["choice"])
        rigid = next((e for c, e, m in models if m["model"] == "all rigid"), math.nan)
        linear = next((e for c, e, m in models if m["model"] in ("linear all", "linear " + ", ".join(s.regions))), math.nan)
        true = [c for c, e, m in models if e <= 1]
        if self.is_every and len(s.regions) <= 3:
            true += [c for c, run in self.every(s, advice) if error(run) <= 1]
        out = {"error": chosen[1], "over_best": chosen[0] / min(true, default=math.nan), "share": chosen[0] / full,
               "advice": spent / full, "total": []}
        # the signed sum of the budget, to half the step, against what is true of the quantity that is off most
        for q in advice["quantities"]:
            told = sum(q[k] or 0 for k in ("levels", "linear strains", "modes")) + 0.75 * q["step"]
            true = q["value"] - want[q["quantity"]]
            out["total"].append([x / want[q["quantity"]] / self.part() for x in (true, told, q["in doubt"])])
        true, told, _ = max(out["total"], key=lambda parts: abs(parts[0]))
        out["row"] = (f"{out['error']:7.2f} {rigid:8.2f} {linear:7.2f}   {out['over_best']:5.2f} {out['share']:6.3f} {out['advice']:6.2f}"
                      f" {true:6.2f} {told:6.2f} {'checked' if advice['checked'] else '       '}  {chosen[2]['model']}")
        return out


def sums(rows):
    """The lines of what was set out to be reached."""
    answered = [r for r in rows if "error" in r]
    refused = [r for r in rows if "error" not in r]

    def share(what, good, of):
        return f"{what}: {sum(map(good, of))} of {len(of)}" + (f" ({100 * sum(map(good, of)) / len(of):.0f} %)" if of else "")

    costs = [r["advice"] for r in answered] or [math.nan]
    print(f"answered {len(answered)} of {len(rows)}, refused {len(refused)}, of these wrongly {sum(not r['right'] for r in refused)}")
    print(share("within the tolerance", lambda r: r["error"] <= 1, answered), f"largest {max([r['error'] for r in answered], default=0):.2f}")
    print(share("at most 1.5 times the cheapest true one", lambda r: r["over_best"] <= 1.5, answered),
          share("; other than all cells", lambda r: r["share"] < 0.7, answered))
    print(f"advice in runs of all cells: median {statistics.median(costs):.2f}, mean {statistics.mean(costs):.2f}, most {max(costs):.2f}")
    worst = [max(r["total"], key=lambda parts: abs(parts[0])) for r in answered]
    every = [parts for r in answered for parts in r["total"]]

    def meets(true, told, doubt):  # what is in doubt has no sign: it may be the rest
        low, high = sorted((0.8 * true, 1.25 * true))
        return told + abs(doubt) >= low and told - abs(doubt) <= high

    for what, of in (("the worst quantity of a scene", worst), ("all", every)):
        for least in (0, 0.1):
            of = [parts for parts in of if abs(parts[0]) > least]
            words = f"budget over true total within .8 to 1.25, {what}, true total at least {least} of the tolerance"
            print(share(words, lambda parts: meets(*parts), of), share("; by its signed parts alone", lambda parts: meets(*parts[:2], 0), of))
    print(share("budget off by at most a tenth of the tolerance, all", lambda parts: abs(parts[1] - parts[0]) <= 0.1, every))


def names(words):
    for w in words:
        if w == "all26":
            yield from PUBLISHED
        elif w in PUBLISHED:
            yield w
        else:
            low, _, high = w.partition("-")
            yield from range(int(low), int(high or low) + 1)


def main():
    mine, _, theirs = (sys.argv[1:], 0, []) if "--" not in sys.argv else (sys.argv[1 : sys.argv.index("--")], 0, sys.argv[sys.argv.index("--") + 1 :])
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin")
    parser.add_argument("folder")
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--tol", default="2%")
    parser.add_argument("--every", action="store_true", help="of three regions: the cheapest of all models, not only of those it ran")
    parser.add_argument("--kept", action="store_true", help="take what earlier calls found in the folder")
    o = parser.parse_args(mine)
    judge = Judge(o.bin, o.tol, o.every, theirs)
    top = os.path.abspath(o.folder)
    print("scene n   chosen    rigid  linear   /best   /all advice   true   told         choice", flush=True)
    rows = []
    for name in names(o.scenes):
        s = PUBLISHED[name](name) if name in PUBLISHED else drawn(name)
        os.makedirs(os.path.join(top, s.name), exist_ok=True)
        os.chdir(os.path.join(top, s.name))
        if not (o.kept and os.path.exists("judged.json")):
            judged = judge.judged(s)  # before the file is there
            json.dump(judged, open("judged.json", "w"))
        rows.append(json.load(open("judged.json")))
        print(f"{s.name:5} {len(s.regions)}  {rows[-1]['row']}", flush=True)
    sums(rows)


if __name__ == "__main__":
    main()
