#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nastran decks of one subcase that are made up here, in small, large and free fields, with continuations, coordinate systems, INCLUDE and
sets of loads and supports (bdf_writer.py), read once more (bdf_reader.py): places, volumes, masses, supports, forces, moments and pressures that
hilo-import has are those of the deck, or it says which kind of thing it left out.
Usage: nothing_lost_bdf.py REPO BIN [SEED...]"""
import collections
import json
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import tomllib

import h5py
import numpy as np

from bdf_reader import FACES, Deck, listed, number, physical, whole
from bdf_writer import make

tools, wanted = pathlib.Path(sys.argv[2]).resolve(), [int(a) for a in sys.argv[3:]]
SEEDS = wanted or range(26)


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
