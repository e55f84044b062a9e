#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every deck of calculix-ccx-test with one step, read once more by the few lines below: volume, mass, supports, forces and pressures that
hilo-import has are those of the deck, or it says which kind of thing it left out.
Usage: nothing_lost.py REPO BIN [DECK...]"""
import collections
import json
import pathlib
import subprocess
import sys
import tempfile
import tomllib

import h5py
import numpy as np

import calculix

repo, tools, wanted = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), sys.argv[3:]
calculix.tools(need_ccx=False)
MISREAD = {"scheibejc"}  # a keyword line ends with a comma, and its data follow
NODES = {"C3D4": 4, "C3D6": 6, "C3D8": 8, "C3D8R": 8, "C3D8I": 8, "C3D10": 10, "C3D10T": 10, "C3D15": 15, "C3D20": 20, "C3D20R": 20, "C3D20RI": 20}
BESIDE = {"SPRINGA": 2, "SPRING1": 1, "SPRING2": 2, "DASHPOTA": 2, "MASS": 1, "DCOUP3D": 1}
NAMED = {"ENCASTRE": (1, 2, 3), "PINNED": (1, 2, 3), "XSYMM": (1,), "YSYMM": (2,), "ZSYMM": (3,)}


def cards(path):
    """(keyword, parameters, lines of fields, step) of a deck; keywords and names in capitals, without blanks."""
    out, step, key = [], 0, ""
    for line in path.read_text(errors="replace").splitlines():
        line = line.strip()
        if not line or line.startswith("**"):
            continue
        if line.startswith("*") or key.endswith(","):
            key += line.upper().replace(" ", "")
            if key.endswith(","):
                continue
            words = key[1:].split(",")
            step += words[0] == "STEP"
            out.append((words[0], dict((w.split("=", 1) + [""])[:2] for w in words[1:] if w), [], step))
            key = ""
        elif out:
            out[-1][2].append([f.strip().upper() for f in line.split(",")])
    return out


class Deck:
    def __init__(self, path):
        self.cards = cards(path)
        self.X, self.cells, self.nset, self.elset, self.density, self.of = {}, {}, collections.defaultdict(list), collections.defaultdict(list), {}, {}
        self.other, material = set(), None
        for key, p, lines, step in self.cards:
            if key == "NODE":
                for f in lines:
                    self.X[int(f[0])] = [float(v.replace("D", "E")) if v else 0 for v in (f[1:4] + ["", ""])[:3]]
                    if "NSET" in p:
                        self.nset[p["NSET"]].append(int(f[0]))
            elif key == "ELEMENT":
                self.elements(p, lines)
            elif key in ("NSET", "ELSET"):
                self.set(self.nset if key == "NSET" else self.elset, p, lines, key)
            elif key == "MATERIAL":
                material = p["NAME"]
            elif key == "DENSITY":
                self.density[material] = float(lines[0][0].replace("D", "E"))
            elif key == "SOLIDSECTION":
                for e in self.elset[p["ELSET"]]:
                    self.of[e] = p.get("MATERIAL")

    def elements(self, p, lines):
        n = NODES.get(p["TYPE"])
        if n is None:
            self.other.add(p["TYPE"])
            n = BESIDE.get(p["TYPE"], len([f for f in lines[0] if f]) - 1 if lines else 1)
        row = []
        for f in lines:
            row += [int(v) for v in f if v]
            if len(row) > n:
                if p["TYPE"] in NODES:
                    self.cells[row[0]] = row[1:n + 1]
                if "ELSET" in p:
                    self.elset[p["ELSET"]].append(row[0])
                row = []

    def set(self, sets, p, lines, key):
        members = sets[p[key]]
        if key == "NSET" and "ELSET" in p:
            members += [i for e in self.elset[p["ELSET"]] for i in self.cells.get(e, [])]
        for f in lines:
            if "GENERATE" in p and f[0].lstrip("-").isdigit():
                f = [v for v in f if v]
                members += range(int(f[0]), int(f[1]) + 1, int(f[2]) if len(f) > 2 else 1)
                continue
            for v in f:
                if v:
                    members += [int(v)] if v.isdigit() else sets[v.strip('"')]

    def nodes(self, name):
        return [int(name)] if name.isdigit() else sorted(set(self.nset.get(name.strip('"'), [])))

    def members(self, name):
        return [int(name)] if name.isdigit() else sorted(set(self.elset.get(name, [])))


# Shape functions from their defining property: of the monomials that span them, those that are 1 at one node and 0 at the others.
def corners(n):
    if n in (4, 10):
        return [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    if n in (6, 15):
        return [(x, y, z) for z in (-1, 1) for x, y in ((0, 0), (1, 0), (0, 1))]
    return [(x, y, z) for z in (-1, 1) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]


EDGES = {10: [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
         15: [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
         20: [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]}
LINEAR_Z = [(i, j, k) for i, j in ((0, 0), (1, 0), (0, 1)) for k in (0, 1)]
POWERS = {4: [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
          6: LINEAR_Z,
          8: [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)],
          10: [(i, j, k) for i in range(3) for j in range(3) for k in range(3) if i + j + k < 3],
          15: [(i, j, k) for i in range(3) for j in range(3) for k in range(2) if i + j < 3] + [(0, 0, 2), (1, 0, 2), (0, 1, 2)],
          20: [(i, j, k) for i in range(3) for j in range(3) for k in range(3) if sum(v for v in (i, j, k) if v > 1) <= 2]}
POWERS[20] = [p for p in POWERS[20] if sum(v == 2 for v in p) <= 1]
G3, W3 = np.polynomial.legendre.leggauss(4)


def rule(n):
    """Points and weights: products of Gauss points, collapsed onto tetrahedra and prisms."""
    for a, wa in zip(G3, W3):
        for b, wb in zip(G3, W3):
            for c, wc in zip(G3, W3):
                r, s = (1 + a) / 2, (1 + b) / 2
                if n in (4, 10):
                    t = (1 + c) / 2
                    yield (r * (1 - s) * (1 - t), s * (1 - t), t), wa * wb * wc / 8 * (1 - s) * (1 - t) ** 2
                elif n in (6, 15):
                    yield (r * (1 - s), s, c), wa * wb * wc / 4 * (1 - s)
                else:
                    yield (a, b, c), wa * wb * wc


def gradients(n):
    x = corners(n)
    points = np.array(x + [tuple((np.array(x[a]) + np.array(x[b])) / 2) for a, b in EDGES.get(n, [])], float)
    powers = POWERS[n]
    V = np.array([[p[0] ** i * p[1] ** j * p[2] ** k for i, j, k in powers] for p in points])
    N = np.linalg.inv(V)  # column a: the coefficients of function a
    out = []
    for x, w in rule(n):
        d = np.array([[(e[c] * x[c] ** max(e[c] - 1, 0) if e[c] else 0) * np.prod([x[o] ** e[o] for o in range(3) if o != c]) for c in range(3)]
                      for e in powers])
        out.append((N.T @ d, w))
    return out


GRADIENTS = {n: gradients(n) for n in POWERS}


def volumes(X):
    """Of cells (m x n x 3)."""
    return sum(w * np.linalg.det(np.swapaxes(X, 1, 2) @ g) for g, w in GRADIENTS[X.shape[1]])


def number(text):
    return float(text.replace("D", "E")) if text else 0.0


def read_deck(d):
    """Supports of nodes of cells, their forces, the sum of all forces, pressures by element."""
    used = {i for c in d.cells.values() for i in c}
    turns = {i for key, p, lines, step in d.cards if key == "RIGIDBODY" and "ROTNODE" in p for i in d.nodes(p["ROTNODE"])}
    held, force, total, pressure = {}, collections.defaultdict(lambda: np.zeros(3)), np.zeros(3), collections.Counter()
    for key, p, lines, step in d.cards:
        if key == "BOUNDARY" and not set(p) - {"OP", "AMPLITUDE", "FIXED"}:
            for f in lines:
                dofs = NAMED.get(f[1]) or range(int(f[1]), int(f[2] if len(f) > 2 and f[2] else f[1]) + 1)
                for i in d.nodes(f[0]):
                    for k in dofs:
                        if i in used and 1 <= k <= 3:
                            held[i, k] = number(f[3]) if len(f) > 3 else 0.0
        elif key == "CLOAD":
            for f in lines:
                for i in d.nodes(f[0]):
                    if int(f[1]) <= 3 and i not in turns:
                        total[int(f[1]) - 1] += number(f[2])
                        if i in used:
                            force[i][int(f[1]) - 1] += number(f[2])
        elif key == "DLOAD":
            for f in lines:
                if len(f[1]) == 2 and f[1][0] == "P" and f[1][1].isdigit():
                    for e in d.members(f[0]):
                        if number(f[2]):
                            pressure[e, round(number(f[2]), 9)] += 1
    return held, {i: f for i, f in force.items() if f.any()}, total, pressure


def read_scene(scene, mesh):
    ids, cells = mesh["mesh/nodes/id"][...], mesh["mesh/cells/id"][...]
    sets = {k: ids[v[...]] for k, v in mesh.get("mesh/sets/nodes", {}).items()}
    facets = mesh.get("mesh/sets/facets", {})
    held, force, total, pressure = {}, collections.defaultdict(lambda: np.zeros(3)), np.zeros(3), collections.Counter()
    for m in scene.get("motion", []):
        for i in sets.get(m["on"], []):
            for c in m.get("components", ["x", "y", "z"]):
                held[int(i), "xyz".index(c) + 1] = m.get("displacement", [0, 0, 0])["xyz".index(c)]
    for load in scene.get("load", []):
        if load["kind"] == "force":
            on = sets.get(load["on"], [])
            total += np.array(load["force"]) * (max(len(on), 1) if load.get("per_node") else 1)
            for i in on:
                force[int(i)] += load["force"]
        elif load["kind"] == "pressure":
            for cell in np.atleast_2d(facets[load["on"]][...])[:, 0]:
                pressure[int(cells[cell]), round(load["pressure"], 9)] += 1
    return held, force, total, pressure


def judge(deck, scene, mesh, told, said):
    faults = []
    lost = {n["loss"] for n in told}
    keys = {c[0] for c in deck.cards}
    V = {}
    for n in {len(c) for c in deck.cells.values()}:
        of = [e for e, c in deck.cells.items() if len(c) == n]
        V |= zip(of, volumes(np.array([[deck.X[i] for i in deck.cells[e]] for e in of])))
    if not deck.other - set(BESIDE):
        ours, theirs = sum(V.values()), sum(r["volume"] for r in said["regions"] if r["length"] == 0)
        if abs(ours - theirs) > 1e-6 * abs(ours):
            faults.append(f"volume {theirs}, of the deck {ours}")
        density = np.nan_to_num(mesh["mesh/regions/density"][...])
        mass = sum(deck.density.get(deck.of.get(e), 0) * v for e, v in V.items())
        its = sum(r["volume"] * rho for r, rho in zip(said["regions"], density))
        if abs(mass - its) > 1e-6 * abs(mass) and "material" not in lost:
            faults.append(f"mass {its}, of the deck {mass}")
    held, force, total, pressure = read_deck(deck)
    has = read_scene(scene, mesh)
    if "TRANSFORM" not in keys:
        missing = [k for k, v in held.items() if k not in has[0] or abs(has[0][k] - v) > 1e-9 * abs(v)]
        if missing and not lost & {"support", "load"}:
            faults.append(f"{len(missing)} supports are missing, {missing[:3]}")
        more = [k for k in has[0] if k not in held]
        if more and "EQUATION" not in keys and not deck.other - set(BESIDE):
            faults.append(f"{len(more)} supports are not of the deck, {more[:3]}")
        if "load" not in lost:
            size = max([1e-300] + [np.abs(f).max() for f in force.values()])
            off = [i for i in set(force) | set(has[1]) if np.abs(force.get(i, 0) - has[1].get(i, np.zeros(3))).max() > 1e-9 * size]
            if off and not keys & {"DISTRIBUTING", "DISTRIBUTINGCOUPLING"}:
                faults.append(f"forces of {len(off)} nodes differ, {off[:3]}")
            its = max([0.0] + [np.abs(f).max() for f in has[1].values()])
            if np.abs(total - has[2]).max() > 1e-9 * max(size, its, np.abs(total).max()):
                faults.append(f"forces sum up to {has[2]}, in the deck to {total}")
    if pressure != has[3] and "load" not in lost and "DSLOAD" not in keys and not deck.other - set(BESIDE):  # on surfaces, on shells: not read here
        faults.append(f"pressures differ: {list((pressure - has[3]).items())[:2]} and {list((has[3] - pressure).items())[:2]}")
    return faults


counts, faults = collections.Counter(), []
with tempfile.TemporaryDirectory() as work:
    work = pathlib.Path(work)
    calculix.unpack(work)
    for path in sorted(work.glob("*.inp")):
        if wanted and path.stem not in wanted:
            continue
        ran = subprocess.run([tools / "hilo-import", path.name, "-o", "m.h5", "--scene-out", "s.toml", "--json"], cwd=work, capture_output=True, text=True)
        if ran.returncode:
            counts["refused"] += 1
            continue
        said = json.loads(ran.stdout)
        deck = Deck(path)
        steps = sum(c[0] == "STEP" for c in deck.cards)
        if steps > 1 or not deck.cells or path.stem in MISREAD or any(c[0] == "INCLUDE" for c in deck.cards):
            counts["several steps, or no solids"] += 1
            continue
        scene = tomllib.loads((work / "s.toml").read_text()) if (work / "s.toml").exists() else {}
        told = [n for n in said["not_read"] if not n["output"]]
        with h5py.File(work / "m.h5") as mesh:
            found = judge(deck, scene, mesh, told, said)
        counts["compared, something told as left out" if told else "compared, whole"] += 1
        faults += [f"{path.stem}: {f}" for f in found]
print("\n".join(faults + [f"{n} decks: {what}" for what, n in sorted(counts.items())]))
sys.exit(1 if faults or (not wanted and counts["compared, whole"] < 30) else 0)
