# SPDX-License-Identifier: GPL-3.0-or-later
"""Nastran bulk data read by a few lines that share nothing with hilo-import: entries in small, large and free fields, coordinate systems, grids,
solids and their volumes."""
import math
import re

import numpy as np

SOLIDS = {"CTETRA": (4, 10), "CPENTA": (6, 15), "CHEXA": (8, 20)}
FACES = {4: [(0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 2, 1)], 6: [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
         8: [(0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7)]}  # of VTK, which mesh.h5 has


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
