#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nastran decks of one subcase that are made up here, in small, large and free fields, with continuations, coordinate systems, INCLUDE and
sets of loads and supports, read once more by the few lines below: places, volumes, masses, supports, forces, moments and pressures that
hilo-import has are those of the deck, or it says which kind of thing it left out.
Usage: nothing_lost_bdf.py REPO BIN [SEED...]"""
import collections
import json
import math
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import tomllib

import h5py
import numpy as np

tools, wanted = pathlib.Path(sys.argv[2]).resolve(), [int(a) for a in sys.argv[3:]]
SEEDS = wanted or range(26)
SOLIDS = {"CTETRA": (4, 10), "CPENTA": (6, 15), "CHEXA": (8, 20)}


# ---- decks: a block of cells, and what acts on it, in a way of writing that each seed chooses anew

def real(x, width, r):
    """As many digits as the field has, in one of the ways that a real may be written."""
    for digits in range(16, -1, -1):
        whole, exponent = f"{x:.{digits}e}".split("e")
        if "." not in whole:
            whole += "."
        exponent = int(exponent)
        forms = [f"{whole}{exponent:+d}", f"{whole}{r.choice('eEdD')}{exponent:+d}"]
        plain = f"{float(f'{x:.{digits}e}'):.{max(0, digits - exponent)}f}" if -4 < exponent < width else ""
        forms += [plain if "." in plain else plain + "."] if plain else []
        forms = [f for f in forms if len(f) <= width]
        if forms:
            return r.choice(forms)
    raise ValueError(x)


class Writer:
    def __init__(self, r):
        self.r, self.lines, self.n = r, [], 0
        self.style = r.choice(["small", "large", "free", "mixed"])

    def card(self, name, *fields):
        r = self.r
        style = self.style if self.style != "mixed" else r.choice(["small", "large", "free"])
        width = {"small": 8, "large": 16, "free": 16}[style]
        text = [real(f, width, r) if isinstance(f, float) else "" if f is None else str(f) for f in fields]
        while text and not text[-1]:
            text.pop()
        if r.random() < 0.1:
            name = name.lower()
        if r.random() < 0.05:
            self.lines += ["$ a comment, with = signs", ""]
        if style == "free":
            rows = [text[i:i + 8] for i in range(0, len(text), 8)]
            for i, row in enumerate(rows):
                tail, head = "", r.choice(["", "+"])
                if i + 1 < len(rows) and r.random() < 0.3:
                    row = row + [""] * (8 - len(row))
                    tail = f",+{self.n}"
                if i > 0 and label:
                    head = label
                label = tail[1:]
                self.lines.append((name if i == 0 else head) + "," + ",".join(row) + tail)
                self.n += bool(tail)
            return
        per, w, star = (8, 8, "") if style == "small" else (4, 16, "*")
        if style == "large":
            text += [""] * (-len(text) % 8)  # a large line is half of a small one
        rows = [text[i:i + per] for i in range(0, len(text), per)]
        label = ""
        for i, row in enumerate(rows):
            first = (name + star) if i == 0 else label if label else (star or r.choice(["", "+"]))
            line = first.ljust(8) + "".join(r.choice([str.ljust, str.rjust])(f, w) for f in row)
            label = ""
            if i + 1 < len(rows) and r.random() < 0.5:
                label = f"{star or '+'}C{self.n % 99999}"
                line, self.n = line.ljust(72) + label, self.n + 1
            self.lines.append(line.rstrip())


def make(seed, folder):
    r = random.Random(seed)
    w = Writer(r)
    n = [r.randint(1, 3) for _ in range(3)]
    size = 10 ** r.uniform(-2, 2)
    quadratic, kind = r.random() < 0.3, r.choice(["CHEXA", "CPENTA", "CTETRA"])
    ids = iter(r.sample(range(1, 9_999_999), 2000))
    # coordinate systems in a chain
    systems = [0]
    for i in range(r.randint(0, 4)):
        cid = r.randint(1, 9999) * 10 + i
        origin = np.array([r.uniform(-1, 1) for _ in range(3)])
        z, x = np.array([r.gauss(0, 1) for _ in range(3)]), np.array([r.gauss(0, 1) for _ in range(3)])
        if r.random() < 0.3:
            z, x = np.eye(3)[r.randrange(3)], None
            x = np.roll(z, 1)
        w.card("CORD2" + r.choice("RCS"), cid, r.choice([0, None]), *map(float, origin), *map(float, origin + z), *map(float, origin + x))
        systems.append(cid)
    known = Deck("\n".join(w.lines).splitlines())
    outputs = systems if r.random() < 0.3 else [0]  # of displacements
    grid, place = {}, {}

    def add_grid(key, X):
        if key in grid:
            return grid[key]
        g = grid[key] = next(ids)
        cp = r.choice(systems)
        held = None if key[0] == "frame" else r.choice(["123", "3", None, None, None, None, None, None, None])
        place[g] = X
        w.card("GRID", g, cp if cp or r.random() < 0.5 else None, *map(float, known.coordinates(cp, X)), r.choice(outputs) or None, held)
        return g

    bend = [r.uniform(-0.1, 0.1) for _ in range(3)]

    def at(i, j, k):
        return size * np.array([i + bend[0] * j * k / 4, j + bend[1] * i * k / 4, k * (1 + bend[2] * i * j / 9)])

    def middle(a, b):
        return add_grid((a, b) if a < b else (b, a), (at(*a) + at(*b)) / 2)

    if r.random() < 0.5:  # a system by three grids, which are those of no cell
        frame = [add_grid(("frame", k), size * np.array(x)) for k, x in enumerate(((5.0, 0, 0), (5.0, 0, 1.0), (6.0, 1.0, 0)))]
        w.card("CORD1R", 77, *frame)
        systems.append(77)
        known = Deck("\n".join(w.lines).splitlines())
    cells, element = [], 0
    EDGES = {"CTETRA": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
             "CPENTA": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 4), (2, 5), (3, 4), (4, 5), (5, 3)],
             "CHEXA": [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 5), (2, 6), (3, 7), (4, 5), (5, 6), (6, 7), (7, 4)]}
    properties = [r.randint(1, 999) * 10 + i for i in range(r.randint(1, 3))]
    for i in range(n[0]):
        for j in range(n[1]):
            for k in range(n[2]):
                c = [(i + a, j + b, k + d) for d in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
                parts = {"CHEXA": [range(8)], "CPENTA": [(0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)],
                         "CTETRA": [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]}[kind]
                pid = r.choice(properties)
                for part in parts:
                    corners = [c[p] for p in part]
                    nodes = [add_grid(p, at(*p)) for p in corners]
                    if quadratic:
                        nodes += [middle(corners[a], corners[b]) for a, b in EDGES[kind]]
                    element += r.randint(1, 5)
                    cells.append((element, corners))
                    w.card(kind, element, pid, *nodes)
    for i, pid in enumerate(properties):
        w.card("PSOLID", pid, 700 + i)
        w.card("MAT1", 700 + i, 10 ** r.uniform(6, 11), None, r.uniform(0, 0.4), r.choice([None, r.uniform(1, 9000)]))
    if r.random() < 0.2:
        w.card("PARAM", "WTMASS", 0.00259)
    # supports
    face = [grid[p] for p in grid if isinstance(p[0], int) and p[0] == 0]
    others = [grid[p] for p in grid if grid[p] not in face and p[0] != "frame"]
    w.card("SPC1", 11, r.choice(["123", "123456", "13", "2"]), *face)
    for g in r.sample(others, min(2, len(others))):
        w.card("SPC", 12, g, r.choice(["1", "23", "123"]), r.choice([None, 0.0, size * 1e-3]))
    low, high = sorted(r.sample(others, 2)) if len(others) > 1 else (1, 2)
    if high - low < 90_000_000 and r.random() < 0.5:
        w.card("SPC1", 13, 3, low, "THRU", high)
        w.card("SPCADD", 1, 11, 12, 13)
    else:
        w.card("SPCADD", 1, 11, 12)
    # loads
    sets = [21, 22, 23]
    for _ in range(r.randint(1, 6)):
        g, v = r.choice(others), np.array([r.gauss(0, 1) for _ in range(3)])
        w.card("FORCE", r.choice(sets), g, r.choice(systems) or None, r.uniform(-9, 9), *map(float, v))
    for _ in range(r.randint(0, 3)):
        e, corners = r.choice(cells)
        face = (loaded_face(kind, [grid[c] for c in corners], r) + (None,))[:2]
        way = [r.choice([s for s in systems if not known.systems or s == 0 or known.systems[s][0] == "R"]) or None, 1.0, r.gauss(0, 1), r.gauss(0, 1)]
        w.card("PLOAD4", r.choice(sets), e, r.uniform(-9, 9), None, None, None, *face, *(way if r.random() < 0.3 else []))
    if r.random() < 0.5:
        a, b = r.sample(others, 2) if len(others) > 1 else (others[0], face[0])
        w.card("FORCE1", r.choice(sets), r.choice(others), r.uniform(-9, 9), a, b)
    if r.random() < 0.4:
        w.card("GRAV", r.choice(sets), r.choice(systems[:1]), 9.81, 0.0, r.choice([-1.0, 1.0]), 0.0)
    if r.random() < 0.5:
        w.card("LOAD", 2, r.choice([1.0, 2.5]), 1.0, 21, -0.5, 22, r.choice([3.0, 1.0]), 23)
    else:
        w.card("LOAD", 2, 1.0, 1.0, r.choice(sets))
    # masses, and a hub that carries a face
    for i in range(r.randint(0, 3)):
        w.card("CONM2", 900 + i, r.choice(others), None, r.uniform(0.1, 9))
    if r.random() < 0.5:
        hub = add_grid("hub", size * np.array([-1.0, 0.5, 0.25]))
        w.card("RBE2", 990, hub, "123456", *[g for g in others if g in [grid[p] for p in grid if isinstance(p[0], int) and p[0] == n[0]]])
        if r.random() < 0.7:
            w.card("CONM2", 991, hub, None, r.uniform(0.1, 9), *([None] * 3 if r.random() < 0.5 else [0.1 * size, 0.0, -0.2 * size]), None,
                   2.0, None, 3.0, None, None, 4.0)
        w.card("FORCE", r.choice(sets), hub, None, 3.0, 0.0, 1.0, 0.5)
        w.card("MOMENT", r.choice(sets), hub, r.choice(systems) or None, 2.0, 1.0, 0.0, 0.5)
    head = ["SOL 101", "CEND", "TITLE = seed %d" % seed, "SPC = 1", "SUBCASE 1", "  LOAD = 2", "BEGIN BULK"]
    # parts of the deck in files of their own
    starts = [i for i, l in enumerate(w.lines) if l and l[0].isalpha()]
    cuts = sorted(r.sample(starts, min(len(starts), 2 * r.randint(0, 2))))
    out, at_line = [], 0
    for k, (a, b) in enumerate(zip(cuts[::2], cuts[1::2])):
        name = f"part_{seed}_{k}.inc"
        (folder / name).write_text("\n".join(w.lines[a:b]) + "\n")
        out += w.lines[at_line:a] + [r.choice([f"INCLUDE '{name}'", f"include \"{name}\"", f"INCLUDE {name}"])]
        at_line = b
    path = folder / f"deck_{seed}.{r.choice(['bdf', 'nas', 'dat'])}"
    path.write_text("\n".join(head + out + w.lines[at_line:] + ["ENDDATA"]) + "\n", newline=r.choice(["\n", "\r\n"]))
    return path


FACES = {4: [(0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 2, 1)], 6: [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
         8: [(0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7)]}  # of VTK, which mesh.h5 has


def loaded_face(kind, corners, r):
    """G1 and G3 or G4 of PLOAD4."""
    if kind == "CTETRA":
        a, off = r.sample(range(4), 2)
        return corners[a], corners[off]
    face = r.choice(FACES[len(corners)])
    a = r.randrange(len(face))
    return (corners[face[a]],) if len(face) == 3 else (corners[face[a]], corners[face[(a + 2) % 4]])


# ---- the other reading

def number(text):
    if not text:
        return 0.0
    text = text.upper().replace("D", "E")
    m = re.fullmatch(r"([+-]?[\d.]+)([+-]\d+)", text)
    return float(f"{m[1]}E{m[2]}" if m else text)


def whole(text):
    return int(text) if text else 0


def physical(path):
    for line in path.read_text().splitlines():
        m = re.match(r"\s*include\s+['\"]?([^'\"]+)['\"]?\s*$", line, re.I)
        yield from physical(path.parent / m[1].strip()) if m else [line]


def entries(lines):
    """(name, fields) with eight fields a line."""
    out = []
    for line in lines:
        line = line.split("$")[0].rstrip()
        if not line.strip():
            continue
        if "," in line:
            f = [p.strip() for p in line.split(",")]
            head, count = f[0], 4 if "*" in f[0] else 8
            fields = (f[1:count + 1] + [""] * count)[:count]
        else:
            head, step = line[:8].strip(), 16 if "*" in line[:8] else 8
            fields = [line[8 + k * step:8 + (k + 1) * step].strip() if 8 + k * step < 72 else "" for k in range(64 // step)]
        if head and head[0].isalpha():
            out.append((head.rstrip("*").upper(), fields))
        else:
            out[-1][1].extend(fields)
    return [(name, fields + [""] * 24) for name, fields in out]


class Deck:
    def __init__(self, lines):
        bulk = next((i + 1 for i, l in enumerate(lines) if l.strip().upper().startswith("BEGIN BULK")), 0)
        self.entries = [e for e in entries(lines[bulk:]) if e[0] != "ENDDATA"]
        self.systems, self.X, self.output, self.cells, self.material, self.density, self.wtmass = {}, {}, {}, {}, {}, {}, 1
        for name, f in self.entries:
            if name.startswith("CORD2"):
                self.system(whole(f[0]), name[5], np.array([number(v) for v in f[2:11]]).reshape(3, 3))
        grids = [f for name, f in self.entries if name == "GRID"]
        for last in (False, True):
            for f in grids:
                if (whole(f[1]) in self.systems or f[1] in ("", "0")) and whole(f[0]) not in self.X:
                    self.X[whole(f[0])] = self.point(whole(f[1]), [number(v) for v in f[2:5]])
                    self.output[whole(f[0])] = whole(f[5])
            for name, f in self.entries:
                if name.startswith("CORD1") and not last:
                    self.system(whole(f[0]), name[5], np.array([self.X[int(g)] for g in f[1:4]]))
        for name, f in self.entries:
            if name in SOLIDS:
                nodes = [int(v) for v in f[2:] if v]
                self.cells[whole(f[0])] = (whole(f[1]), nodes, SOLIDS[name][0])
            elif name == "PSOLID":
                self.material[whole(f[0])] = whole(f[1])
            elif name == "MAT1":
                self.density[whole(f[0])] = number(f[4])
            elif name == "PARAM" and f[0] == "WTMASS":
                self.wtmass = number(f[1])
        self.used = {g for _, nodes, _ in self.cells.values() for g in nodes}

    def system(self, cid, kind, p):
        z = (p[1] - p[0]) / np.linalg.norm(p[1] - p[0])
        y = np.cross(z, p[2] - p[0])
        y /= np.linalg.norm(y)
        self.systems[cid] = (kind, p[0], np.array([np.cross(y, z), y, z]).T)

    def point(self, cid, x):
        if cid == 0:
            return np.array(x)
        kind, origin, axes = self.systems[cid]
        if kind == "C":
            x = [x[0] * math.cos(math.radians(x[1])), x[0] * math.sin(math.radians(x[1])), x[2]]
        elif kind == "S":
            t, p = math.radians(x[1]), math.radians(x[2])
            x = [x[0] * math.sin(t) * math.cos(p), x[0] * math.sin(t) * math.sin(p), x[0] * math.cos(t)]
        return origin + axes @ np.array(x)

    def coordinates(self, cid, X):
        if cid == 0:
            return X
        kind, origin, axes = self.systems[cid]
        x = axes.T @ (X - origin)
        if kind == "C":
            x = [math.hypot(x[0], x[1]), math.degrees(math.atan2(x[1], x[0])), x[2]]
        elif kind == "S":
            x = [np.linalg.norm(x), math.degrees(math.atan2(math.hypot(x[0], x[1]), x[2])), math.degrees(math.atan2(x[1], x[0]))]
        return x

    def axes(self, cid, X):
        """Of a system at a point, as columns: where its coordinates grow."""
        if cid == 0:
            return np.eye(3)
        kind, origin, axes = self.systems[cid]
        if kind == "R":
            return axes
        c, step, out = self.coordinates(cid, X), 1e-6, []
        for k in range(3):
            d = np.zeros(3)
            d[k] = step * (1 if k == 0 or (kind == "C" and k == 2) else 57)
            v = self.point(cid, c + d) - self.point(cid, np.array(c) - d)
            out.append(v / np.linalg.norm(v))
        return np.array(out).T

    def volume(self, nodes, corners):
        X = np.array([self.X[g] for g in nodes[:corners]])
        V = 0.0
        for face in FACES[corners]:  # divergence of x, on bilinear faces
            P = X[list(face)]
            if len(face) == 3:
                V += P[0] @ np.cross(P[1] - P[0], P[2] - P[0]) / 6
            else:
                for s in (0.5 - math.sqrt(1 / 12), 0.5 + math.sqrt(1 / 12)):
                    for t in (0.5 - math.sqrt(1 / 12), 0.5 + math.sqrt(1 / 12)):
                        N = np.array([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t])
                        a = np.array([t - 1, 1 - t, t, -t]) @ P
                        b = np.array([s - 1, -s, s, 1 - s]) @ P
                        V += (N @ P) @ np.cross(a, b) / 12
        return abs(V)


def listed(fields, there):
    out, i = [], 0
    while i < len(fields):
        if fields[i].upper() == "THRU":
            out += [g for g in range(out[-1] + 1, int(fields[i + 1]) + 1) if g in there]
            i += 1
        elif fields[i]:
            out.append(int(fields[i]))
        i += 1
    return out


class Acts:
    """What acts: supports by node and axis (of the model, or any), forces by node or body, moments by body, pressures by corners, gravity, masses by node or body."""

    def __init__(self):
        self.askew = []  # supports along other axes: node, axis
        self.held, self.pressure, self.gravity, self.carried = {}, collections.Counter(), np.zeros(3), {}
        self.force, self.moment, self.traction = (collections.defaultdict(lambda: np.zeros(3)) for _ in range(3))
        self.mass, self.com = collections.Counter(), {}


def read_deck(d):
    a = Acts()
    by = collections.defaultdict(list)
    for name, f in d.entries:
        by[name].append(f)
    bodies = {whole(f[1]) for f in by["RBE2"]}
    sets = listed(by["SPCADD"][0][1:], ())
    skew = set()

    def hold(g, components, value):
        own = d.axes(d.output[g], d.X[g])
        for c in components:
            k = int(c) - 1
            if k < 3:
                a.held[g, k] = (own[:, k], value)

    for g in d.X:
        f = next(f for f in by["GRID"] if whole(f[0]) == g)
        hold(g, f[6], 0.0)
    for name, f in d.entries:
        if name == "SPC1" and whole(f[0]) in sets:
            for g in listed(f[2:], d.X):
                hold(g, f[1], 0.0)
        elif name == "SPC" and whole(f[0]) in sets:
            hold(whole(f[1]), f[2], number(f[3]))
    total = by["LOAD"][0]
    factors = collections.Counter()
    for i in range(2, 12, 2):
        if total[i + 1]:
            factors[int(total[i + 1])] += number(total[1]) * number(total[i])
    for name, f in d.entries:
        s = factors.get(whole(f[0]), 0) if f[0].isdigit() else 0
        if name in ("FORCE", "MOMENT") and s:
            g = whole(f[1])
            v = s * number(f[3]) * (d.axes(whole(f[2]), d.X[g]) @ [number(x) for x in f[4:7]])
            (a.force if name == "FORCE" else a.moment)[g] += v
        elif name == "FORCE1" and s:
            way = d.X[whole(f[4])] - d.X[whole(f[3])]
            a.force[whole(f[1])] += s * number(f[2]) * way / np.linalg.norm(way)
        elif name == "GRAV" and s:
            a.gravity += s * number(f[2]) * np.array([number(x) for x in f[3:6]])
        elif name == "PLOAD4" and s:
            _, nodes, n = d.cells[whole(f[1])]
            one, other = whole(f[6]), whole(f[7])
            for face in FACES[n]:
                corners = [nodes[i] for i in face]
                if one not in corners:
                    continue
                if n == 4 and other in corners or n != 4 and len(face) == 3 and other or n != 4 and len(face) == 4 and other not in corners:
                    continue
                way = np.array([number(x) for x in f[9:12]])
                if way.any():
                    a.traction[frozenset(corners)] += s * number(f[2]) * (d.axes(whole(f[8]), np.zeros(3)) @ way) / np.linalg.norm(way)
                else:
                    a.pressure[frozenset(corners)] += s * number(f[2])
        elif name == "CONM2":
            g, m = whole(f[1]), number(f[3]) * d.wtmass
            a.mass[g] += m
            if g in bodies:
                a.com[g] = d.X[g] + np.array([number(x) for x in f[4:7]])
        elif name == "RBE2":
            a.carried[whole(f[1])] = set(listed(f[3:], d.X)) & d.used
    return a, bodies


def read_scene(scene, mesh):
    a = Acts()
    ids, cells = mesh["mesh/nodes/id"][...], mesh["mesh/cells/nodes"][...]
    offset = mesh["mesh/cells/offset"][...]
    sets = {k: ids[v[...]] for k, v in mesh.get("mesh/sets/nodes", {}).items()}
    facets = mesh.get("mesh/sets/facets", {})
    grid = lambda name: int(name.removeprefix("grid_"))
    for m in scene.get("motion", []):
        for i in sets.get(m["on"], [grid(m["on"])] if m["on"].startswith("grid_") else []):
            for c in m.get("components", ["x", "y", "z"]):
                a.held[int(i), "xyz".index(c)] = (np.eye(3)["xyz".index(c)], m.get("displacement", [0, 0, 0])["xyz".index(c)])
    for load in scene.get("load", []):
        if load["kind"] in ("force", "torque"):
            of, v = (a.force, load["force"]) if load["kind"] == "force" else (a.moment, load["torque"])
            for i in sets.get(load["on"], [grid(load["on"])] if load["on"].startswith("grid_") else []):
                of[int(i)] += v
        elif load["kind"] in ("pressure", "traction"):
            for cell, facet in facets[load["on"]][...]:
                nodes = ids[cells[offset[cell]:offset[cell + 1]]]
                n = {4: 4, 10: 4, 6: 6, 15: 6, 8: 8, 20: 8}[len(nodes)]
                corners = frozenset(int(nodes[k]) for k in FACES[n][facet])
                if load["kind"] == "pressure":
                    a.pressure[corners] += load["pressure"]
                else:
                    a.traction[corners] += load["traction"]
    a.gravity = np.array(scene.get("gravity", [0, 0, 0]), float)
    for m in scene.get("point_mass", []):
        for i in sets[m["on"]]:
            a.mass[int(i)] += m["mass"]
    for b in scene.get("body", []):
        if b["name"].startswith("grid_") and b["name"][5:].isdigit():
            a.mass[grid(b["name"])] += b["mass"]
            a.com[grid(b["name"])] = np.array(b["com"])
    for j in scene.get("joint", []):
        if j["kind"] == "in-plane" and "a" not in j:
            for i in sets[j["b"]]:
                a.askew.append((int(i), np.array(j["axis"])))
        ends = [j.get("a", ""), j.get("b", "")]
        for one, other in (ends, ends[::-1]):
            if one.startswith("grid_") and one[5:].isdigit() and other in sets:
                a.carried.setdefault(grid(one), set()).update(int(i) for i in sets[other])
    return a


def near(x, y, size):
    return np.abs(np.asarray(x) - np.asarray(y)).max() <= 1e-6 * size + 1e-30


def judge(d, scene, mesh, said):
    faults, lost = [], {n["loss"] for n in said["not_read"] if not n["output"]}
    size = max(np.abs(x).max() for x in d.X.values())
    ids, X = mesh["mesh/nodes/id"][...], mesh["mesh/nodes/X"][...]
    if set(map(int, ids)) != d.used:
        faults.append(f"{len(ids)} nodes, of the deck {len(d.used)}")
    else:
        off = [int(i) for i, x in zip(ids, X) if np.abs(x - d.X[int(i)]).max() > 1e-9 * size]
        if off:
            faults.append(f"{len(off)} nodes are elsewhere: {off[:3]}")
    names = [n.decode() if isinstance(n, bytes) else n for n in mesh["mesh/regions/name"][...]]
    density = dict(zip(names, np.nan_to_num(mesh["mesh/regions/density"][...])))
    for pid in {p for p, _, _ in d.cells.values()}:
        V = sum(d.volume(nodes, n) for p, nodes, n in d.cells.values() if p == pid)
        its = sum(r["volume"] for r in said["regions"] if r["name"] == f"pid_{pid}")
        if abs(V - its) > (1e-4 if any(len(nodes) > n for _, nodes, n in d.cells.values()) else 1e-6) * V:  # nodes on edges are rounded
            faults.append(f"volume {its} of property {pid}, of the deck {V}")
        rho = d.density[d.material[pid]] * d.wtmass
        if abs(rho - density.get(f"pid_{pid}", -1)) > 1e-9 * rho:
            faults.append(f"density {density.get(f'pid_{pid}')} of property {pid}, of the deck {rho}")
    deck, bodies = read_deck(d)
    has = read_scene(scene, mesh)
    for (g, k), (axis, value) in deck.held.items():
        if g in bodies or g not in d.used:
            continue
        whole_node = all((g, c) in deck.held and deck.held[g, c][1] == 0 for c in range(3))
        along = int(np.argmax(np.abs(axis)))
        if whole_node:
            ok = all((g, c) in has.held and has.held[g, c][1] == 0 for c in range(3))
        else:
            ok = abs(axis[along]) > 1 - 1e-6 and (g, along) in has.held and near(has.held[g, along][1], value * np.sign(axis[along]), size)
            ok = ok or ("support" in lost if value else any(i == g and near(abs(x @ axis), 1, 1) for i, x in has.askew))
        if not ok:
            faults.append(f"the support of grid {g} in {k + 1} is missing")
    for g, k in [*has.held, *has.askew]:
        if not any((g, c) in deck.held for c in range(3)):
            faults.append(f"a support of grid {g}, which the deck does not hold")
    if "load" not in lost:
        for what, ours, theirs in (("force", deck.force, has.force), ("moment", deck.moment, has.moment), ("traction", deck.traction, has.traction)):
            big = max([1e-300] + [np.abs(v).max() for v in ours.values()])
            off = [g for g in set(ours) | set(theirs) if not near(ours.get(g, np.zeros(3)), theirs.get(g, np.zeros(3)), big)]
            if off:
                faults.append(f"the {what} of {len(off)} grids or faces differs: {off[:3]}")
        off = [f for f in set(deck.pressure) | set(has.pressure) if not near(deck.pressure[f], has.pressure[f], 10)]
        if off:
            faults.append(f"pressures of {len(off)} faces differ: {sorted(off[0])}")
        if not near(deck.gravity, has.gravity, max(1e-300, np.abs(deck.gravity).max())):
            faults.append(f"gravity {has.gravity}, of the deck {deck.gravity}")
    for g in set(deck.mass) | set(has.mass):
        if not near(deck.mass[g], has.mass[g], 9):
            faults.append(f"mass {has.mass[g]} of grid {g}, of the deck {deck.mass[g]}")
    for g, x in deck.com.items():
        if g not in has.com or not near(x, has.com[g], size):
            faults.append(f"centre {has.com.get(g)} of body {g}, of the deck {x}")
    for g, of in deck.carried.items():
        if has.carried.get(g) != of:
            faults.append(f"grid {g} carries {has.carried.get(g)}, of the deck {of}")
    return faults


def spoil(d, seed):
    """One field of one entry is another: what the judge must see."""
    r = random.Random(seed)
    fields = {"FORCE": (3, "77."), "PLOAD4": (2, "77."), "GRAV": (2, "77."), "CONM2": (3, "77."), "MOMENT": (3, "77."), "GRID": (2, "0.7"), "SPC": (3, "77."), "MAT1": (4, "77.")}
    sets = [e for e in d.entries if e[0] == "LOAD"][0][1]
    chosen = {sets[i] for i in range(3, 12, 2)}
    of_bodies = {f[1] for name, f in d.entries if name == "RBE2"}
    used_materials = {str(m) for m in d.material.values()}
    possible = [i for i, (name, f) in enumerate(d.entries) if name in fields and (name in ("CONM2", "SPC", "MAT1", "GRID") or f[0] in chosen)
                and not (name == "GRID" and int(f[0]) not in d.used) and not (name == "MAT1" and all(d.material[p] != int(f[0]) for p, _, _ in d.cells.values()))
                and not (name == "SPC" and (d.output[int(f[1])] or len(f[2]) != 1))]
    name, f = d.entries[r.choice(possible)]
    at, value = fields[name]
    f[at] = value
    lines = [f"{n}," + ",".join(v[:8]) + "".join("\n," + ",".join(v[i:i + 8]) for i in range(8, len(v), 8)) for n, v in d.entries]
    return Deck("\n".join(lines).splitlines()), name


counts, kinds, faults = collections.Counter(), collections.Counter(), []
with tempfile.TemporaryDirectory() as work:
    work = pathlib.Path(work)
    for seed in SEEDS:
        path = make(seed, work)
        ran = subprocess.run([tools / "hilo-import", path.name, "-o", "m.h5", "--scene-out", "s.toml", "--json"], cwd=work, capture_output=True, text=True)
        if ran.returncode:
            faults.append(f"{path.name}: {ran.stderr.strip()}")
            continue
        said = json.loads(ran.stdout)
        deck = Deck(list(physical(path)))
        scene = tomllib.loads((work / "s.toml").read_text())
        with h5py.File(work / "m.h5") as mesh:
            found = judge(deck, scene, mesh, said)
            spoiled, what = spoil(Deck(list(physical(path))), seed)
            if not judge(spoiled, scene, mesh, said) and not {n["loss"] for n in said["not_read"]} & {"load", "support"}:
                found.append(f"another {what} in the deck is not seen")
        told = [n for n in said["not_read"] if n["loss"]]
        for n in told:
            kinds[re.sub(r"[\d.]+", "N", n["what"])] += 1
        counts["compared, something told as left out" if told else "compared, whole"] += 1
        faults += [f"{path.name}: {f}" for f in found]
        if wanted:
            print(path.read_text() if faults else "", *[f"{n['what']} {n['place']}" for n in told], sep="\n")
print("\n".join(faults + [f"{n} decks: {what}" for what, n in sorted(counts.items())] + [f"{n} decks: told {what}" for what, n in sorted(kinds.items())]))
sys.exit(1 if faults or (not wanted and counts["compared, whole"] < 15) else 0)
