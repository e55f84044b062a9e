#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the reduction of one region costs: a tube or a block of hex8 cells, held at one end, pushed at the other.

reduction.py BIN FOLDER tube NR NT NZ [HZ] | block NX NY NZ [HZ]  [-- options of hilo-reduce]

Cells have edges of 10 mm, along z of HZ metres.  Prints cells, nodes, seconds of the processor and by the clock, and gigabytes at the most."""
import os
import subprocess
import sys
import time

import numpy as np

h = 0.01


def tube(nr, nt, nz, hz):
    z, k, i = np.meshgrid(np.arange(nz + 1), np.arange(nt), np.arange(nr + 1), indexing="ij")
    r, turn = h * nt / (2 * np.pi) + h * i, 2 * np.pi * k / nt
    points = np.stack([r * np.cos(turn), r * np.sin(turn), hz * z], -1).reshape(-1, 3)
    k, j, i = [m.ravel() for m in np.meshgrid(np.arange(nz), np.arange(nt), np.arange(nr), indexing="ij")]
    return points, bricks(i, j, k, lambda i, j, k: (k * nt + j % nt) * (nr + 1) + i + 1)


def block(nx, ny, nz, hz):
    k, j, i = np.meshgrid(np.arange(nz + 1), np.arange(ny + 1), np.arange(nx + 1), indexing="ij")
    points = np.stack([h * i, h * j, hz * k], -1).reshape(-1, 3)
    k, j, i = [m.ravel() for m in np.meshgrid(np.arange(nz), np.arange(ny), np.arange(nx), indexing="ij")]
    return points, bricks(i, j, k, lambda i, j, k: (k * (ny + 1) + j) * (nx + 1) + i + 1)


def bricks(i, j, k, node):
    lower, upper = [[node(i, j, l), node(i + 1, j, l), node(i + 1, j + 1, l), node(i, j + 1, l)] for l in (k, k + 1)]
    return np.stack(lower + upper, -1)


def main():
    bin, folder, kind, *rest = os.path.abspath(sys.argv[1]), *sys.argv[2:]
    options = rest[rest.index("--") + 1:] if "--" in rest else []
    rest = rest[:rest.index("--")] if "--" in rest else rest
    hz = float(rest[3]) if len(rest) > 3 else h
    points, cells = {"tube": tube, "block": block}[kind](*map(int, rest[:3]), hz)
    os.chdir(folder)
    with open("mesh.inp", "w") as f:
        f.write("*NODE\n")
        np.savetxt(f, np.column_stack([np.arange(1, len(points) + 1), points]), fmt="%d,%.12g,%.12g,%.12g")
        f.write("*ELEMENT,TYPE=C3D8,ELSET=PIECE\n")
        np.savetxt(f, np.column_stack([np.arange(1, len(cells) + 1), cells]), fmt="%d" + ",%d" * 8)
    plane = "[set.{}]\nkind = \"plane\"\nat = [0, 0, {}]\naxis = [0, 0, 1]\nradius = 100\n"
    with open("scene.toml", "w") as f:
        f.write("[material.steel]\nE = 2.05e11\nnu = 0.3\ndensity = 7850\n[region.\"*\"]\nmaterial = \"steel\"\nmodes = 10\n"
                + plane.format("root", 0) + plane.format("tip", hz * int(rest[2]))
                + "[[motion]]\nkind = \"fixed\"\nname = \"wall\"\non = \"root\"\n"
                "[[load]]\nkind = \"force\"\nname = \"push\"\non = \"tip\"\nforce = [0, 1000, 0]\n[time]\nend = 0.01\nstep = 1e-4\n")
    tool = lambda name, *words: subprocess.run([os.path.join(bin, name), "--quiet", *words], check=True)
    tool("hilo-import", "mesh.inp", "-o", "mesh.h5")
    os.remove("mesh.inp")
    tool("hilo-tag", "mesh.h5", "--linear", "*", "-o", "tags.h5")
    clock = time.time()
    process = subprocess.Popen([os.path.join(bin, "hilo-reduce"), "scene.toml", "tags.h5", "-o", "reduced.h5", *options])
    _, status, used = os.wait4(process.pid, 0)
    print(f"{len(cells)} cells, {len(points)} nodes: {used.ru_utime + used.ru_stime:.1f} s, {time.time() - clock:.1f} s by the clock, "
          f"{used.ru_maxrss / 1e6:.2f} GB")
    sys.exit(os.waitstatus_to_exitcode(status))


main()
