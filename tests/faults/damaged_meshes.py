#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged MED and Exodus files: a random bit is turned, a stretch of bytes is put elsewhere, or the end is cut off, and hilo-import reads what
is left.  It may find nothing wrong (a bit of a coordinate), or refuse with exit 2 or 4 in one line and leave no file.  It may not crash, hang
or end with an internal fault.  Their libraries were not made for such files, and libFuzzer does not see into them.

  damaged_meshes.py REPO BIN FILES [SEED]"""
import collections
import os
import random
import subprocess
import sys
import tempfile

import meshio
import numpy as np
from scipy.io import netcdf_file

tools, files, seed = os.path.abspath(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4]) if len(sys.argv) > 4 else 1
dice = random.Random(seed)
os.environ["OPENBLAS_NUM_THREADS"] = "1"
os.chdir(tempfile.mkdtemp())

n = np.array([3, 2, 4])
grid = {g: i for i, g in enumerate(np.ndindex(*(n + 1)))}
corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
cells = np.array([[grid[tuple(c)] for c in corners + at] for at in np.ndindex(*n)])
points = np.array(list(grid), float) / 10
half = len(cells) // 2
meshio.write("whole.med", meshio.Mesh(points, [("hexahedron", cells)], cell_data={"cell_tags": [np.where(np.arange(len(cells)) < half, -1, -2)]}))
with netcdf_file("whole.e", "w") as f:  # Exodus II, NetCDF in its classic form
    f.api_version, f.version, f.floating_point_word_size, f.file_size, f.title = np.float32(7), np.float32(7), np.int32(8), np.int32(1), b"blocks"
    foot = np.array([i + 1 for g, i in grid.items() if g[2] == 0])
    for name, size in (("num_dim", 3), ("num_nodes", len(points)), ("num_elem", len(cells)), ("num_el_blk", 2), ("num_node_sets", 1), ("num_nod_ns1", len(foot)),
                       ("num_el_in_blk1", half), ("num_el_in_blk2", len(cells) - half), ("num_nod_per_el1", 8), ("num_nod_per_el2", 8)):
        f.createDimension(name, size)
    for name, kind, dimensions, values in (("node_num_map", "i", ("num_nodes",), np.arange(len(points)) + 1),  # coordinates that come first are not seen
                                           ("coordx", "d", ("num_nodes",), points[:, 0]), ("coordy", "d", ("num_nodes",), points[:, 1]),
                                           ("coordz", "d", ("num_nodes",), points[:, 2]), ("eb_prop1", "i", ("num_el_blk",), [10, 20]),
                                           ("ns_prop1", "i", ("num_node_sets",), [7]), ("node_ns1", "i", ("num_nod_ns1",), foot),
                                           ("connect1", "i", ("num_el_in_blk1", "num_nod_per_el1"), cells[:half] + 1),
                                           ("connect2", "i", ("num_el_in_blk2", "num_nod_per_el2"), cells[half:] + 1)):
        f.createVariable(name, kind, dimensions)[:] = values
    f.variables["eb_prop1"].name = f.variables["ns_prop1"].name = b"ID"
    f.variables["connect1"].elem_type = f.variables["connect2"].elem_type = b"HEX8"


def damaged(whole):
    """The bytes, and what was done to them."""
    broken = bytearray(whole)
    kind = dice.choice(("bit", "bit", "bits", "moved", "cut"))
    if kind == "cut":
        del broken[dice.randrange(len(whole)):]
    elif kind == "moved":
        a, b, size = dice.randrange(len(whole)), dice.randrange(len(whole)), dice.randrange(1, 64)
        broken[a:a + size] = whole[b:b + size]
    else:
        for _ in range(1 if kind == "bit" else 8):
            broken[dice.randrange(len(whole))] ^= 1 << dice.randrange(8)
    return bytes(broken), kind


for name in ("whole.med", "whole.e"):
    subprocess.run([f"{tools}/hilo-import", name, "-o", "mesh.h5"], check=True, capture_output=True)
    os.unlink("mesh.h5")
bad = 0
for name in ("whole.med", "whole.e"):
    whole, count = open(name, "rb").read(), collections.Counter()
    for k in range(files):
        broken, kind = damaged(whole)
        given = "damaged" + os.path.splitext(name)[1]
        open(given, "wb").write(broken)
        try:
            ran = subprocess.run([f"{tools}/hilo-import", given, "-o", "mesh.h5"], capture_output=True, text=True, errors="replace", timeout=60)
        except subprocess.TimeoutExpired:
            ran = None
        left = os.path.exists("mesh.h5")
        if ran is None:
            what = "hang"
        elif ran.returncode == 0:
            what = "read" if left else "no file"
        elif ran.returncode in (2, 4):
            what = "left a file" if left else "refused" if len(ran.stderr.strip().splitlines()) == 1 else "several lines"
        else:
            what = f"exit {ran.returncode}"
        count[what] += 1
        if what not in ("read", "refused"):
            os.rename(given, f"bad-{k}-{given}")
            bad += 1
            print(f"damaged_meshes: {what}: {kind}, {os.getcwd()}/bad-{k}-{given}: {'' if ran is None else ran.stderr.strip()[-300:]}", file=sys.stderr)
        if left:
            os.unlink("mesh.h5")
    print(f"{name}: {len(whole)} bytes, {files} damaged: " + ", ".join(f"{number} {what}" for what, number in sorted(count.items())))
sys.exit(1 if bad else 0)
