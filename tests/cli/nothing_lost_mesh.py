#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random meshes in each mesh format that hilo-import reads (mesh_writers.py): cells (with the nodes on their edges), regions, facets and node
sets that it has are those that were written, or it says what it left out.  Each comparison is seen to fail on a mesh with one thing changed.
Meshes of gmsh-doc's scripts have the volumes, groups and boxes that meshio finds in what gmsh saves.  Usage: nothing_lost_mesh.py REPO BIN [SEED]"""
import collections
import gzip
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

import h5py
import meshio
import numpy as np

from mesh_writers import (EDGES, FACES, Model, TETRAHEDRA, corners, write_by_vtk, write_deck, write_exodus, write_med, write_medit, write_msh,
                          write_msh1, write_msh41, write_unv, write_vtk)

tools = pathlib.Path(sys.argv[2]).resolve()
SEEDS = [int(sys.argv[3])] if len(sys.argv) > 3 else range(1, 4)


def halves(c):
    """A pyramid as two tetrahedra, by either diagonal."""
    return [[(c[k], c[(k + 1) % 4], c[(k + 2) % 4], c[4]), (c[k], c[(k + 2) % 4], c[(k + 3) % 4], c[4])] for k in (0, 1)]


class Seen:
    """A mesh as sets of places: cells by region, facets and nodes by set."""

    def __init__(self):
        self.cells, self.facets, self.nodes = collections.Counter(), {}, {}


def cell_at(kind, place):
    """Corners in any order, and for each node on an edge the corners that it is between: what no numbering changes."""
    n = corners(kind)
    return (frozenset(place[:n]), frozenset((frozenset((place[a], place[b])), place[n + k]) for k, (a, b) in enumerate(EDGES[kind])) if len(place) > n else None)


def written(m, got, name_of_region, digits):
    s, P = Seen(), [tuple(float(f"%.{digits}g" % v) for v in x) for x in m.X]
    for kind, c, region in m.cells:
        at = lambda part: (region, cell_at("tetra" if kind == "pyramid" else kind, [P[a] for a in part]))
        ways = [[at(part) for part in way] for way in (halves(c) if kind == "pyramid" else [[c]])]
        for one in next((w for w in ways if all((name_of_region(region), c[1]) in got.cells for c in w)), ways[0]):
            s.cells[one] += 1
    bases = {frozenset(c[:4]) for kind, c, _ in m.cells if kind == "pyramid"} - {frozenset(c[k] for k in f) for kind, c, _ in m.cells if kind != "pyramid" for f in FACES[kind]}
    facets = set().union(*got.facets.values()) if got.facets else set()
    for nodes, group in m.faces:
        corners_of = nodes[:4 if len(nodes) in (4, 8) else 3]
        ways = [[corners_of]]
        if frozenset(nodes) in bases:  # the base of a pyramid is two facets
            ways = [[[nodes[k], nodes[(k + 1) % 4], nodes[(k + 2) % 4]], [nodes[k], nodes[(k + 2) % 4], nodes[(k + 3) % 4]]] for k in (0, 1)]
        ways = [{frozenset(P[a] for a in part) for part in way} for way in ways]
        s.facets.setdefault(group, set()).update(next((w for w in ways if w <= facets), ways[0]))
    for nodes, group in m.lines:
        s.nodes.setdefault(group, set()).update(P[a] for a in nodes)
    for node, group in m.points:
        s.nodes.setdefault(group, set()).add(P[node])
    return s


OURS = {4: "tetra", 10: "tetra", 6: "wedge", 15: "wedge", 8: "hexahedron", 20: "hexahedron"}
OUR_FACES = {"tetra": [(0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 2, 1)], "wedge": [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
             "hexahedron": [(0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7)]}  # docs/format.md


def imported(path, digits):
    s = Seen()
    with h5py.File(path) as f:
        P = [tuple(float(f"%.{digits}g" % v) for v in x) for x in f["mesh/nodes/X"][...]]
        nodes, offset, region = f["mesh/cells/nodes"][...], f["mesh/cells/offset"][...], f["mesh/cells/region"][...]
        names = [n.decode() if isinstance(n, bytes) else n for n in f["mesh/regions/name"][...]]
        bars = 0
        for c in range(len(region)):
            one = nodes[offset[c]:offset[c + 1]]
            if len(one) == 2:
                bars += 1
                continue
            s.cells[names[region[c]], cell_at(OURS[len(one)], [P[a] for a in one])] += 1
        for name, rows in f.get("mesh/sets/facets", {}).items():
            s.facets[name] = set()
            for c, k in rows[...]:
                one = nodes[offset[c]:offset[c + 1]]
                s.facets[name].add(frozenset(P[one[i]] for i in OUR_FACES[OURS[len(one)]][k]))
        for name, rows in f.get("mesh/sets/nodes", {}).items():
            s.nodes[name] = {P[a] for a in rows[...]}
    return s, bars


def compare(wrote, got, name_of_region, name_of_facets, name_of_nodes, said):
    """`name_of_*` is None where the format or its reader has no such thing: then words in what is said must name it."""
    faults = []
    want = collections.Counter({(name_of_region(g), c): n for (g, c), n in wrote.cells.items()})
    if want != got.cells:
        lost, more = want - got.cells, got.cells - want
        faults.append(f"{sum(lost.values())} cells are missing, {sum(more.values())} are more; {next(iter(lost), None)} {next(iter(more), None)}")
    for what, name_of, ours, theirs in (("facets", name_of_facets, wrote.facets, got.facets), ("nodes", name_of_nodes, wrote.nodes, got.nodes)):
        if name_of:
            for group, members in ours.items():
                if theirs.get(name_of(group)) != members:
                    faults.append(f"{what} {name_of(group)}: {len(theirs.get(name_of(group), ()))}, written {len(members)}")
            for name in set(theirs) - {name_of(g) for g in ours}:
                faults.append(f"{what} {name} were not written")
    return faults


ALL, NO_PYRAMID = ["hexahedron", "wedge", "tetra", "pyramid"], ["hexahedron", "wedge", "tetra"]
group = lambda g: f"group {g}, of _{{}}"
LOOSE = ("triangles and quadrangles of no group, on no solid", "lines of no group, on no solid")
# format: file, writer, kinds of cells, quadratic too, names of regions, facets, nodes; what must be said
surface, curve = (lambda d: lambda g: f"group {g}, of _{d}"), None
msh_names = (lambda g: f"group {g}, of _3", lambda g: f"group {g}, of _2", lambda g: f"group {g}, of _{1 if g < 91 else 0}")
plain = (lambda g: f"volume_{g}", lambda g: f"surface_{g}", lambda g: f"{'curve' if g < 91 else 'point'}_{g}")
vtk_names = (lambda g: f"region_{g}", None, None)
vtk_said = ('cell array "other"', 'cell array "share"', 'node array "heat"', "VTK cells of type 1 ", "VTK cells of type 3 ")
FORMATS = [
    ("msh 1", ".msh", write_msh1, ALL, False, plain, LOOSE),
    ("msh 2.2", ".msh", lambda m, p: write_msh(m, p, "2.2", False), ALL, True, msh_names, LOOSE),
    ("msh 2.2, bytes", ".msh", lambda m, p: write_msh(m, p, "2.2", True), ALL, True, msh_names, LOOSE),
    ("msh 4.1", ".msh", write_msh41, ALL, True, plain, LOOSE),
    ("Medit", ".mesh", write_medit, ALL, False, (plain[0], plain[1], lambda g: f"curve_{g}"), LOOSE),
    ("universal", ".unv", write_unv, NO_PYRAMID, False, (lambda g: f"the group {g}",) * 3, ("faces of no group, on no solid", "lines of no group, on no solid")),
    ("MED", ".med", write_med, ALL, True, (lambda g: f"the group {g}",) * 3, ("faces of no group, on no solid", "lines of no group, on no solid", "fields")),
    ("Exodus", ".exo", write_exodus, ALL, True, (lambda g: f"the group {g}",) * 3, ()),
    ("VTK 4.2", ".vtk", lambda m, p: write_vtk(m, p, "MaterialIds", file_format="vtk", binary=False), ALL, True, vtk_names, vtk_said),
    ("VTK 5.1, bytes", ".vtk", lambda m, p: write_vtk(m, p, "gmsh:physical", file_format="vtk", binary=True), ALL, True, vtk_names, vtk_said),
    ("vtu", ".vtu", lambda m, p: write_vtk(m, p, "region", binary=False), ALL, True, vtk_names, vtk_said),
    ("vtu, zlib", ".vtu", lambda m, p: write_vtk(m, p, "PartId", compression="zlib"), ALL, True, vtk_names, vtk_said),
    ("VTK's own, text", ".vtk", lambda m, p: write_by_vtk(m, p, False), ALL, True, vtk_names, ()),
    ("VTK's own, bytes", ".vtk", lambda m, p: write_by_vtk(m, p, True), ALL, True, vtk_names, ()),
    ("VTK's own vtu", ".vtu", lambda m, p: write_by_vtk(m, p, True), ALL, True, vtk_names, ()),
    ("inp by meshio", ".inp", write_deck, NO_PYRAMID, True, (lambda g: "rest", None, None), ()),
]
faults, counts = [], collections.Counter()
with tempfile.TemporaryDirectory() as work:
    os.chdir(work)
    for seed in SEEDS:
        for number, (name, ending, write, kinds, may_be_quadratic, names, must) in enumerate(FORMATS):
            quadratic = may_be_quadratic and (seed + number) % 2 == 0
            m = Model(100 * seed + number, quadratic, NO_PYRAMID if quadratic and "pyramid" in kinds else kinds)
            path = pathlib.Path(f"m{seed}-{number}{ending}")
            try:
                write(m, path)
            except ImportError:
                counts[f"{name}: no writer here"] += 1
                continue
            ran = subprocess.run([tools / "hilo-import", path, "-o", "m.h5"], capture_output=True, text=True, timeout=60)
            where = f"seed {seed}, {name}, {path}"
            if ran.returncode:
                faults.append(f"{where}: {ran.stderr.strip()}")
                continue
            digits = 11
            got, bars = imported("m.h5", digits)
            wrote = written(m, got, names[0], digits)
            if name in ("Medit",):
                wrote.nodes = {g: v for g, v in wrote.nodes.items() if g < 91}
            if names[1] is None:
                wrote.facets, wrote.nodes = {}, {}
            found = compare(wrote, got, *names, ran.stderr)
            found += [f"{bars} bars that were not written"] if bars else []
            found += [f'nothing says "{words}"' for words in must if words not in ran.stderr]
            # one thing else: the comparison must see it
            for spoil in ("cells", "facets", "nodes"):
                of = getattr(wrote, spoil)
                if of and (spoil == "cells" or names[1]):
                    key = next(iter(of))
                    kept = of[key]
                    of[key] = kept + 1 if spoil == "cells" else set(list(kept)[1:])
                    if not compare(wrote, got, *names, ran.stderr):
                        found.append(f"other {spoil} are not seen")
                    of[key] = kept
            counts[name] += 1
            faults += [f"{where}: {f}" for f in found]
    # damaged files, which libraries read: one line, soon, in little memory
    r = random.Random(SEEDS[0])
    for path in [p for seed in SEEDS for p in pathlib.Path().glob(f"m{seed}-*") if p.suffix in (".med", ".exo")]:
        whole = path.read_bytes()
        for k in range(4):
            place = r.randrange(60) if k == 0 else r.randrange(len(whole))  # counts stand in front
            damaged = whole[:place] if k == 1 else whole[:place] + r.choice([b"\0" * 4, b"\xff" * 4, b"\x7f" * 4]) + whole[place + 4:]
            pathlib.Path(f"damaged{path.suffix}").write_bytes(damaged)
            ran = subprocess.run([tools / "hilo-import", f"damaged{path.suffix}", "-o", "m.h5"], capture_output=True, text=True, timeout=30)
            counts["damaged files"] += 1
            if ran.returncode not in (0, 2) or (ran.returncode and len(ran.stderr.strip().splitlines()) != 1):
                faults.append(f"{path} damaged at {place}, way {k}: exit {ran.returncode}: {ran.stderr}")

    # small files with what no writer above writes: words that must be said, exit code
    cube = "\n".join(f"{i + 1} {x} {y} {z}" for i, (x, y, z) in enumerate([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]))
    msh = f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n3 5 \"one\"\n3 7 \"empty\"\n$EndPhysicalNames\n$Nodes\n8\n{cube}\n$EndNodes\n$Elements\n"
    vertices = "MeshVersionFormatted 2\nDimension 3\nVertices\n8\n" + "\n".join(l.split(" ", 1)[1] + " 0" for l in cube.splitlines()) + "\n"
    unv = "    -1\n  2411\n" + "\n".join(f"{l.split()[0]} 1 1 11\n" + " ".join(l.split()[1:]) for l in cube.splitlines()) + "\n    -1\n    -1\n  2412\n1 115 1 1 7 8\n1 2 3 4 5 6 7 8\n    -1\n"
    vtk = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n" + "\n".join(l.split(" ", 1)[1] for l in cube.splitlines()) + "\n"
    small = [
        # an element in two groups, as gmsh writes msh 2: one cell, not two
        ("two.msh", msh + "2\n1 5 2 5 1 1 2 3 4 5 6 7 8\n2 5 2 6 1 1 2 3 4 5 6 7 8\n$EndElements\n$ElementData\n1\n\"x\"\n$EndElementData\n", 0, 1,
         ['"volume_6" belong to another region too', 'group "empty" has no elements', "1 sections $ElementData"]),
        ("double.msh", msh + "2\n1 5 2 5 1 1 2 3 4 5 6 7 8\n2 5 2 6 2 1 2 3 4 5 6 7 8\n$EndElements\n", 0, 2, ["1 cells have the nodes of another cell"]),
        ("half.msh", msh.replace("$Nodes\n8", "$Nodes\n9").replace("$EndNodes", "9 5 0 0\n$EndNodes") + "3\n1 5 2 5 1 1 2 3 4 5 6 7 8\n2 1 2 9 1 1 2\n3 1 2 9 1 1 9\n$EndElements\n", 0, 1, ['curve group "curve_9"']),
        ("third.mesh", vertices + "TetrahedraP3\n1\n1 2 4 5 1 2 3 4 5 6 7 8 1 2 3 4 5 6 7 8 1\nEnd\n", 2, 0, ["1 TetrahedraP3 are not read"]),
        ("further.mesh", vertices + "Hexahedra\n1\n1 2 3 4 5 6 7 8 3\nSolAtVertices\n1\n3\nRequiredVertices\n1\n1\nEnd\n", 0, 1, ["not read: 1 SolAtVertices"]),
        ("gone.unv", unv + "    -1\n  2467\n1 0 0 0 0 0 0 2\npins\n7 3 0 0 7 99 0 0\n    -1\n", 0, 1, ['group "pins": 1 of its numbers are no node']),
        ("arrays.vtk", vtk + "CELLS 1 9\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 1\n12\nCELL_DATA 1\nVECTORS push double\n1 2 3\nSCALARS tags int 1\nLOOKUP_TABLE default\n4\n", 0, 1,
         ['cell array "push"', 'cell array "tags" (--regions tags_4']),
        ("wedge.vtk", vtk + "CELLS 2 14\n6 0 1 3 4 5 7\n6 1 2 3 5 6 7\nCELL_TYPES 2\n13\n13\n", 0, 2, []),
    ]
    for name, text, code, n_cells, words in small:
        pathlib.Path(name).write_text(text)
        ran = subprocess.run([tools / "hilo-import", name, "-o", "m.h5", "--json"], capture_output=True, text=True, timeout=60)
        faults += [f'{name}: nothing says "{w}": {ran.stderr}' for w in words if w not in ran.stderr]
        if ran.returncode != code or (code == 0 and sum(r["cells"] for r in json.loads(ran.stdout)["regions"]) != n_cells):
            faults.append(f"{name}: exit {ran.returncode}, {ran.stdout} {ran.stderr}")
        counts["small files"] += 1

    # gmsh-doc: volume, box and number of cells of each physical volume, and the area of each physical surface, in what gmsh saves
    def read_doc(script):
        folder = pathlib.Path("/usr/share/doc/gmsh-doc/doc/gmsh")
        here, there = script.split("/", 1)  # gmsh 4.13 calls its folders otherwise
        source = folder / ({"tutorial": "tutorials", "demos": "examples"}[here] if not (folder / here).exists() else here) / there
        return source.read_text() if source.exists() else gzip.decompress(source.with_suffix(".geo.gz").read_bytes()).decode()

    pathlib.Path("t1.geo").write_text(read_doc("tutorial/t1.geo"))  # which t2 includes
    for script in ("tutorial/t2.geo", "tutorial/t15.geo", "demos/simple_geo/hex.geo"):
        text = read_doc(script)
        pathlib.Path("doc.geo").write_text(text)
        pathlib.Path("save.geo").write_text(text + '\nMesh.MshFileVersion = 4.1;\nMesh 3;\nSave "saved.msh";\n')
        for words in (["save.geo", "--trust"], ["doc.geo"]):
            ran = subprocess.run([tools / "hilo-import", *words, "-o", "m.h5", "--json"], capture_output=True, text=True, timeout=120)
        saved, said = meshio.read("saved.msh"), json.loads(ran.stdout)
        names = {int(t): k for k, (t, d) in saved.field_data.items() if d == 3}
        volume, cells = collections.Counter(), collections.Counter()
        tagged = saved.cell_data.get("gmsh:physical") or saved.cell_data["gmsh:geometrical"]
        for b, tags in zip(saved.cells, tagged):
            parts = {"tetra": [(0, 1, 2, 3)], "wedge": [(0, 1, 2, 3), (1, 2, 3, 4), (2, 3, 4, 5)], "hexahedron": TETRAHEDRA}.get(b.type)
            for c, t in zip(b.data, tags) if parts else ():
                name = names.get(int(t), f"volume_{t}")
                cells[name] += 1
                volume[name] += sum(abs(np.linalg.det(saved.points[c[list(p[1:])]] - saved.points[c[p[0]]])) / 6 for p in parts)
        found = {r["name"]: r for r in said["regions"] if r["volume"] > 0}
        for name in volume:
            if name not in found or found[name]["cells"] != cells[name] or abs(found[name]["volume"] - volume[name]) > 1e-9 * volume[name]:
                faults.append(f"{script}: {name} has {found.get(name)}, meshio {cells[name]} cells of {volume[name]}")
        faults += [f"{script}: group {k} is lost" for k, (t, d) in saved.field_data.items() if d < 3 and k not in str(said)]
        counts["scripts of gmsh-doc"] += 1
print("\n".join(faults + [f"{n} meshes: {what}" for what, n in sorted(counts.items())]))
sys.exit(1 if faults or sum(counts.values()) < len(FORMATS) * len(SEEDS) else 0)
