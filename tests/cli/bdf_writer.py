# SPDX-License-Identifier: GPL-3.0-or-later
"""Nastran decks that are made up: a block of cells, and what acts on it, in a way of writing that each seed chooses anew."""
import random

import numpy as np

from bdf_reader import FACES, Deck


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


def loaded_face(kind, corners, r):
    """G1 and G3 or G4 of PLOAD4."""
    if kind == "CTETRA":
        a, off = r.sample(range(4), 2)
        return corners[a], corners[off]
    face = r.choice(FACES[len(corners)])
    a = r.randrange(len(face))
    return (corners[face[a]],) if len(face) == 3 else (corners[face[a]], corners[face[(a + 2) % 4]])
