#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Two bars with *EQUATION of reference nodes and of their turns, and *COUPLING of some displacements, through ccx and through hilo: the same
displacements.  And a plate of shells turned by 30 degrees, held and pushed in axes of *TRANSFORM, against the same plate in the axes of the model.

  tests/cli/ccx_links.py REPO BIN

ccx answers linearly, so loads are multiplied by 1e-4, and displacements divided by that.  The limit is that of the digits which ccx prints and of
sines of angles of 1e-6. A node that is coupled along x stays in a plane that turns with the body, by 1e-5 here.  For the plate that of Newton's tolerance."""
import math, os, re, shutil, subprocess, sys, tempfile
import h5py
import numpy as np

SMALL = 1e-4
binaries = os.path.abspath(sys.argv[2])
if not shutil.which("ccx"):
    print("ccx_links: no ccx (apt-get install calculix-ccx)")
    sys.exit(77)


def run(*command):
    ran = subprocess.run(command, capture_output=True, text=True, timeout=100)
    if ran.returncode:
        sys.exit(f"{' '.join(command)}: exit {ran.returncode}\n{ran.stdout[-500:]}{ran.stderr[-500:]}")
    return ran.stderr


def listed(name, numbers, kind="*NSET, NSET"):
    return [f"{kind}={name}"] + [", ".join(map(str, numbers[i:i + 8])) + ("," if i + 8 < len(numbers) else "") for i in range(0, len(numbers), 8)]


def bar(first, y0, X):
    """Five cells of 20 nodes along x; its nodes on x = 0, x = 10, and one between."""
    at = {}

    def node(i, j, k):
        if (i, j, k) not in at:
            at[i, j, k] = first + len(at)
            X[at[i, j, k]] = (float(i), y0 + j / 2, k / 2)
        return at[i, j, k]

    corners = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
    middles = [(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2), (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]
    cells = [[node(2 * c + i, j, k) for i, j, k in corners + middles] for c in range(5)]
    return cells, [v for (i, j, k), v in at.items() if i == 0], [v for (i, j, k), v in at.items() if i == 10], at[6, 2, 2]


def bars(model, step):
    X = {}
    one, one_root, one_tip, between = bar(1, 0.0, X)
    two, two_root, two_tip, _ = bar(501, 3.0, X)
    out = ["*NODE, NSET=all"] + [f"{n}, {x}, {y}, {z}" for n, (x, y, z) in X.items()]
    out += ["1001, 10., 0.5, 0.5", "1002, 10., 3.5, 0.5", "1003, 10., 0.5, 0.5", "1004, 10., 3.5, 0.5", "*ELEMENT, TYPE=C3D20, ELSET=cells"]
    for e, c in enumerate(one + two):
        out += [f"{e + 1}, " + ", ".join(map(str, c[:10])) + ",", ", ".join(map(str, c[10:]))]
    out += listed("roots", one_root + two_root) + listed("tip1", one_tip) + listed("tip2", two_tip)
    out += ["*MATERIAL, NAME=m", "*ELASTIC", "210000., .3", "*SOLID SECTION, ELSET=cells, MATERIAL=m"] + model
    out += ["*BOUNDARY", "roots, 1, 3", "*STEP", "*STATIC"] + step + ["*NODE PRINT, NSET=all", "U", "*END STEP"]
    return "\n".join(out).replace("BETWEEN", str(between)) + "\n"


def solve(name, *options):
    """Displacements of the nodes by number, of loads multiplied by SMALL; and what was not read."""
    talk = run(binaries + "/hilo-import", name + ".inp", "-o", "mesh.h5", "--scene-out", "scene.toml", *options)
    lost = [line for line in talk.splitlines() if "not read" in line and "*NODE PRINT" not in line]
    scale = lambda m: m[1] + re.sub(r"[-+.\deE]+", lambda n: repr(float(float(n[0]) * SMALL)), m[2])
    scene = re.sub(r"^((?:force|torque|displacement) = )(.*)$", scale, open("scene.toml").read(), flags=re.M)
    with open("scene.toml", "w") as f:
        f.write(scene + "\n[solver]\ntolerance = 1e-12\n")
    run(binaries + "/hilo-solve", "--quiet", "scene.toml", "mesh.h5", "-o", "run.h5")
    with h5py.File("run.h5") as f, h5py.File("mesh.h5") as m:
        u = f["field"][sorted(f["field"])[-1]]["displacement"][:] / SMALL
        return {int(n): u[i] for i, n in enumerate(m["/mesh/nodes/id"][:])}, lost


rigid = ["*RIGID BODY, NSET=tip1, REF NODE=1001, ROT NODE=1003", "*RIGID BODY, NSET=tip2, REF NODE=1002, ROT NODE=1004"]
coupled = ["*SURFACE, NAME=end, TYPE=NODE", "tip1", "*COUPLING, REF NODE=1001, SURFACE=end, CONSTRAINT NAME=c", "*KINEMATIC"]
DECKS = {
    "of reference nodes": (rigid + ["*EQUATION", "2", "1002, 2, 3., 1001, 2, 2."], ["*CLOAD", "1001, 2, 5.", "1001, 3, 3."]),
    "of a node and reference nodes": (rigid + ["*EQUATION", "3", "1002, 3, 3., 1001, 3, 2., BETWEEN, 3, 1."], ["*CLOAD", "1001, 3, 5.", "1002, 1, 9."]),
    "of turns": (rigid + ["*EQUATION", "2", "1004, 1, 1., 1003, 1, -2."], ["*CLOAD", "1003, 1, 20.", "1001, 3, 3."]),
    "of a turn and a displacement": (rigid + ["*EQUATION", "2", "1002, 2, 1., 1003, 3, 4."], ["*CLOAD", "1001, 2, 5."]),
    "y and z coupled": (coupled + ["2, 3"], ["*BOUNDARY", "1001, 1, 1", "1001, 4, 6", "*CLOAD", "1001, 2, 5.", "1001, 3, 3."]),
    "x coupled": (coupled + ["1, 1"], ["*BOUNDARY", "1001, 2, 4", "*CLOAD", "1001, 1, 50.", "1001, 5, 40."]),
}
bad = 0
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for name, (model, step) in DECKS.items():
        with open("deck.inp", "w") as f:
            f.write(bars(model, step))
        run("ccx", "deck")
        rows = [l.split() for l in open("deck.dat") if re.match(r" +\d+ +-?\d\.\d+E", l)]
        theirs = {int(r[0]): [float(v) for v in r[1:4]] for r in rows}
        ours, lost = solve("deck")
        nodes = [n for n in theirs if n in ours]
        exact = np.array([theirs[n] for n in nodes])
        off = abs(np.array([ours[n] for n in nodes]) - exact).max() / abs(exact).max()
        wrong = bool(lost) or len(nodes) < 100 or not off < (1e-4 if name == "x coupled" else 3e-6)
        bad += wrong
        print(f"{name:<32}{len(nodes):>4} nodes  largest u {abs(exact).max():.4g}  difference {off:.1e}{'  WRONG ' if wrong else ''}" + "".join(lost))

    # a plate of 6 x 4 shells, clamped along the left edge, guided along the lower one, pushed at a corner
    def plate(angle, held, turned):
        c, s = math.cos(angle), math.sin(angle)
        axes = ["*TRANSFORM, NSET=all", f"{c!r}, {s!r}, 0., {-s!r}, {c!r}, 0."] if turned else []
        number = lambda i, j: 1 + i + 7 * j
        out = ["*NODE, NSET=all"] + [f"{number(i, j)}, {c * i - s * j!r}, {s * i + c * j!r}, 0." for j in range(5) for i in range(7)]
        out += ["*ELEMENT, TYPE=S4, ELSET=plate"] + [f"{1 + i + 6 * j}, {number(i, j)}, {number(i + 1, j)}, {number(i + 1, j + 1)}, {number(i, j + 1)}" for j in range(4) for i in range(6)]
        out += listed("left", [number(0, j) for j in range(5)]) + listed("low", [number(i, 0) for i in range(1, 7)])
        out += ["*MATERIAL, NAME=m", "*ELASTIC", "210000., .3", "*SHELL SECTION, ELSET=plate, MATERIAL=m", "0.1"] + axes
        out += ["*BOUNDARY"] + held + ["*STEP", "*STATIC", "*CLOAD", f"{number(6, 4)}, 1, 2.", f"{number(6, 4)}, 2, 3.", f"{number(6, 4)}, 3, .02", "*END STEP"]
        return "\n".join(out) + "\n"

    for what, held in (("a clamp", ["left, 1, 6"]), ("a guide", ["left, 1, 6", "low, 2, 2"]), ("a moved edge", ["left, 1, 6", "low, 2, 2, 0.02"]), ("turns held", ["left, 1, 3", "low, 2, 4"])):
        answers = []
        for angle in (0, math.pi / 6):
            with open("plate.inp", "w") as f:
                f.write(plate(angle, held, angle != 0))
            ours, lost = solve("plate", "--thicken")
            with h5py.File("mesh.h5") as m, h5py.File("run.h5") as f:
                X, u = m["/mesh/nodes/X"][:], f["field"][sorted(f["field"])[-1]]["displacement"][:] / SMALL
            back = np.array([[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]])
            X, u = X @ back, u @ back
            order = np.lexsort(np.round(X, 6).T)
            answers.append((X[order], u[order]))
        off = abs(answers[0][1] - answers[1][1]).max() / abs(answers[0][1]).max()
        wrong = bool(lost) or abs(answers[0][0] - answers[1][0]).max() > 1e-6 or not off < 1e-6
        bad += wrong
        print(f"{'shells, ' + what:<32}{len(X):>4} nodes  largest u {abs(answers[0][1]).max():.4g}  difference {off:.1e}{'  WRONG ' if wrong else ''}" + "".join(lost))
sys.exit(bad > 0)
