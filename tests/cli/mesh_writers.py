# SPDX-License-Identifier: GPL-3.0-or-later
"""Random meshes of every kind of cell, with regions, named surfaces, curves and points, and how each format has them: written by meshio, by VTK
and by the few lines below."""
import collections
import random

import meshio
import numpy as np

meshio._mesh.topological_dimension.setdefault("wedge15", 3)  # which this version of meshio forgot
# Cells: corners, edges in the order of VTK's and meshio's nodes on them, faces by corners.
EDGES = {"tetra": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
         "wedge": [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
         "hexahedron": [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]}
FACES = {"tetra": [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)], "pyramid": [(0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
         "wedge": [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
         "hexahedron": [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]}
QUADRATIC = {"tetra": "tetra10", "wedge": "wedge15", "hexahedron": "hexahedron20", "triangle": "triangle6", "quad": "quad8", "line": "line3"}
VTK_TYPE = {"vertex": 1, "line": 3, "triangle": 5, "quad": 9, "tetra": 10, "hexahedron": 12, "wedge": 13, "pyramid": 14, "tetra10": 24, "hexahedron20": 25, "wedge15": 26, "triangle6": 22, "quad8": 23}
UNV_TYPE = {"line": 21, "triangle": 41, "quad": 44, "tetra": 111, "wedge": 112, "hexahedron": 115}
# Six corners of a cube as wedges, eight as tetrahedra, with a node in the middle as pyramids.
WEDGES = [(0, 1, 3, 4, 5, 7), (1, 2, 3, 5, 6, 7)]
TETRAHEDRA = [(0, 1, 3, 7), (0, 1, 7, 4), (1, 4, 5, 7), (1, 2, 3, 7), (1, 2, 7, 6), (1, 5, 6, 7)]


class Model:
    """Cells as (type, nodes, region), faces and lines as (nodes, group), points as (node, group)."""

    def __init__(self, seed, quadratic, kinds):
        r = self.r = random.Random(seed)
        n = [r.randint(1, 3) for _ in range(3)]
        skew = np.eye(3) + np.array([[r.uniform(-0.2, 0.2) for _ in range(3)] for _ in range(3)])
        self.X, at, self.cells, self.middle = [], {}, [], {}

        def point(x):
            self.X.append([round(float(v), 8) for v in x])
            return len(self.X) - 1

        for i in np.ndindex(*(k + 1 for k in n)):
            at[i] = point(skew @ (np.array(i) + [r.uniform(-0.12, 0.12) for _ in range(3)]))
        self.quadratic = quadratic
        regions = r.sample(range(1, 40), 3)
        for i in np.ndindex(*n):
            c = [at[tuple(np.array(i) + d)] for d in [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]]
            kind, region = r.choice(kinds), r.choice(regions)
            if kind == "hexahedron":
                self.cells.append((kind, c, region))
            elif kind == "pyramid":
                top = point(np.mean([self.X[a] for a in c], 0))
                self.cells += [(kind, [c[k] for k in face[::-1]] + [top], region) for face in FACES["hexahedron"]]
            else:
                self.cells += [(kind, [c[k] for k in part], region) for part in (WEDGES if kind == "wedge" else TETRAHEDRA)]
        if quadratic:
            self.cells = [(t, c + [self.between(c[a], c[b]) for a, b in EDGES[t]], g) for t, c, g in self.cells]
        self.faces, self.lines, self.points = [], [], []
        for group in r.sample(range(41, 80), r.randint(1, 3)):
            for t, c, _ in r.sample(self.cells, min(len(self.cells), r.randint(1, 6))):
                f = r.choice(FACES[t])
                self.faces.append(([c[k] for k in f] + ([self.between(c[f[k]], c[f[(k + 1) % len(f)]]) for k in range(len(f))] if quadratic else []), group))
        once = {}
        for nodes, group in self.faces:  # a face in two groups is listed twice by some formats only
            once.setdefault(frozenset(nodes), (nodes, group))
        self.faces = list(once.values())
        for group in r.sample(range(81, 90), 1):
            for t, c, _ in r.sample(self.cells, min(len(self.cells), 3)):
                a, b = (EDGES[t] if t in EDGES else [(0, 1), (1, 4)])[0]
                if all(set(l[0]) != {c[a], c[b]} for l in self.lines):
                    self.lines.append(([c[a], c[b]], group))
        for group in r.sample(range(91, 99), 2):
            self.points.append((r.choice(self.cells)[1][0], group))
        # what lies on no cell: a face, a line, a node
        far = [point(x) for x in ([9, 0, 0], [9, 1, 0], [9, 0, 1], [8, 0, 0])]
        self.loose_face, self.loose_line = far[:3], [far[0], far[3]]

    def between(self, a, b):
        key = frozenset((a, b))
        if key not in self.middle:
            x = (np.array(self.X[a]) + self.X[b]) / 2 + [self.r.uniform(-0.03, 0.03) for _ in range(3)]
            self.X.append([round(float(v), 8) for v in x])
            self.middle[key] = len(self.X) - 1
        return self.middle[key]

    def place(self, nodes):
        return [tuple(self.X[a]) for a in nodes]


def corners(kind):
    return {"tetra": 4, "wedge": 6, "hexahedron": 8, "pyramid": 5}[kind]


def block(entries):
    """meshio's cells of a list of (type, nodes, tag), runs of a type together."""
    cells, tags = [], []
    for kind, nodes, tag in entries:
        if not cells or cells[-1][0] != kind:
            cells.append((kind, []))
            tags.append([])
        cells[-1][1].append(nodes)
        tags[-1].append(tag)
    return [(k, np.array(n)) for k, n in cells], [np.array(t) for t in tags]


def named(kind, nodes):
    return QUADRATIC.get(kind, kind) if len(nodes) > {"tetra": 4, "wedge": 6, "hexahedron": 8, "pyramid": 5, "triangle": 3, "quad": 4, "line": 2, "vertex": 1}[kind] else kind


def entries_of(m, faces=True, lines=True, points=True, loose=True):
    solids = [(named(t, c), c, g) for t, c, g in sorted(m.cells, key=lambda e: e[0])]
    flat = [(named("triangle" if len(f) in (3, 6) else "quad", f), f, g) for f, g in m.faces] if faces else []
    flat += [("triangle", m.loose_face, 0)] if faces and loose else []
    curves = [("line", l, g) for l, g in m.lines] if lines else []
    curves += [("line", m.loose_line, 0)] if lines and loose else []
    dots = [("vertex", [a], g) for a, g in m.points] if points else []
    return solids + sorted(flat) + curves + dots


def write_msh(m, path, version, binary):
    """With names that need quotes; text and bytes by meshio."""
    cells, tags = block(entries_of(m))
    dimension = lambda kind: {"v": 0, "l": 1, "t": 2, "q": 2}.get(kind[0] if not kind.startswith("tetra") else "", 3)
    names = {}
    for (kind, _), t in zip(cells, tags):
        for g in set(map(int, t)) - {0}:
            names[f"group {g}, of /{dimension(kind)}"] = np.array([g, dimension(kind)])
    mesh = meshio.Mesh(np.array(m.X), cells, cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags}, field_data=names)
    meshio.gmsh.write(path, mesh, version, binary=binary)


def write_msh1(m, path):
    gmsh = {"vertex": 15, "line": 1, "triangle": 2, "quad": 3, "tetra": 4, "hexahedron": 5, "wedge": 6, "pyramid": 7}
    out = ["$NOD", str(len(m.X))] + [f"{i + 1} {x[0]!r} {x[1]!r} {x[2]!r}" for i, x in enumerate(m.X)] + ["$ENDNOD", "$ELM"]
    rows = entries_of(m)
    out += [str(len(rows))] + [f"{i + 1} {gmsh[k]} {g} {g} {len(n)} " + " ".join(str(a + 1) for a in n) for i, (k, n, g) in enumerate(rows)]
    path.write_text("\n".join(out + ["$ENDELM", ""]))


def write_msh41(m, path):
    """Entities with their groups, as gmsh writes them: a volume in two groups where the seed says so."""
    gmsh = {"vertex": (15, 0), "line": (1, 1), "triangle": (2, 2), "quad": (3, 2), "tetra": (4, 3), "hexahedron": (5, 3), "wedge": (6, 3), "pyramid": (7, 3),
            "tetra10": (11, 3), "hexahedron20": (17, 3), "wedge15": (18, 3), "triangle6": (9, 2), "quad8": (16, 2)}
    order = {"tetra10": [0, 1, 2, 3, 4, 5, 6, 7, 9, 8], "hexahedron20": [0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14],
             "wedge15": [0, 1, 2, 3, 4, 5, 6, 8, 12, 7, 13, 14, 9, 11, 10]}
    rows = entries_of(m)
    entities = sorted({(gmsh[k][1], g or 999) for k, _, g in rows})
    out = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$Entities", " ".join(str(sum(e[0] == d for e in entities)) for d in range(4))]
    for d, g in entities:
        box = "0 0 0" if d == 0 else "0 0 0 0 0 0"
        out.append(f"{g} {box} " + ("0" if g == 999 else f"1 {g}") + (" 0" if d else ""))
    out += ["$EndEntities", "$Nodes", f"1 {len(m.X)} 1 {len(m.X)}", f"3 {entities[-1][1]} 0 {len(m.X)}"]
    out += [str(i + 1) for i in range(len(m.X))] + [f"{x[0]!r} {x[1]!r} {x[2]!r}" for x in m.X] + ["$EndNodes", "$Elements"]
    by = collections.defaultdict(list)
    for i, (k, n, g) in enumerate(rows):
        by[k, g].append(f"{i + 1} " + " ".join(str(n[a] + 1) for a in order.get(k, range(len(n)))))
    out.append(f"{len(by)} {len(rows)} 1 {len(rows)}")
    for (k, g), lines in by.items():
        out += [f"{gmsh[k][1]} {g or 999} {gmsh[k][0]} {len(lines)}"] + lines
    path.write_text("\n".join(out + ["$EndElements", ""]))


def write_medit(m, path):
    key = {"line": "Edges", "triangle": "Triangles", "quad": "Quadrilaterals", "tetra": "Tetrahedra", "hexahedron": "Hexahedra", "wedge": "Prisms", "pyramid": "Pyramids"}
    rows = entries_of(m, points=False)
    out = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(m.X))] + [f"{x[0]!r} {x[1]!r} {x[2]!r} 0" for x in m.X]
    for k, word in key.items():
        of = [(n, g) for kind, n, g in rows if kind == k]
        if of:
            out += [word, str(len(of))] + [" ".join(str(a + 1) for a in n) + f" {g}" for n, g in of]
    path.write_text("\n".join(out + ["Corners", "1", "1", "End", ""]))


def write_unv(m, path):
    rows = entries_of(m, points=False)
    out = ["    -1", "  2411"]
    for i, x in enumerate(m.X):
        out += ["%10d%10d%10d%10d" % (i + 1, 1, 1, 11), "".join(("%25.16E" % v) for v in x)]
    out += ["    -1", "    -1", "  2412"]
    for i, (k, n, g) in enumerate(rows):
        out.append("%10d%10d%10d%10d%10d%10d" % (i + 1, UNV_TYPE[k], 1, 1, 7, len(n)))
        if k == "line":
            out.append("%10d%10d%10d" % (0, 0, 0))
        out.append("".join("%10d" % (a + 1) for a in n))
    out += ["    -1", "    -1", "  2467"]
    groups = collections.defaultdict(list)
    for i, (k, n, g) in enumerate(rows):
        if g:
            groups[g].append((8, i + 1))
    for a, g in m.points:
        groups[g].append((7, a + 1))
    for g, members in groups.items():
        out += ["%10d%10d%10d%10d%10d%10d%10d%10d" % (g, 0, 0, 0, 0, 0, 0, len(members)), f"the group {g}"]
        for i in range(0, len(members), 2):
            out.append("".join("%10d%10d%10d%10d" % (t, e, 0, 0) for t, e in members[i:i + 2]))
    path.write_text("\n".join(out + ["    -1", ""]))


def write_vtk(m, path, array, **how):
    cells, tags = block(entries_of(m))
    mesh = meshio.Mesh(np.array(m.X), cells, cell_data={array: tags, "other": [t * 2 for t in tags], "share": [t * 0.25 for t in tags]},
                       point_data={"heat": np.arange(len(m.X)) * 0.5})
    mesh.write(path, **how)


def write_by_vtk(m, path, binary):
    import vtk
    g, points = vtk.vtkUnstructuredGrid(), vtk.vtkPoints()
    points.SetDataTypeToDouble()
    for x in m.X:
        points.InsertNextPoint(x)
    g.SetPoints(points)
    tag = vtk.vtkIntArray()
    tag.SetName("MaterialIds")
    for kind, nodes, group in entries_of(m):
        ids = vtk.vtkIdList()
        for a in nodes:
            ids.InsertNextId(a)
        g.InsertNextCell(VTK_TYPE[kind], ids)
        tag.InsertNextValue(group)
    g.GetCellData().AddArray(tag)
    w = vtk.vtkXMLUnstructuredGridWriter() if path.suffix == ".vtu" else vtk.vtkUnstructuredGridWriter()
    w.SetFileName(str(path))
    w.SetInputData(g)
    if path.suffix == ".vtu":
        w.SetDataModeToAppended() if binary else w.SetDataModeToAscii()
    else:
        w.SetFileTypeToBinary() if binary else w.SetFileTypeToASCII()
    w.Write()


def write_med(m, path):
    """By meshio, which writes nodes as it is given them: MED looks at a base from within.  A group is a family, of one name."""
    order = {"tetra": [0, 2, 1, 3], "wedge": [0, 2, 1, 3, 5, 4], "hexahedron": [0, 3, 2, 1, 4, 7, 6, 5], "pyramid": [0, 3, 2, 1, 4]}
    for t, edges in EDGES.items():
        at = {frozenset(e): k for k, e in enumerate(edges)}
        order[QUADRATIC[t]] = order[t] + [corners(t) + at[frozenset((order[t][a], order[t][b]))] for a, b in edges]
    by, tags, family = collections.defaultdict(list), collections.defaultdict(list), {}
    for kind, nodes, g in entries_of(m, points=False):
        by[kind].append([nodes[k] for k in order.get(kind, range(len(nodes)))])
        tags[kind].append(-g)
        family[-g] = [f"the group {g}"]
    at = np.zeros(len(m.X), int)
    for a, g in m.points:
        at[a] = g
    mesh = meshio.Mesh(np.array(m.X), [(k, np.array(n)) for k, n in by.items()], cell_data={"cell_tags": [np.array(t) for t in tags.values()]}, point_data={"point_tags": at, "heat": at * 0.5})
    mesh.cell_tags, mesh.point_tags = {g: n for g, n in family.items() if g}, {g: [f"the group {g}"] for _, g in m.points}
    mesh.write(path, file_format="med")


def write_exodus(m, path):
    """As the manual of Exodus II says, NetCDF in its classic form.  Blocks have one kind of element, so regions are renumbered."""
    from scipy.io import netcdf_file
    sides = {"hexahedron": [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (0, 4, 7, 3), (0, 3, 2, 1), (4, 5, 6, 7)], "tetra": [(0, 1, 3), (1, 2, 3), (0, 3, 2), (0, 2, 1)],
             "wedge": [(0, 1, 4, 3), (1, 2, 5, 4), (0, 3, 5, 2), (0, 2, 1), (3, 4, 5)], "pyramid": [(0, 1, 4), (1, 2, 4), (2, 3, 4), (0, 4, 3), (0, 3, 2, 1)]}
    words = {"hexahedron": "HEX", "tetra": "TETRA", "wedge": "WEDGE", "pyramid": "PYRAMID"}
    m.cells = [(t, c, 1000 * g + list(words).index(t)) for t, c, g in m.cells]
    f = netcdf_file(path, "w")
    f.api_version, f.version, f.floating_point_word_size, f.file_size, f.title = np.float32(7), np.float32(7), np.int32(8), np.int32(1), b"random"
    made = {}

    def array(name, values, **dimensions):
        for d, n in dimensions.items():
            if d not in made:
                f.createDimension(d, n)
                made[d] = n
        v = f.createVariable(name, "d" if values.dtype.kind == "f" else "c" if values.dtype.kind == "S" else "i", tuple(dimensions))
        v[:] = values
        return v

    def names(name, texts, dimension):
        array(name, np.array([[bytes([b]) for b in t.encode().ljust(33, b"\0")] for t in texts], "S1"), **{dimension: len(texts), "len_name": 33})

    X = np.array(m.X)
    f.createDimension("num_dim", 3)
    array("node_num_map", np.arange(len(X)) * 3 + 5, num_nodes=len(X))  # first in the file, where the library sees no coordinates
    for k, axis in enumerate("xyz"):
        array(f"coord{axis}", X[:, k], num_nodes=len(X))
    blocks = collections.defaultdict(list)
    for t, c, g in m.cells:
        blocks[t, g].append(c)
    f.createDimension("num_elem", sum(map(len, blocks.values())))
    side_of, number = {}, 0
    array("eb_prop1", np.array([g for _, g in blocks], int), num_el_blk=len(blocks)).name = b"ID"
    array("eb_status", np.ones(len(blocks), int), num_el_blk=len(blocks))
    names("eb_names", [f"the group {g}" for _, g in blocks], "num_el_blk")
    for b, ((t, g), cells) in enumerate(blocks.items(), 1):
        n = corners(t)
        swap = {20: list(range(12)) + list(range(16, 20)) + list(range(12, 16)), 15: list(range(9)) + list(range(12, 15)) + list(range(9, 12))}.get(len(cells[0]), range(len(cells[0])))
        v = array(f"connect{b}", np.array([[c[k] + 1 for k in swap] for c in cells], int), **{f"num_el_in_blk{b}": len(cells), f"num_nod_per_el{b}": len(cells[0])})
        v.elem_type = f"{words[t]}{len(cells[0])}".encode()
        for c in cells:
            number += 1
            for k, side in enumerate(sides[t], 1):
                side_of[frozenset(c[a] for a in side)] = (number, k)
    sets, nodes = collections.defaultdict(list), collections.defaultdict(list)
    for face, g in m.faces:
        sets[g].append(side_of[frozenset(face[:4 if len(face) in (4, 8) else 3])])
    for n, g in [(a, g) for line, g in m.lines for a in line] + m.points:
        nodes[g].append(n)
    for word, groups, dimension in (("ss", sets, "num_side_sets"), ("ns", nodes, "num_node_sets")):
        array(f"{word}_prop1", np.array(list(groups), int), **{dimension: len(groups)}).name = b"ID"
        array(f"{word}_status", np.ones(len(groups), int), **{dimension: len(groups)})
        names(f"{word}_names", [f"the group {g}" for g in groups], dimension)
    for k, rows in enumerate(sets.values(), 1):
        array(f"elem_ss{k}", np.array([r[0] for r in rows], int), **{f"num_side_ss{k}": len(rows)})
        array(f"side_ss{k}", np.array([r[1] for r in rows], int), **{f"num_side_ss{k}": len(rows)})
    for k, rows in enumerate(nodes.values(), 1):
        array(f"node_ns{k}", np.array(rows, int) + 1, **{f"num_nod_ns{k}": len(rows)})
    f.close()


def write_deck(m, path):
    """Of decks the scene's own tests say more; here cells alone."""
    cells, tags = block(entries_of(m, False, False, False))
    meshio.Mesh(np.array(m.X), cells).write(path)
