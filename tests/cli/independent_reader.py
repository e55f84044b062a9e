#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that gmsh writes, read by meshio and by hilo-import: the same nodes, volumes by region, mid-side nodes, groups of faces.
Usage: independent_reader.py REPO BIN"""
import os
import subprocess
import sys
import tempfile

try:
    import h5py
    import meshio
    import numpy as np
except ImportError as e:
    sys.exit(f"independent_reader: {e} (make -C tests installs what it needs)")

bin = os.path.realpath(sys.argv[2])
os.environ["PATH"] = bin + ":" + os.environ["PATH"]
BOXES = """SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {1, 0, 0, 2, 1, 1};
Coherence;
%s
Physical Volume("left") = {1};
Physical Volume("right") = {2};
Physical Surface("inlet") = Surface In BoundingBox{-.1, -.1, -.1, .1, 1.1, 1.1};
Mesh.SecondOrderIncomplete = 1;
Mesh.MshFileVersion = %s;
Mesh 3;
SetOrder %d;
Save "%s";
"""
HEXES = "Transfinite Curve{:} = 3;\nTransfinite Surface{:};\nRecombine Surface{:};\nTransfinite Volume{:};"
TETS = "Mesh.MeshSizeMax = .5;"
CORNERS = {"tetra": 4, "hexahedron": 8, "wedge": 6, "tetra10": 4, "hexahedron20": 8, "wedge15": 6}
TETRAHEDRA = {4: [(0, 1, 2, 3)], 8: [(0, 1, 3, 4), (1, 2, 3, 6), (4, 7, 6, 3), (4, 6, 5, 1), (1, 3, 4, 6)], 6: [(0, 1, 2, 3), (1, 2, 3, 4), (2, 3, 4, 5)]}
SHAPES = {1: 4, 2: 10, 3: 6, 4: 15, 5: 8, 6: 20, 7: 20}  # nodes by shape


def volume(X, corners):
    return sum(np.linalg.det(X[[t[1], t[2], t[3]]] - X[t[0]]) / 6 for t in (np.array(corners)[list(k)] for k in TETRAHEDRA[len(corners)]))


def edges_of_middles(X, cells, n_corners):
    """For every node behind the corners the two corners that it lies between, as coordinates: what does not depend on an order."""
    found = set()
    for cell in cells:
        for m in cell[n_corners:]:
            pairs = [(a, b) for i, a in enumerate(cell[:n_corners]) for b in cell[:i] if np.allclose((X[a] + X[b]) / 2, X[m], atol=1e-9)]
            assert pairs, "a node that is in the middle of no edge"
            found.add(tuple(np.round(X[m], 9)))
    return found


def as_meshio_sees(path):
    m = meshio.read(path)
    X = m.points
    volumes, middles, inlet = {}, set(), 0.0
    names = {int(v[0]): (k, int(v[1])) for k, v in m.field_data.items()}
    for block, tags in zip(m.cells, m.cell_data["gmsh:physical"]):
        for cell, tag in zip(block.data, tags):
            name = names[int(tag)][0] if int(tag) in names else str(tag)
            if block.type in CORNERS:
                n = CORNERS[block.type]
                volumes[name] = volumes.get(name, 0) + volume(X, list(cell[:n]))
            elif name == "inlet":
                q = X[cell[: 3 if "triangle" in block.type else 4]]
                inlet += np.linalg.norm(np.cross(q[1] - q[0], q[2] - q[0])) / 2 if len(q) == 3 else np.linalg.norm(np.cross(q[2] - q[0], q[3] - q[1])) / 2
        if block.type in CORNERS:
            middles |= edges_of_middles(X, block.data, CORNERS[block.type])
    used = np.unique(np.concatenate([b.data.ravel() for b in m.cells if b.type in CORNERS]))
    return len(used), volumes, middles, inlet


def as_hilo_sees(path):
    with h5py.File(path) as f:
        X, nodes, offset = f["mesh/nodes/X"][:], f["mesh/cells/nodes"][:], f["mesh/cells/offset"][:]
        shape, region = f["mesh/cells/shape"][:], f["mesh/cells/region"][:]
        names = [n.decode() if isinstance(n, bytes) else n for n in f["mesh/regions/name"][:]]
        facets = f["mesh/sets/facets/inlet"][:]
    corners = {4: 4, 10: 4, 6: 6, 15: 6, 8: 8, 20: 8}
    volumes, middles = {}, set()
    for c in range(len(shape)):
        cell = list(nodes[offset[c] : offset[c + 1]])
        n = corners[SHAPES[shape[c]]]
        volumes[names[region[c]]] = volumes.get(names[region[c]], 0) + volume(X, cell[:n])
        middles |= edges_of_middles(X, [cell], n)
    inlet = 0.0
    for c, _ in facets:  # of a box the facet of a cell on x = 0 is that of its corners there
        n = corners[SHAPES[shape[c]]]
        q = np.array([X[a] for a in nodes[offset[c] : offset[c] + n] if abs(X[a][0]) < 1e-9])
        spread = q - q.mean(0)
        angle = np.argsort(np.arctan2(spread[:, 2], spread[:, 1]))
        y, z = q[angle, 1], q[angle, 2]
        inlet += abs(np.dot(y, np.roll(z, -1)) - np.dot(z, np.roll(y, -1))) / 2
    return len(X), volumes, middles, inlet


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for how, settings in (("hex", HEXES), ("tet", TETS)):
        for order in (1, 2):
            for version in ("2.2", "4.1"):
                with open("made.geo", "w") as f:
                    f.write(BOXES % (settings, version, order, "a.msh"))
                subprocess.run(["hilo-import", "--quiet", "--trust", "made.geo", "-o", "made.h5"], check=True)
                subprocess.run(["hilo-import", "--quiet", "a.msh", "-o", "a.h5"], check=True)
                where = f"{how} of order {order}, msh {version}"
                theirs, ours = as_meshio_sees("a.msh"), as_hilo_sees("a.h5")
                assert theirs[0] == ours[0], f"{where}: {theirs[0]} nodes, hilo has {ours[0]}"
                assert set(theirs[1]) == set(ours[1]) == {"left", "right"}, f"{where}: {theirs[1]} {ours[1]}"
                for name, v in theirs[1].items():
                    assert abs(v - ours[1][name]) < 1e-9 and abs(v - {"left": 1, "right": 2}[name]) < 1e-9, f"{where}: {name} {v} {ours[1][name]}"
                assert theirs[2] == ours[2] and (order == 1) == (not ours[2]), f"{where}: mid-side nodes differ"
                assert abs(theirs[3] - ours[3]) < 1e-9 and abs(theirs[3] - 1) < 1e-9, f"{where}: inlet {theirs[3]} {ours[3]}"
                # the other way round: what hilo read, written by meshio in other formats, is read as the same
                mesh = meshio.read("a.msh")
                solids = [b for b in mesh.cells if b.type in CORNERS]
                for other in ("a.vtk", "a.vtu", "a.inp"):
                    meshio.write(other, meshio.Mesh(mesh.points, solids))
                    subprocess.run(["hilo-import", "--quiet", other, "-o", "b.h5"], check=True, stderr=subprocess.DEVNULL)
                    with h5py.File("b.h5") as f:
                        X, nodes, offset, shape = (f["mesh/" + k][:] for k in ("nodes/X", "cells/nodes", "cells/offset", "cells/shape"))
                    total, middles = 0, set()
                    for c in range(len(shape)):
                        cell = list(nodes[offset[c] : offset[c + 1]])
                        n = {4: 4, 10: 4, 6: 6, 15: 6, 8: 8, 20: 8}[len(cell)]
                        total += volume(X, cell[:n])
                        middles |= edges_of_middles(X, [cell], n)
                    assert abs(total - 3) < 1e-9 and middles == ours[2], f"{where}: {other} has volume {total}"
print("independent_reader: meshio and hilo-import agree on 8 meshes, and on 24 that meshio wrote")
