#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""run.xdmf says what is in run.h5: every array it points to is there with the type and shape it states, and its mixed topology, decoded by XDMF's
codes, is the mesh.  Usage: xdmf.py RUN.xdmf"""
import os
import sys
import xml.etree.ElementTree

import h5py
import numpy as np

NODES = {6: 4, 38: 10, 8: 6, 40: 15, 9: 8, 48: 20}  # of XDMF's cell types; 2 (polyline) is followed by its number of nodes
NAMES = {("Float", "8"): "f8", ("Float", "4"): "f4", ("Int", "8"): "i8", ("Int", "4"): "i4"}

path = sys.argv[1]
os.chdir(os.path.dirname(path) or ".")
grids = xml.etree.ElementTree.parse(os.path.basename(path)).findall("./Domain/Grid/Grid")
files, arrays, times = {}, 0, []
for grid in grids:
    times.append(float(grid.find("Time").get("Value")))
    for item in grid.iter("DataItem"):
        name, place = item.text.strip().split(":")
        data = files.setdefault(name, h5py.File(name))[place]
        stated = [int(n) for n in item.get("Dimensions").split()]
        assert list(data.shape) == stated, (place, data.shape, stated)
        assert data.dtype == np.dtype(NAMES[item.get("NumberType"), item.get("Precision")]), (place, data.dtype)
        arrays += 1
run = files["run.h5"] if "run.h5" in files else next(iter(files.values()))
assert np.allclose(times, [run["field"][k].attrs["t"] for k in sorted(run["field"])], rtol=1e-8, atol=0), times  # nine digits are written

topology = grids[0].find("Topology")
codes = run[topology.find("DataItem").text.strip().split(":")[1]][:]
cells, at = [], 0
while at < len(codes):
    kind = codes[at]
    first = at + (2 if kind == 2 else 1)
    at = first + (codes[at + 1] if kind == 2 else NODES[kind])
    cells.append(codes[first:at])
offset, nodes = run["mesh/cells/offset"][:], run["mesh/cells/nodes"][:]
assert len(cells) == int(topology.get("NumberOfElements")) == len(offset) - 1
assert all((cell == nodes[offset[c]:offset[c + 1]]).all() for c, cell in enumerate(cells))
print(f"{os.path.basename(path)}: {len(times)} times, {arrays} arrays as stated, {len(cells)} cells as in the mesh")
