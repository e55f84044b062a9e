#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run is for other programs: /VTKHDF of run.h5 (vtkhdf.py) after a plain run, on ranks, of the skin, in single precision, with an
envelope, and of a restart; glTF with beams, a rigid region and deformations; universal files.  Truth: the run's own arrays, volumes of the
blocks, and readers that know the published layouts alone.
Usage: run_exports.py BIN"""
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

import gltf
import on_ranks
import universal
import vtkhdf

os.environ["PATH"] = os.path.realpath(sys.argv[1]) + ":" + os.environ["PATH"]
on_ranks.use()
HEX = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
WEDGE = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)]
TET = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
HEX_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
WEDGE_EDGES = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)]
TET_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
CELLS = [("C3D8", HEX, [], 2), ("C3D20R", HEX, HEX_EDGES, 1), ("C3D6", WEDGE, [], 1), ("C3D15", WEDGE, WEDGE_EDGES, 1), ("C3D10", TET, TET_EDGES, 1)]


def sh(command, exit=0):
    ran = subprocess.run(command, shell=True, capture_output=True, text=True, timeout=120)
    assert ran.returncode == exit, (command, ran.returncode, ran.stdout, ran.stderr)
    return ran.stdout + ran.stderr


def write_deck():
    """A block of each shape, apart from the others; of hexahedra two, one on the other."""
    nodes, blocks, n = [], [], 0
    for k, (kind, corners, edges, count) in enumerate(CELLS):
        points = [np.array(c, float) for c in corners]
        points += [(points[a] + points[b]) / 2 for a, b in edges]
        ids = []
        for at in points:
            n += 1
            nodes.append(f"{n}, {at[0] + 2 * k:g}, {at[1]:g}, {at[2]:g}")
            ids.append(n)
        cells = [ids]
        if count == 2:
            top = []
            for at in points[4:]:
                n += 1
                nodes.append(f"{n}, {at[0] + 2 * k:g}, {at[1]:g}, {at[2] + 1:g}")
                top.append(n)
            cells.append(ids[4:] + top)
        blocks.append(f"*ELEMENT, TYPE={kind}, ELSET={kind.lower()}")
        blocks += [f"{100 * k + j + 1}, {', '.join(map(str, cell))}" for j, cell in enumerate(cells)]
    open("deck.inp", "w").write("*NODE\n" + "\n".join(nodes + blocks) + "\n")


SCENE = """gravity = [0, 0, -9.81]
material.soft = {E = 1e7, nu = 0.3, density = 1000}
region."*" = {material = "soft"}
body = [{name = "bob", mass = 1, com = [0, 5, 0], inertia = [0.1, 0.2, 0.25]}]
initial = [{on = "bob", spin = [0, 0, 3]}]
probe = [{name = "tip", on = "bob", at = [0.5, 5, 0]}]
section.rod = {kind = "box", width = 0.1, height = 0.2, thickness = 0.01}
beam.whip = {points = [[0, 5, 0], [0, 5, 1]], cells = [2], section = "rod", material = "soft", a = "bob"}
set.top = {kind = "box", low = [-0.1, -0.1, 1.9], high = [1.1, 1.1, 2.1]}
load = [{kind = "force", name = "pull", on = "top", force = [3e5, 0, 1e5]}]
sensor = [{name = "felt", on = "top"}]
time = {end = 0.02, step = 1e-3}
output = {interval = 0.004}
"""
write = lambda path, text: open(path, "w").write(text)
VOLUMES = {"c3d8": 2, "c3d20r": 1, "c3d6": 1 / 2, "c3d15": 1 / 2, "c3d10": 1 / 6, "whip": 0.1 * 0.2 - 0.08 * 0.18}
TURN = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])  # x y z of the run to x z -y of glTF, whose y is up


def check_gltf(run):
    """Surfaces in the positions of the run, at each step, with its colours."""
    sh("hilo-post export run.h5 --steps first -o still.glb")
    still = gltf.Glb("still.glb").regions()
    assert sorted(still) == sorted(VOLUMES), sorted(still)
    for name, (points, triangles, _) in still.items():
        assert abs(gltf.volume(points, triangles) - VOLUMES[name]) < 1e-5 * VOLUMES[name], (name, gltf.volume(points, triangles))
    sh("hilo-post export run.h5 --steps all --field von_mises --speed 0.01 -o run.glb")
    moving = gltf.Glb("run.glb")
    keys = sorted(run["field"])
    names = [n.decode() if isinstance(n, bytes) else n for n in run["mesh/regions/name"][:]]
    offset, nodes, region = run["mesh/cells/offset"][:], run["mesh/cells/nodes"][:], run["mesh/cells/region"][:]
    t = moving.read(moving.json["animations"][0]["samplers"][0]["input"])[:, 0]
    assert np.allclose(t, [run["field"][key].attrs["t"] / 0.01 for key in keys], atol=1e-6)
    largest = np.max([run["field"][key]["von_mises"][:] for key in keys], axis=0)
    told = moving.json["scenes"][0]["extras"]
    assert told["unit"] == "Pa" and abs(told["high"] - largest.max()) < 1e-9 * largest.max()
    morphed = 0
    bob = list(n.decode() for n in run["body/name"][:]).index("bob")
    X_bob, way, t_all = run["body/points"][bob], run["history/body/bob"][:].reshape(-1, 4, 3), run["history/t"][:]
    angle = lambda d: np.arctan2(d[..., 1], d[..., 0])
    base = {}
    for k, key in enumerate(keys):
        X = (run["mesh/nodes/X"][:] + run["field"][key]["displacement"][:]) @ TURN.T
        for name, (points, triangles, colours) in moving.regions(k).items():
            if name == "whip":  # its first section turns with the body that it is on
                corner = points[base.setdefault(name, np.argmax(still[name][0] @ [1, -5, 0]))] @ TURN
                now = way[abs(t_all - run["field"][key].attrs["t"]).argmin()]
                turned = max((angle(x - now[0]) - angle(X - X_bob[0]) for x, X in zip(now[1:3], X_bob[1:3])), key=abs)
                seen = angle(corner - now[0]) - angle(still[name][0][base[name]] @ TURN - X_bob[0])
                assert abs(np.sin(seen - turned)) < 1e-5 and (k == 0 or abs(np.sin(turned)) > 1e-3), (k, seen, turned)
                continue
            cells = [c for c in range(len(region)) if names[region[c]] == name]
            own = np.unique(np.concatenate([nodes[offset[c]:offset[c + 1]] for c in cells]))
            near = np.linalg.norm(points[:, None] - X[None, own], axis=2)
            assert near.min(axis=0).max() < 1e-6, (name, key, near.min(axis=0).max())  # every node of these blocks is on the surface
            if name == "c3d8":
                assert near.min(axis=1).max() < 1e-6
                green = colours[near.argmin(axis=0), 1][np.argsort(largest[own])]  # of viridis it rises all the way
                assert (np.diff(green) >= 0).all() and green[-1] > green[0]
                morphed = max(morphed, np.linalg.norm(np.diff(X[own][[0, -1]], axis=0)))
            if name == "c3d6":
                assert abs(colours - colours[0]).max() == 0  # rigid: no stress
    assert morphed > 1.001 * np.sqrt(5), morphed  # the block is pulled, or nothing was shown
    assert "targets" not in next(m for m in moving.json["meshes"] if m["name"] == "c3d6")["primitives"][0]
    assert "hilo-post: still.gltf: glTF" in sh("hilo-post export run.h5 -o still.gltf", 1)
    assert "one step makes one VTU file" in sh("hilo-post export run.h5 --steps all -o all.vtu", 1)
    assert "--field: is of glTF alone" in sh("hilo-post export run.h5 --field von_mises -o one.vtu", 1)
    sh("hilo-post export run.h5 --times 0.008:0.016 -o part.glb")
    assert len(gltf.Glb("part.glb").read(gltf.Glb("part.glb").json["animations"][0]["samplers"][0]["input"])) == 3


def check_universal(run):
    """The numbers of CSV, which reads back as the same doubles, with names and units."""
    names = "energy 'probe.*' 'sensor.*' 'body.bob'"
    sh(f"hilo-post series run.h5 {names} -o all.csv")
    sh(f"hilo-post series run.h5 {names} -o all.unv")
    header, *rows = [line.split(",") for line in open("all.csv").read().splitlines()]
    table = np.array(rows, float)
    factors, functions = universal.read("all.unv")
    assert factors == [1, 1, 1, 273.15]
    assert len(functions) == len(header) - 1 > 20
    types = {"m": 8, "m/s": 11, "m/s^2": 12, "g": 12, "J": 1}
    for k, f in enumerate(functions, 1):
        label, unit = header[k].rstrip("]").split(" [")
        scale = 9.80665 if unit == "g" else 1
        assert f["id"][0] == label and f["index"] == k and f["kind"] == 1
        assert f["y"]["type"] == types[unit] and f["y"]["unit"] == ("m/s^2" if unit == "g" else unit), (label, f["y"])
        assert f["y"]["exponents"] == ((1, 1, 0) if unit == "J" else (1, 0, 0))
        assert f["x"]["type"] == 17 and f["x"]["unit"] == "s" and f["even"]
        assert f["name"] == label.split(".")[-2][:10]
        assert abs(np.array(f["t"]) - table[:, 0]).max() < 1e-6 * table[-1, 0]
        assert abs(np.array(f["values"]) - scale * table[:, k]).max() <= 1e-12 * abs(scale * table[:, k]).max(), label
    by_label = {f["id"][0]: f for f in functions}
    assert [by_label["probe.tip." + c]["direction"] for c in ("x", "y", "z")] == [1, 2, 3]
    assert by_label["probe.tip.x"]["node"] == by_label["probe.tip.z"]["node"] != by_label["energy.kinetic"]["node"]
    # another abscissa is not even; one that turns back is refused, and so is one of which six digits are too few
    sh("hilo-post series run.h5 energy.gravity -x 'u [m] = t^2' -o uneven.unv")
    (f,) = universal.read("uneven.unv")[1]
    assert not f["even"] and np.allclose(f["t"], table[:, 0] ** 2, rtol=1e-5, atol=1e-12) and f["x"]["type"] == 8
    assert "does not rise" in sh("hilo-post series run.h5 energy.gravity -x 'u [m] = sin(1000*t)' -o back.unv", 2)
    assert "six digits" in sh("hilo-post series run.h5 energy.gravity -x 'u [m] = 1e6 + t^2' -o fine.unv", 2)
    assert not os.path.exists("back.unv") and not os.path.exists("fine.unv")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    write_deck()
    write("scene.toml", SCENE)
    sh("hilo-import --quiet deck.inp --regions c3d8,c3d20r,c3d6,c3d15,c3d10 -o mesh.h5")
    sh("hilo-tag --quiet mesh.h5 --rigid c3d6 -o tags.h5")
    solve = "hilo-solve --quiet scene.toml tags.h5 "
    sh(solve)
    vtkhdf.check("run.h5")
    sh(solve + "-o skin.h5 --set 'output.nodes=\"skin\"' --set output.envelope=true")
    vtkhdf.check("skin.h5")
    sh(solve + "-o single.h5 --set 'output.precision=\"single\"'")
    vtkhdf.check("single.h5")
    sh("hilo-part --quiet tags.h5 -n 3 -o parts.h5")
    sh("mpirun -n 3 hilo-solve --quiet scene.toml parts.h5 -o ranks.h5")
    vtkhdf.check("ranks.h5")
    # a run that went on holds what the whole run holds; the shorter one before it was a VTKHDF file too
    sh(solve + "-o more.h5 --set time.end=0.012 --checkpoint 5steps")
    vtkhdf.check("more.h5")
    sh("hilo-solve --quiet --restart more.h5 --set time.end=0.02")
    vtkhdf.check("more.h5")
    with h5py.File("run.h5") as run, h5py.File("more.h5") as more:
        for name in run["VTKHDF/PointData"]:
            a, b = run["VTKHDF/PointData"][name][:], more["VTKHDF/PointData"][name][:]
            assert a.shape == b.shape and abs(a - b).max() <= 1e-9 * abs(a).max(), name
    # a field that only the second half of a run has: NaN before
    sh(solve + "-o late.h5 --set time.end=0.012 --checkpoint 5steps --set 'output.fields=[\"displacement\"]'")
    sh("hilo-solve --quiet --restart late.h5 --set time.end=0.02 --set 'output.fields=[\"displacement\", \"von_mises\"]'")
    with h5py.File("late.h5") as late:
        seen = late["VTKHDF/PointData/von_mises"][:].reshape(6, -1)
        for k, key in enumerate(sorted(late["field"])):
            own = late["field"][key].get("von_mises")
            assert np.isnan(seen[k]).all() if own is None else (seen[k] == own[:]).all(), key
        assert 0 < sum("von_mises" in late["field"][key] for key in late["field"]) < 6
    # moved and renamed, it opens still: its views name no file
    os.makedirs("elsewhere")
    os.rename("more.h5", "elsewhere/other.h5")
    with h5py.File("elsewhere/other.h5") as moved, h5py.File("run.h5") as run:
        assert (moved["VTKHDF/Points"][:] == run["VTKHDF/Points"][:]).all() and abs(moved["VTKHDF/PointData/displacement"][:]).max() > 0
    with h5py.File("run.h5") as run:
        check_gltf(run)
        check_universal(run)
