# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that the drills stop in the middle (fault_drill.py, power_cuts.py), and what their results have in common."""
import os
import subprocess
import sys

import h5py


def joint(kind, name, a, b, at, more=""):
    return f'[[joint]]\nkind = "{kind}"\nname = "{name}"\na = "{a}"\nb = "{b}"\nat = {at}\n{more}\n'


def body(name, com, more=""):
    return f'[[body]]\nname = "{name}"\nmass = 2\ncom = {com}\ninertia = [0.05, 0.05, 0.05]\n{more}\n'


Z, GRAVITY = "axis = [0, 0, 1]", "gravity = [0, -9.81, 0]\n"
PENDULUM = GRAVITY + body("arm", [0.3, 0, 0]) + joint("revolute", "pin", "ground", "arm", [0, 0, 0], Z)
J2 = 'kind = "j2"\nyield = 2e4\nhardening = 1e6\n'
SHAKEN = "history = {t = [0, 0.01, 0.03, 1], value = [0, 1, -1, 0]}\n"
STATIC = "steps = 30\n[solver]\ntolerance = 1e-10\n"


def solid(gravity, E, held, law="", damping="damping = 1e-4\n"):
    return (f'gravity = [0, 0, {gravity}]\n[material.m]\n{law}E = {E}\nnu = 0.3\ndensity = 1000\n[region."*"]\nmaterial = "m"\n{damping}'
            f'[[motion]]\nkind = "fixed"\nname = "{held}"\non = "{held}"\n')


def bar(law="", damping="damping = 1e-4\n"):
    return solid(-9.81, 1e8, "root", law, damping)


def pull(force, on="tip"):
    return f'[[load]]\nkind = "force"\nname = "shake"\non = "{on}"\nforce = {force}\n'


END = "[time]\nend = {end}\nstep = {step}\n[output]\ninterval = {interval}\n[solver]\ntolerance = 1e-10\n"


def short(step=5e-3, steps=60):
    return END.format(end=step * steps, step=step, interval=step * steps / 9)


# name: scene, its mesh if any, numbers of ranks
SCENES = {
    "rigid": (PENDULUM + body("bob", [0.6, -0.3, 0]) + joint("spherical", "link", "arm", "bob", [0.6, 0, 0]) + short(), "", [1]),
    "friction and stops": (
        PENDULUM + '[[stop]]\nkind = "angle"\nname = "limit"\njoint = "pin"\nlower = -0.4\nupper = 0.4\nstiffness = 2e3\nrestitution = 0.6\n'
        '[[friction]]\nname = "rub"\njoint = "pin"\ncoefficient = 0.2\nradius = 0.05\nslip_velocity = 1e-2\n' + short(), "", [1]),
    "driven": (
        GRAVITY + body("arm", [0.3, 0, 0]) + body("bob", [0.6, -0.3, 0]) + joint("spherical", "link", "arm", "bob", [0.6, 0, 0]) +
        joint("revolute", "pin", "ground", "arm", [0, 0, 0],
              Z + '\nangle = 2\nhistory = {t = [0, 0.1, 0.2, 1], value = [0, 0.2, 1, 1], interpolation = "smooth"}') + short(), "", [1, 2]),
    "redundant": (
        GRAVITY + body("crank", [0, 0.5, 0]) + body("rocker", [1, 0.5, 0]) + body("coupler", [0.5, 1, 0]) +
        joint("revolute", "A0", "ground", "crank", [0, 0, 0], Z) + joint("revolute", "B0", "crank", "coupler", [0, 1, 0], Z) +
        joint("revolute", "A1", "ground", "rocker", [1, 0, 0], Z) + joint("revolute", "B1", "rocker", "coupler", [1, 1, 0], Z) +
        '[[initial]]\non = ["crank"]\nspin = [0, 0, -3]\n' + short(), "", [1]),
    "flexible": (bar() + pull([0, 0, -200]) + SHAKEN + short(1e-3), "bar.h5", [1, 2]),
    "plastic": (bar(J2) + pull([0, 0, -400]) + SHAKEN + short(1e-3), "bar.h5", [1]),
    "parallel": (
        bar() + pull([0, 0, -200]) + SHAKEN + body("bob", [1, 0.05, -0.3]) +
        joint("spherical", "hang", "tip", "bob", [1, 0.05, 0.05]) + short(1e-3), "bar.h5", [3, 2]),
}


CONTACT = """[[obstacle]]
kind = "plane"
name = "floor"
at = [0, 0, 0]
axis = [0, 1, 0]
[[obstacle]]
kind = "sphere"
name = "skin"
on = "ball"
at = [0.1, 0.15, 0]
radius = 0.1
[[contact]]
name = "bounce"
a = "floor"
b = "skin"
stiffness = 1e5
friction = 0.3
"""
SCENES |= {
    "contact": (
        GRAVITY + body("ball", [0.1, 0.15, 0]) +
        '[[initial]]\non = ["ball"]\nvelocity = [1.5, -1, 0]\n' +
        CONTACT + short(2e-3), "", [1, 2]),
    "gauss": (PENDULUM + body("bob", [0.6, -0.3, 0]) + joint("spherical", "link", "arm", "bob", [0.6, 0, 0]) +
              short(2e-2).replace("[time]\n", '[time]\nintegrator = "gauss"\n'), "", [1]),
    "static, plastic": (bar(J2, "") + pull([0, 0, -40]) + SHAKEN + '[time]\nanalysis = "static"\nend = 0.01\n' + STATIC, "bar.h5", [1]),
    "path": (bar("", "") + pull([0, 0, -200]) + '[time]\nanalysis = "path"\n' + STATIC, "bar.h5", [1]),
    "modes": (bar() + '[time]\nanalysis = "modes"\nmodes = 12\n', "bar.h5", [1]),
}


# Two blocks of other meshes, "high" on "low", that rub on each other or are tied.  On ranks such runs are solved by `direct`, whose last bits
# differ from run to run, so that nothing is equal bit by bit.
BLOCKS = solid(-200, 1e7, "base")
SCENES |= {
    "surface contact": (BLOCKS + '[[contact]]\nname = "rub"\na = "low"\nb = "high"\nfriction = 0.3\n'
                        '[[initial]]\non = ["high"]\nvelocity = [0.4, 0.1, -0.1]\n' + short(1e-3), "blocks.h5", [1]),
    "tie": (BLOCKS + '[[tie]]\nname = "weld"\na = "low"\nb = "high"\n' + pull([300, 0, 0], "top") +
            SHAKEN + short(1e-3), "blocks.h5", [1]),
}


def block(name, at, size, cells, first):
    """Lines of nodes and of elements of a block of hexahedra in an .inp deck, its nodes numbered from `first` on."""
    nx, ny, nz = cells
    number = {}
    nodes, elements = [], []
    for k in range(nz + 1):
        for j in range(ny + 1):
            for i in range(nx + 1):
                number[i, j, k] = first + len(nodes)
                place = [a + s * n / c for a, s, n, c in zip(at, size, (i, j, k), cells)]
                nodes.append(f"{number[i, j, k]}, {place[0]}, {place[1]}, {place[2]}")
    for k in range(nz):
        for j in range(ny):
            for i in range(nx):
                corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                elements.append(", ".join(str(n) for n in [first + len(elements)] + [number[c + (z,)] for z in (k, k + 1) for c in corners]))
    ends = [", ".join(str(number[i, j, k]) for j in range(ny + 1) for i in range(nx + 1)) for k in (0, nz)]
    return nodes, [f"*ELEMENT, TYPE=C3D8, ELSET={name}"] + elements, ends


def make_meshes(repo):
    """bar.h5 and blocks.h5 in this folder."""
    low, high = block("low", (0, 0, 0), (0.3, 0.3, 0.1), (2, 2, 1), 1), block("high", (0.04, 0.03, 0.1), (0.2, 0.2, 0.1), (3, 3, 1), 101)
    with open("blocks.inp", "w") as f:
        f.write("\n".join(["*NODE", *low[0], *high[0], *low[1], *high[1], "*NSET, NSET=base", low[2][0], "*NSET, NSET=top", high[2][1],
                           "*SOLID SECTION, ELSET=low, MATERIAL=m", "*SOLID SECTION, ELSET=high, MATERIAL=m", "*MATERIAL, NAME=m"]) + "\n")
    for deck, mesh in ((os.path.join(repo, "tests/cases/bar.inp"), "bar.h5"), ("blocks.inp", "blocks.h5")):
        made = run(["hilo-import", deck, "-o", mesh])
        if made.returncode:
            sys.exit(made.stderr)


def command(name, ranks, *more):
    scene, mesh, _ = SCENES[name]
    launcher = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    return launcher + ["hilo-solve", *more]


def scene_files(name):
    scene, mesh, _ = SCENES[name]
    with open("scene.toml", "w") as f:
        f.write(scene)
    return ["scene.toml"] + ([mesh] if mesh else [])


def run(line, **more):
    return subprocess.run(line, capture_output=True, text=True, timeout=300, **more)


def numbers(path):
    """All arrays of numbers of a results file."""
    out = {}
    with h5py.File(path, "r") as f:

        def visit(name, thing):
            if isinstance(thing, h5py.Dataset) and thing.dtype.kind in "fiu":
                out[name] = thing[()]

        f.visititems(visit)
    return out


def same(a, b, tolerance=0.0):
    """Names of arrays that differ."""
    own = {"parts/rank", "history/newton", "history/constraint"} if tolerance else set()  # of the ranks, or round-off alone
    bad = sorted((set(a) ^ set(b)) - own)
    for name in sorted((set(a) & set(b)) - own):
        x, y = a[name], b[name]
        if x.shape != y.shape:
            bad.append(name)
        elif tolerance == 0 and x.tobytes() != y.tobytes():
            bad.append(name)
        elif tolerance and x.size and x.dtype.kind == "f":
            scale = abs(y[..., :]).max() if y.ndim else abs(y)
            if name in ("history/energy", "history/momentum"):
                scale = max(scale, 1.0)
            if abs(x - y).max() > tolerance * max(scale, 1e-12):
                bad.append(name)
    return bad
