#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""run.h5 is a VTKHDF file.  /VTKHDF is read here as VTK's page "VTKHDF file format" lays down version 2.0, with h5py alone: points, cells and
every field of every step are those of the mesh and of /field.  Where Python has VTK 9.3 or later its own reader must say the same.
Usage: vtkhdf.py RUN.h5..."""
import sys

import h5py
import numpy as np

VTK_TYPE = {"bar2": 3, "tri3": 5, "quad4": 9, "tet4": 10, "hex8": 12, "hex8r": 12, "wedge6": 13, "tri6": 22, "quad8": 23, "tet10": 24, "hex20": 25,
            "hex20r": 25, "wedge15": 26}  # vtkCellType.h
CORNERS = {5: 3, 9: 4, 22: 3, 23: 4}
NODES = {3: 2, 5: 3, 9: 4, 10: 4, 12: 8, 13: 6, 22: 6, 23: 8, 24: 10, 25: 20, 26: 15}


def number(group, name, k):
    return int(group[name][k].item())


def instant(root, k):
    """Points, types, cells and fields of a step, by its offsets."""
    steps = root["Steps"]
    assert number(steps, "NumberOfParts", k) == 1
    part = number(steps, "PartOffsets", k)
    n, n_cells, n_ids = (number(root, "NumberOf" + what, part) for what in ("Points", "Cells", "ConnectivityIds"))
    at, cell, first = number(steps, "PointOffsets", k), number(steps, "CellOffsets", k), number(steps, "ConnectivityIdOffsets", k)
    X = root["Points"][at:at + n]
    types = root["Types"][cell:cell + n_cells]
    offsets = root["Offsets"][cell:cell + n_cells + 1]
    ids = root["Connectivity"][first:first + n_ids]
    assert X.shape == (n, 3) and types.shape == (n_cells,) and offsets[0] == 0 and offsets[-1] == n_ids and ids.shape == (n_ids,)
    fields = {}
    for centre, count in (("Point", n), ("Cell", n_cells)):
        for name, data in root.get(centre + "Data", {}).items():
            begin = number(steps[centre + "DataOffsets"], name, k)
            fields[centre, name] = data[begin:begin + count]
            assert len(fields[centre, name]) == count, name
    return X, types, np.split(ids, offsets[1:-1]), fields


def check(path):
    compared = 0
    with h5py.File(path) as run:
        root = run["VTKHDF"]
        assert list(root.attrs["Version"]) == [2, 0] and root.attrs["Version"].dtype.kind == "i"
        kind = h5py.h5a.open(root.id, b"Type").get_type()
        assert root.attrs["Type"] == b"UnstructuredGrid" and not kind.is_variable_str() and kind.get_cset() == h5py.h5t.CSET_ASCII
        keys = sorted(run["field"])
        assert root["Steps"].attrs["NSteps"] == len(keys)
        assert root["Steps/Values"][:].tolist() == [run["field"][key].attrs["t"] for key in keys]
        mesh = run["mesh"]
        rows = run["skin/node"][:] if "skin" in run else np.arange(len(mesh["nodes/X"]))
        for k, key in enumerate(keys):
            X, types, cells, fields = instant(root, k)
            assert (X == mesh["nodes/X"][:][rows]).all()
            offset, nodes = mesh["cells/offset"][:], mesh["cells/nodes"][:]
            if "skin" in run:  # facets: flat here, and they close: the sum of their normals by region is zero
                normal = {}
                for kind, cell, region in zip(types, cells, fields["Cell", "region"]):
                    assert len(cell) == NODES[kind]
                    x = X[cell[:CORNERS[kind]]]
                    turn = np.cross(x, np.roll(x, -1, axis=0)).sum(axis=0) / 2
                    normal[region] = normal.get(region, 0) + np.append(turn, np.linalg.norm(turn))
                assert all(np.linalg.norm(n[:3]) < 1e-9 * n[3] for n in normal.values()), normal
            else:
                assert len(cells) == len(offset) - 1
                assert all((cell == nodes[offset[c]:offset[c + 1]]).all() and NODES[types[c]] == len(cell) for c, cell in enumerate(cells))
                assert (fields["Cell", "region"] == mesh["cells/region"][:]).all()
            for name, own in run["field"][key].items():
                seen = fields["Cell" if name.startswith("cell_") else "Point", name]
                assert seen.dtype == own.dtype and (seen == own[:]).all(), (key, name)
                compared += own.size
            for name, own in run.get("envelope", {}).items():
                seen = fields["Point", name[:-5] + "_envelope_time" if name.endswith("_time") else name + "_envelope"]
                assert (seen == own[:]).all(), name
            known = len(run["field"][key]) + len(run.get("envelope", {})) + 1
            assert len(fields) == known, (sorted(fields), known)
        shared = by_vtk(path, root)
    print(f"{path}: {len(keys)} steps, {len(types)} cells, {compared} values as in the run{shared}")


def by_vtk(path, root):
    """The same with VTK's own reader, where Python has one that knows steps."""
    try:
        import vtk
        from vtk.util.numpy_support import vtk_to_numpy
    except ImportError:
        return ""
    if (vtk.vtkVersion.GetVTKMajorVersion(), vtk.vtkVersion.GetVTKMinorVersion()) < (9, 3):
        return ""
    reader = vtk.vtkHDFReader()
    assert reader.CanReadFile(path)
    reader.SetFileName(path)
    reader.UpdateInformation()
    n_steps = root["Steps"].attrs["NSteps"]
    assert reader.GetNumberOfSteps() == n_steps
    for k in range(n_steps):
        reader.SetStep(k)
        reader.Update()
        grid = reader.GetOutput()
        X, types, cells, fields = instant(root, k)
        assert (vtk_to_numpy(grid.GetPoints().GetData()) == X).all()
        assert (vtk_to_numpy(grid.GetCellTypesArray()) == types).all()
        assert (vtk_to_numpy(grid.GetCells().GetConnectivityArray()) == np.concatenate(cells)).all()
        for (centre, name), own in fields.items():
            array = (grid.GetPointData() if centre == "Point" else grid.GetCellData()).GetArray(name)
            assert array is not None and (vtk_to_numpy(array) == own).all(), (k, name)
    return f", and by VTK {vtk.vtkVersion.GetVTKVersion()}"


if __name__ == "__main__":
    for path in sys.argv[1:]:
        check(path)
