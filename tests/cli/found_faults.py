#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faults that reviews found: each scene is made here and held against a closed form, or against the same run told otherwise.

  found_faults.py BIN        all of them, as in the suite (seconds)
  found_faults.py BIN NAME   one"""
import os
import subprocess
import sys
import tempfile
import time

import h5py
import numpy

import on_ranks

tools = os.path.abspath(sys.argv[1])
on_ranks.use(tools)


def run(*command, exit=0):
    """What a command says; it ends with this exit code."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120)
    assert done.returncode == exit, f"{' '.join(command)}: exit {done.returncode}\n{done.stdout}"
    return done.stdout


def write(name, *parts):
    with open(name, "w") as file:
        file.write("\n".join(parts))


def table(section, **keys):
    """[[section]] with its keys; a text that begins with { or [ stands as it is."""
    def value(v):
        return f'"{v}"' if isinstance(v, str) and v[:1] not in "{[" else str([float(c) for c in v] if isinstance(v, list) and not isinstance(v[0], str) else v)
    return f"[[{section}]]\n" + "".join(f"{key} = {value(v)}\n" for key, v in keys.items())


def body(name, mass, com, inertia=(1, 1, 1)):
    return table("body", name=name, mass=mass, com=list(com), inertia=list(inertia))


def revolute(name, a, b, at, axis):
    return table("joint", name=name, kind="revolute", a=a, b=b, at=list(at), axis=list(axis))


def bar(path, cells, section, length, order=1):
    """A bar along z with the sets foot and tip, of bricks, or of tetrahedra of second order."""
    brick = "Recombine;" if order == 1 else ""
    write("bar.geo", f"Point(1)={{0,0,0}}; L[]=Extrude{{{section},0,0}}{{Point{{1}};Layers{{1}};}};",
          f"S[]=Extrude{{0,{section},0}}{{Line{{L[1]}};Layers{{1}};{brick}}};",
          f"V[]=Extrude{{0,0,{length}}}{{Surface{{S[1]}};Layers{{{cells}}};{brick}}};",
          'Physical Volume("arm")={V[1]}; Physical Surface("foot")={S[1]}; Physical Surface("tip")={V[0]};', f"Mesh.ElementOrder={order};")
    run("hilo-import", "--quiet", "bar.geo", "-o", "mesh.h5")
    run("hilo-tag", "--quiet", "mesh.h5", "--rest", "nonlinear", "-o", path)


STEEL = '[material.steel]\nkind = "stvk"\nE = 2.1e11\nnu = 0.3\ndensity = 7800\n[region.arm]\nmaterial = "steel"\n'


def restart_in_another_order():
    """Bodies, joints and springs keep their states where their tables stand in another order."""
    head = "gravity = [0, 0, -9.81]\n[time]\nend = 0.4\nstep = 1e-2\n"
    things, starts = [], []
    for k, name in enumerate("abc"):
        things += [body(name, 1 + k, [3 * k, 0, 0]), revolute("pin " + name, "ground", name, [3 * k - 1, 0, 0], [0, 1, 0]),
                   table("spring", name="coil " + name, kind="torsion", b=name, axis=[0, 1, 0], stiffness=2 + k)]
        starts += [table("initial", on=f'["{name}"]', velocity=[0, 0, -12 * (k + 1)], spin=[0, 12 * (k + 1), 0])]
    write("scene.toml", head, *things, *starts)
    write("other.toml", head, *reversed(things), *starts)
    run("hilo-solve", "--quiet", "scene.toml", "-o", "whole.h5", "--set", "time.end=0.8", "--checkpoint", "40steps")
    run("hilo-solve", "--quiet", "scene.toml", "-o", "run.h5", "--checkpoint", "40steps")
    run("hilo-solve", "--quiet", "other.toml", "--restart", "run.h5", "--set", "time.end=0.8")
    with h5py.File("whole.h5") as one, h5py.File("run.h5") as other:
        for group in ("body", "joint"):
            for name in one["history"][group]:
                assert numpy.allclose(one["history"][group][name], other["history"][group][name], rtol=0, atol=1e-6), f"{group} {name} differs"
        assert abs(one["history/energy"][:, 1].max()) > 100, "no spring has turned"


def restart_with_another_table():
    """A file of points that changed is another scene, whatever its name."""
    write("way.txt", "x,y,z", *(f"{x},0,{0.1 * x * x}" for x in (-1, -.5, 0, .5, 1)))
    write("scene.toml", "gravity = [0, 0, -9.81]\n[time]\nend = 0.1\nstep = 1e-2\n", body("a", 1, [.5, 0, .025]),
          table("joint", name="way", kind="point-on-curve", b="a", at=[.5, 0, .025], file="way.txt"))
    run("hilo-solve", "--quiet", "scene.toml", "-o", "run.h5", "--checkpoint", "10steps")
    write("way.txt", "x,y,z", *(f"{x},0,{0.2 * x * x}" for x in (-1, -.5, 0, .5, 1)))
    assert "joint.way.file" in run("hilo-solve", "--quiet", "--restart", "run.h5", "--set", "time.end=0.2", exit=2)


def restart_with_other_bodies():
    """A body or a section of a beam less has nothing to do with what was kept, though --accept takes other values (it broke memory)."""
    head = "[time]\nend = 0.1\nstep = 1e-2\n"
    beam = ('[material.steel]\nkind = "stvk"\nE = 2.1e9\nnu = 0.3\ndensity = 7800\n[section.bar]\nkind = "rectangle"\nwidth = 0.02\n'
            'height = 0.01\n[beam.bar]\npoints = [[0,0,0],[1,0,0]]\ncells = [3]\nsection = "bar"\nmaterial = "steel"\n')
    write("scene.toml", head, beam, *(body(name, 1, [k, 0, 5]) for k, name in enumerate("abc")))
    write("fewer.toml", head, beam, *(body(name, 1, [k, 0, 5]) for k, name in enumerate("ab")))
    run("hilo-solve", "--quiet", "scene.toml", "-o", "run.h5", "--checkpoint", "10steps")
    go_on = ["hilo-solve", "--quiet", "--restart", "run.h5", "--set", "time.end=0.2", "--accept"]
    assert "body.c is not there" in run(*go_on, "fewer.toml", exit=2)
    assert "other bodies" in run(*go_on, "--set", "beam.bar.cells=[4]", exit=2)
    run(*go_on, "--set", "body.a.mass=1.5")


def shares_beside_a_gear():
    """Two hinges in line carry half of a shaft's weight each, whatever the ratio of a gear on it; axes are no coordinate axes."""
    axis, across = numpy.array([2., 1, 2]) / 3, numpy.array([1., 2, -2]) / 3
    for ratio in (1, 1e6):
        scene = ["gravity = [0, 0, -9.81]\n[time]\nend = 0.02\nstep = 1e-2\n"]
        for k, name in enumerate("ab"):
            at = 3 * k * across
            scene += [body(name, 1 + k, at)]
            scene += [revolute(f"{name}{side}", "ground", name, at + side * axis, axis) for side in (-1, 1)]
        scene += [table("joint", name="mesh", kind="gear", a="a", b="b", at=list(across), axis=list(axis), ratio=ratio)]
        write("scene.toml", *scene)
        run("hilo-solve", "--quiet", "scene.toml", "-o", "run.h5")
        with h5py.File("run.h5") as file:
            for k, name in enumerate("ab"):
                hinges = [numpy.linalg.norm(file[f"history/joint/{name}{side}"][-1, :3]) for side in (-1, 1)]
                assert numpy.allclose(hinges, 9.81 * (1 + k) / 2, rtol=1e-9), f"ratio {ratio}, shaft {name}: {hinges}"


def factors_ask_for_more_room():
    """MUMPS on two ranks: a net of rods delays more pivots than its analysis foresees."""
    bar("bar.h5", 20, 0.05, 1)
    run("hilo-part", "--quiet", "bar.h5", "-n", "2", "-o", "parts.h5")
    m, meets = 4, {}
    scene = ['gravity = [0, 0, -9.81]\n[time]\nend = 1e-3\nstep = 1e-3\n[solver]\nkind = "direct"\n', STEEL,
             table("joint", name="root", kind="fixed", b="foot", at=[.025, .025, 0])]
    for i in range(m + 1):
        for j in range(m + 1):
            for up in (0, 1):
                if i + 1 - up <= m and j + up <= m:
                    rod = f"rod {'v' if up else 'h'}{i}{j}"
                    scene += [body(rod, 1, [i + (1 - up) / 2, j + up / 2, 1], [.02, .03, .04])]
                    meets.setdefault((i, j), []).append(rod)
                    meets.setdefault((i + 1 - up, j + up), []).append(rod)
    meets[0, 0].insert(0, "tip")
    for at, rods in meets.items():
        scene += [revolute(f"{a} to {b}", a, b, [*at, 1], [0, 0, 1]) for a, b in zip(rods, rods[1:])]
    write("scene.toml", *scene)
    run("hilo-solve", "--quiet", "scene.toml", "bar.h5", "-o", "one.h5", "--set", 'solver.kind="light"')
    run("mpirun", "-n", "2", "hilo-solve", "--quiet", "scene.toml", "parts.h5", "-o", "two.h5")
    with h5py.File("one.h5") as one, h5py.File("two.h5") as two:
        for a, b in zip(one["history/energy"][-1][:3], two["history/energy"][-1][:3]):
            assert abs(a - b) <= 1e-6 * abs(a) + 1e-9, f"energy {a} on one rank, {b} on two"


def mass_beside_its_grid():
    """A mass without inertia off the end of a cantilever is held: F L^3 / (3 E I)."""
    write("deck.bdf", "SOL 101", "CEND", "LOAD = 1", "SPC = 1", "DISP = ALL", "BEGIN BULK", "GRID,1,,0.,0.,0.", "GRID,2,,1.,0.,0.",
          "CBAR,1,1,1,2,0.,0.,1.", "PBAR,1,1,1e-4,1e-8,1e-8,2e-8", "MAT1,1,2.1e11,,.3,7800.", "CONM2,5,2,,10.,0.,0.,.3",
          "SPC1,1,123456,1", "FORCE,1,2,,1.,0.,0.,1.", "ENDDATA")
    run("hilo-import", "--quiet", "deck.bdf", "-o", "mesh.h5", "--scene-out", "scene.toml")
    with open("scene.toml", "a") as file:
        file.write("\n" + table("probe", name="tip", on="grid_2", at=[1.0, 0.0, 0.0]))
    run("hilo-solve", "--quiet", "scene.toml", "-o", "run.h5")
    with h5py.File("run.h5") as file:
        z = file["history/probe/tip"][-1][2]
    assert abs(z / (1 / (3 * 2.1e11 * 1e-8)) - 1) < 1e-4, f"tip at {z}"


def tip(*deck, name, options=()):
    """Where the end of a cantilever of one beam goes, and the force or moment of what moves it there."""
    write(name, *deck)
    run("hilo-import", "--quiet", name, "-o", "mesh.h5", "--scene-out", "scene.toml", *options)
    node = "node_2" if name.endswith("inp") else "grid_2"
    with open("scene.toml") as file:
        x = 0.5 if "--scale" in options else 1.0
        scene = file.read() + table("probe", name="tip", on=node, at=[x, 0.0, 0.0])
    write("probed.toml", scene)
    run("hilo-solve", "--quiet", "probed.toml", "-o", "run.h5")
    with h5py.File("run.h5") as file:
        joints = file["history/joint"] if "joint" in file["history"] else {}
        return file["history/probe/tip"][-1][:3] - [x, 0, 0], [numpy.linalg.norm(joints[j][-1]) for j in joints]


NASTRAN = ["SOL 101", "CEND", "LOAD = 1", "SPC = 1", "BEGIN BULK", "GRID,1,,0.,0.,0.", "GRID,2,,1.,0.,0.", "CBAR,1,1,1,2,0.,0.,1.",
           "PBAR,1,1,1e-4,1e-8,1e-8,2e-8", "MAT1,1,2.1e11,,.3,7800.", "SPC1,1,123456,1"]
ABAQUS = ["*NODE, NSET=ALL", "1,0.,0.,0.", "2,1.,0.,0.", "*ELEMENT,TYPE=B33,ELSET=E1", "1,1,2", "*BEAM SECTION,ELSET=E1,SECTION=RECT,MATERIAL=S",
          ".01,.02", "0.,0.,1.", "*MATERIAL,NAME=S", "*ELASTIC", "2.1e11,.3", "*DENSITY", "7800.", "*BOUNDARY", "1,1,6", "*STEP", "*STATIC"]


def ends_of_beams_are_moved():
    """Displacements and turns that decks prescribe of nodes of beams: 3 E I u / L^3, and E I turn / L with half of that turn's way."""
    EI, u = 2.1e11 * 1e-8, 1e-3
    held = "FORCE,1,1,,0.,0.,0.,1."  # at the root: Nastran asks for a load
    for deck in ([*NASTRAN, held, f"SPC,1,2,3,{u}", "ENDDATA"], [*NASTRAN, "SPC1,1,3,2", f"SPCD,1,2,3,{u}", "ENDDATA"]):
        way, forces = tip(*deck, name="deck.bdf")
        assert abs(way[2] / u - 1) < 1e-9 and abs(max(forces) / (3 * EI * u) - 1) < 1e-4, (way, forces)
    way, forces = tip(*NASTRAN, held, f"SPC,1,2,5,{u}", "ENDDATA", name="deck.bdf")
    assert abs(way[2] / (-u / 2) - 1) < 1e-4 and abs(max(forces) / (EI * u) - 1) < 1e-4, (way, forces)
    way, forces = tip(*ABAQUS, "*BOUNDARY", f"2,3,3,{u}", "*END STEP", name="deck.inp")
    I = .02 * .01**3 / 12
    assert abs(way[2] / u - 1) < 1e-9 and abs(max(forces) / (3 * 2.1e11 * I * u) - 1) < 1e-4, (way, forces)
    write("deck.bdf", *NASTRAN, held, f"SPC,1,2,34,{u}", "ENDDATA")
    assert "moved and turned" in run("hilo-import", "--quiet", "deck.bdf", "-o", "mesh.h5", "--scene-out", "scene.toml", exit=2)
    write("deck.bdf", *NASTRAN, "SPC1,1,3,2", f"SPCD,1,2,3,{u}", f"SPCD,1,2,3,{2 * u}", "ENDDATA")
    told = run("hilo-import", "deck.bdf", "-o", "mesh.h5", "--scene-out", "scene.toml")
    assert "SPCD of a component that another one drives: the last holds" in told, told


def equations_of_turns():
    """w of one cantilever is half the turn of another's end, F L^3/(7 E I); and .3 times that of its own end, by hand."""
    EI, beams = 2.1e11 * 1e-8, NASTRAN[:4] + ["MPC = 7"] + NASTRAN[4:]
    push, other = "FORCE,1,2,,1.,0.,0.,1.", ["GRID,3,,0.,1.,0.", "GRID,4,,1.,1.,0.", "CBAR,2,1,3,4,0.,0.,1.", "SPC1,1,123456,3"]
    way, _ = tip(*beams, *other, push, "MPC,7,2,3,1.,4,5,-.5", "ENDDATA", name="deck.bdf")
    assert abs(way[2] * 7 * EI - 1) < 1e-4, way
    pull = (1 / 3 + .15) / (1 / 3 + .15 + .15 + .09)
    way, _ = tip(*beams, push, "MPC,7,2,3,1.,2,5,-.3", "ENDDATA", name="deck.bdf")
    assert abs(way[2] * EI / ((1 - pull) / 3 - .15 * pull) - 1) < 1e-3, way


def scaled_beams():
    """A deck at half its size: a cantilever's length and section are halved, F L^3 / (3 E I) becomes twice as large."""
    deck = [*NASTRAN, "FORCE,1,2,,1.,0.,0.,1.", "ENDDATA"]
    whole, half = tip(*deck, name="deck.bdf")[0][2], tip(*deck, name="deck.bdf", options=("--scale", "0.5"))[0][2]
    assert abs(half / whole - 2) < 1e-3, f"{whole} at full size, {half} at half"


def slender_arm_by_cg():
    """Where no preconditioner does, factors go on, and the run says so: the same answer as theirs."""
    bar("arm.h5", 60, 0.01, 4, order=2)
    write("scene.toml", '[time]\nanalysis = "static"\nsteps = 1\n[solver]\nkind = "cg"\n', STEEL,
          table("motion", name="root", kind="fixed", on="foot"), table("load", name="push", kind="traction", on="tip", traction=[10, 0, 0]))
    said = run("hilo-solve", "scene.toml", "arm.h5", "-o", "one.h5")
    assert "direct from here on" in said and "does not count" not in said, said
    run("hilo-solve", "--quiet", "scene.toml", "arm.h5", "-o", "two.h5", "--set", 'solver.kind="light"')
    with h5py.File("one.h5") as one, h5py.File("two.h5") as two:
        a, b = (file["history/energy"][-1][1] for file in (one, two))
        assert abs(a / b - 1) < 1e-5, f"energy {a} by cg, {b} by factors"


def compare_many_bodies():
    """300 bodies and joints: 5700 columns of two runs, in seconds."""
    write("scene.toml", "gravity = [0, 0, -9.81]\n[time]\nend = 0.01\nstep = 1e-3\n",
          *(body(f"b{k}", 1, [k, 0, 0]) + revolute(f"j{k}", "ground", f"b{k}", [k, 1, 0], [1, 0, 0]) for k in range(300)))
    run("hilo-solve", "--quiet", "scene.toml", "-o", "run.h5")
    began = time.time()
    lines = run("hilo-post", "--quiet", "compare", "run.h5", "run.h5").splitlines()
    assert len(lines) > 5000 and time.time() - began < 20, f"{len(lines)} lines in {time.time() - began:.1f} s"


ALL = [restart_in_another_order, restart_with_another_table, restart_with_other_bodies, shares_beside_a_gear, factors_ask_for_more_room, mass_beside_its_grid,
       ends_of_beams_are_moved, equations_of_turns, scaled_beams, slender_arm_by_cg, compare_many_bodies]
failed = 0
for test in ALL:
    if len(sys.argv) > 2 and test.__name__ not in sys.argv[2:]:
        continue
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        began = time.time()
        try:
            test()
            told = "right"
        except (AssertionError, subprocess.TimeoutExpired) as fault:
            failed += 1
            told = f"WRONG: {fault}"
        print(f"{test.__name__}: {told} ({time.time() - began:.1f} s)", flush=True)
        os.chdir("/")
sys.exit(failed > 0)
