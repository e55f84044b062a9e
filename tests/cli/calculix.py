# SPDX-License-Identifier: GPL-3.0-or-later
"""What the comparisons with CalculiX share: the decks of calculix-ccx-test, cards of a deck, what ccx writes, and the same deck through hilo."""
import gzip
import os
import pathlib
import re
import shutil
import subprocess
import sys

import h5py
import numpy as np

FOLDER = "/usr/share/doc/calculix-ccx-test/examples/test/"
EDGES = {4: [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],  # of a cell by its corners, in the order of their middle nodes
         6: [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
         8: [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]}
HEXAHEDRON = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]  # places of its corners
os.environ["OMP_NUM_THREADS"] = "1"


def tools(need_ccx=True, need_decks=True):
    """The folder of hilo's tools, which the second argument names and where `run` finds them.  Without a package that is needed this ends."""
    if need_decks and not os.path.isdir(FOLDER):
        sys.exit(f"no {FOLDER} (apt-get install calculix-ccx-test)")
    if need_ccx and shutil.which("ccx") is None:
        print("this system has no CalculiX to compare with")
        sys.exit(77)
    folder = os.path.abspath(sys.argv[2])
    os.environ["PATH"] = folder + ":" + os.environ["PATH"]
    return folder


def run(*command):
    """What the command says on stderr."""
    ran = subprocess.run(command, capture_output=True, text=True, timeout=200)
    if ran.returncode:
        raise RuntimeError(f"{' '.join(command)}: exit {ran.returncode}\n{ran.stdout[-500:]}{ran.stderr[-500:]}")
    return ran.stderr


def stored(name):
    """Text of a file of the package, or nothing where the package has none of that name."""
    path = FOLDER + name
    if os.path.exists(path):
        return open(path, errors="replace").read()
    return gzip.open(path + ".gz", "rt", errors="replace").read() if os.path.exists(path + ".gz") else ""


def unpack(folder):
    """All decks of the package."""
    for source in pathlib.Path(FOLDER).glob("*.inp*"):
        data = source.read_bytes()
        (folder / source.name.removesuffix(".gz")).write_bytes(gzip.decompress(data) if source.suffix == ".gz" else data)


def write(path, text):
    with open(path, "w") as f:
        f.write(text)


def node_cards(points, name="ALL"):
    """Points are {number: x}, or a list from number 1 on.  CalculiX reads twenty characters of a number."""
    numbered = points.items() if isinstance(points, dict) else enumerate(points, 1)
    return [f"*NODE, NSET={name}"] + [f"{i}, {x[0]:.12g}, {x[1]:.12g}, {x[2]:.12g}" for i, x in numbered]


def cell_cards(kind, name, cells):
    """Cells are {number: nodes}, or a list from number 1 on."""
    lines = [f"*ELEMENT, TYPE={kind}, ELSET={name}"]
    for i, nodes in cells.items() if isinstance(cells, dict) else enumerate(cells, 1):
        lines += [f"{i}, " + ", ".join(map(str, nodes[:10])) + ("," if len(nodes) > 10 else "")]
        lines += [", ".join(map(str, nodes[10:]))] if len(nodes) > 10 else []
    return lines


def block(low, high, n, order=2, node=1, cell=1):
    """Hexahedra: nodes by their place on its grid, their points, and cells by their place: number and nodes."""
    low, high, n = np.array(low), np.array(high), np.array(n)
    number, X, cells = {}, {}, {}
    for at in np.ndindex(*n):
        c = order * (HEXAHEDRON + np.array(at))
        nodes = []
        for g in [*c, *[(c[a] + c[b]) // 2 for a, b in EDGES[8] if order == 2]]:
            if tuple(g) not in number:
                number[tuple(g)] = node + len(X)
                X[number[tuple(g)]] = low + (high - low) * g / (order * n)
            nodes.append(number[tuple(g)])
        cells[at] = (cell + len(cells), nodes)
    return number, X, cells


def set_cards(name, nodes):
    return [f"*NSET, NSET={name}"] + [f"{k}," for k in nodes]


def printed(lines):
    """{time: {node: displacement}} of the lines of a .dat file."""
    blocks, block = {}, None
    for line in lines:
        field = line.split()
        if line.startswith(" displacements (vx,vy,vz)"):
            block = blocks.setdefault(float(field[-1]), {})
        elif block is not None and len(field) == 4 and field[0].isdigit():
            block[int(field[0])] = [float(x) for x in field[1:]]
        elif field:
            block = None
    return blocks


def plotted(lines):
    """{time: {field: {node: values}}} of the lines of a .frd file: twelve columns for a number."""
    all_of, field, time = {}, None, 0.0
    for line in lines:
        if line.startswith("  100CL"):
            time = float(line[12:24])
        elif line.startswith(" -4"):
            field = all_of.setdefault(time, {}).setdefault(line.split()[1], {})
        elif line.startswith(" -1") and field is not None:
            field[int(line[3:13])] = [float(line[k:k + 12]) for k in range(13, len(line.rstrip()), 12)]
        elif line.startswith(" -3"):
            field = None
    return all_of


def last(blocks):
    return blocks[max(blocks)]


def von_mises(s):
    """Of rows xx, yy, zz, xy, yz, zx."""
    return np.sqrt(((s[:, 0] - s[:, 1])**2 + (s[:, 1] - s[:, 2])**2 + (s[:, 2] - s[:, 0])**2) / 2 + 3 * (s[:, 3:]**2).sum(1))


def last_field(name):
    with h5py.File("run.h5") as f:
        return f["field"][sorted(f["field"])[-1]][name][:]


def not_read(said):
    """Lines of hilo-import on what it did not read, but for requests of output."""
    return [line for line in said.splitlines() if "not read" in line and not re.search("request for output|(NODE|EL) PRINT", line)]


def imported(deck, *options):
    """deck.inp as mesh.h5 and scene.toml: what was not read of it."""
    return not_read(run("hilo-import", deck + ".inp", "-o", "mesh.h5", "--scene-out", "scene.toml", *options))


def solved(more="", small=1.0, *options):
    """Displacements by node at the end of scene.toml and `more`: of loads multiplied by `small`, then divided by it, as ccx answers linearly."""
    scale = lambda m: m[1] + re.sub(r"[-+.\deE]+", lambda number: repr(float(float(number[0]) * small)), m[2])
    scene = open("scene.toml").read()
    if small != 1:
        scene = re.sub(r"^((?:force|torque|pressure|gravity|displacement) = )(.*)$", scale, scene, flags=re.M)
    write("scene.toml", scene + more)
    run("hilo-solve", "--quiet", "scene.toml", "mesh.h5", "-o", "run.h5", *options)
    with h5py.File("mesh.h5") as m:
        return dict(zip(m["/mesh/nodes/id"][:].tolist(), last_field("displacement") / small))


def apart(ours, theirs):
    """Nodes that both have, their largest displacement, and the largest difference divided by it."""
    nodes = [n for n in theirs if n in ours]
    if not nodes:
        raise RuntimeError("no node in common")
    a, b = (np.array([one[n] for n in nodes]) for one in (ours, theirs))
    return len(nodes), abs(b).max(), abs(a - b).max() / abs(b).max()
