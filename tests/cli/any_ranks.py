#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""An answer belongs to the scene: not to the number of ranks, and not to which rank has which cell.

Every scene of data/ with its mesh of size S, cut off after a few steps: serial, and on several ranks with the cells divided by hilo-part (by
the scene's work, and by number of cells), at random, and so that one rank has all flexible cells, another all rigid ones and the rest
none.  Newton at 1e-12; then unknowns and steps are the same numbers, displacements agree to 1e-8 of their peak, stresses, forces and
probes to 1e-6, because partition and order of summation change round-off only.

  any_ranks.py REPO BIN         a third of some of them, another one each day: in the suite
  any_ranks.py REPO BIN all     all on 2, 3, 4, 5 and 7 ranks, and some on 1: make -C tests ranks
  any_ranks.py REPO BIN NAME N  one scene on N ranks"""
import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile

import h5py
import numpy

import on_ranks
import share

repo, tools = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
on_ranks.use(tools)

# name: scene, how its mesh is made (geometry and options of hilo-import), options of hilo-tag, overrides of the scene
BLOCK = "stability/block.geo"
SCENES = {
    "crank": ("crank/scene.toml", ["crank/crank.geo", "--define", "SIZE=0"], ["crank/tags-flexible.toml"], ["time.end=1e-3"]),
    "crank-rigid": ("crank/scene.toml", ["crank/crank.geo", "--define", "SIZE=0"], ["crank/tags-rigid.toml"], ["time.end=3e-4"]),
    "firing": ("firing/scene.toml", ["firing/vehicle.geo", "--define", "SIZE=0"], ["firing/tags.toml"], ["time.end=2.5e-3"]),
    "firing-flexible": ("firing/scene.toml", ["firing/vehicle.geo", "--define", "SIZE=0"], ["firing/tags-flexible.toml"],
                        ["time.end=5e-4"]),
    "firing-rigid": ("firing/scene.toml", ["firing/vehicle.geo", "--define", "SIZE=0"], ["firing/tags-rigid.toml"], ["time.end=2.5e-3"]),
    "suspension": ("suspension/scene.toml", ["suspension/suspension.geo", "--define", "SIZE=0"], ["suspension/tags-flexible.toml"],
                   ["time.end=5e-3"]),
    "suspension-rigid": ("suspension/scene.toml", ["suspension/suspension.geo", "--define", "SIZE=0"], ["suspension/tags-rigid.toml"],
                         ["time.end=1e-2"]),
    "turret": ("turret/scene.toml", ["turret/turret.geo", "--trust", "--define", "SIZE=0"], ["turret/tags-flexible.toml"], ["time.end=0.0125"]),
    "turret-rigid": ("turret/scene.toml", ["turret/turret.geo", "--trust", "--define", "SIZE=0"], ["turret/tags-rigid.toml"], ["time.end=0.025"]),
    "design-loop": ("design-loop/scene.toml", ["design-loop/gun.geo", "--define", "thickness=8e-3"],
                    ["--nonlinear", "cheeks", "--rest", "rigid"], ["time.end=2.5e-3"]),
    "loader-rigid": ("loader/scene.toml", ["loader/loader.geo"], ["loader/tags.toml"], ["time.end=0.6"]),
    "tour": ("tour.toml", ["tour/arm.step"], ["--nonlinear", "arm", "--rigid", "block"], ["time.end=0.01"]),
    "scaling-bar": ("scaling/bar.toml", ["bar.inp", "--regions", "bar"], ["--rest", "nonlinear"], ["time.end=0.02"]),
    "scaling-tube": ("scaling/tube.toml", ["tube.inp", "--regions", "tube"], ["--rest", "nonlinear"], ["time.end=3e-4"]),
    "scaling-turning": ("scaling/turning.toml", ["turning.inp", "--regions", "bar"], ["--rest", "nonlinear"], ["time.end=0.004"]),
    "charts-beam": ("charts/scenes/beam.toml", [BLOCK, "--define", "NX=8"], ["--rest", "nonlinear"], ["time.end=0.1"]),
    "cantilever": ("stability/scenes/cantilever.toml", [BLOCK, "--define", "NX=8"], ["--rest", "nonlinear"], []),
    "stability-elastic_pendulum": ("stability/scenes/elastic_pendulum.toml", ["stability/truss.inp", "--rest", "bars"], [], []),
    "stability-arch": ("stability/scenes/arch.toml", ["stability/arch.inp", "--rest", "bars"], [], []),
    "stability-step_bar": ("stability/scenes/step_bar.toml", ["stability/bars.inp", "--rest", "bars"], [], []),
    "stability-tumbling_bar": ("stability/scenes/tumbling_bar.toml", [BLOCK], [], []),
    "stability-rod_and_beam": ("stability/scenes/rod_and_beam.toml", [BLOCK], [], []),
    "stability-spin_up": ("stability/scenes/spin_up.toml", [BLOCK, "--define", "B=0.02", "--define", "H=0.02", "--define", "NX=6"], [], []),
}
for name in ("bricard", "brick", "double_four_bar", "double_rod", "light_bob", "light_tip", "long_short", "near_joints", "needle",
             "parallelogram", "slider_crank", "stiffness_ratio", "top"):
    SCENES["stability-" + name] = (f"stability/scenes/{name}.toml", [], [], [])
for name in ("elastic_pendulum", "slider_crank"):
    SCENES["charts-" + name] = (f"charts/scenes/{name}.toml", [], [], [])
BASE = ["solver.tolerance=1e-12", "solver.linear_tolerance=1e-12"]
SUITE = [("crank", 2, "scene"), ("crank", 2, "uniform"), ("crank", 3, "random"), ("crank", 4, "lopsided"), ("suspension-rigid", 3, "random"),
         ("design-loop", 5, "random"), ("stability-rod_and_beam", 3, "uniform"), ("stability-rod_and_beam", 7, "random"),
         ("stability-elastic_pendulum", 4, "random"), ("cantilever", 2, "random"), ("stability-bricard", 2, "-"), ("stability-light_bob", 3, "-")]


def run(*command, **more):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=600, **more)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)}: exit {done.returncode}\n{done.stdout[-2000:]}")
    return done.stdout


def prepare():
    """data/ without results, and what some scenes make themselves."""
    shutil.copytree(os.path.join(repo, "data"), "data", ignore=shutil.ignore_patterns("out"))
    os.chdir("data")
    os.makedirs("crank/out")
    run("bash", "-c", "crank/truth.py gas > crank/out/gas.csv")
    run("bash", "-c", "scaling/bar.sh 20 2 2 > bar.inp; scaling/bar.sh 20 2 2 > turning.inp; scaling/tube.sh 12 2 10 > tube.inp")
    tour = open(os.path.join(repo, "docs/tour.md")).read()
    open("tour.toml", "w").write(tour.split("cat > scene.toml <<'END'\n")[1].split("END\n")[0])
    words = next(shlex.split(line) for line in tour.splitlines() if line.startswith("hilo-import arm.step") and "-o mesh.h5" in line)
    SCENES["tour"][1].extend(word for word in words[2:] if word not in ("-o", "mesh.h5"))


def step_of(scene):
    for line in open(scene):
        if line.startswith("step ="):
            return float(line.split("=")[1].split("#")[0])
    return 0


def mesh_of(name):
    """The tagged mesh of a scene, made once; "" for one of bodies alone."""
    _, geometry, tags, _ = SCENES[name]
    if not geometry:
        return ""
    if not os.path.exists(name + ".h5"):
        run("hilo-import", "--quiet", *geometry, "-o", name + "-mesh.h5")
        run("hilo-tag", "--quiet", name + "-mesh.h5", *(tags or ["--rest", "nonlinear"]), "-o", name + ".h5")
    return name + ".h5"


def solve(name, mesh, out, ranks):
    scene, _, _, sets = SCENES[name]
    step = step_of(scene)
    sets = BASE + (sets or ([f"time.end={8 * step:.12g}"] if step else []))  # one without a step is static
    if step:
        sets.append("output.interval=1e-4")
    options = [word for s in sets for word in ("--set", s)]
    launcher = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    run(*launcher, "hilo-solve", "--quiet", *options, scene, *([mesh] if mesh else []), "-o", out)


def divide(name, mesh, ranks, how):
    """A parts file, or None where hilo-part has a reason not to make it."""
    parts = f"{name}-{ranks}-{how}.h5"
    scene = [SCENES[name][0]] if how == "scene" else []
    try:
        run("hilo-part", "--quiet", mesh, *scene, "-n", str(ranks), "--weights", "uniform", "-o", parts)
        if how == "scene":
            run("hilo-part", "--quiet", mesh, *scene, "-n", str(ranks), "-o", parts)
    except RuntimeError as e:
        if how in ("scene", "uniform"):
            print(f"  {name} on {ranks} ranks, {how}: hilo-part: {str(e).splitlines()[-1][-100:]}")
            return None
        run("hilo-part", "--quiet", mesh, "-n", "1", "-o", parts)
    if how in ("random", "lopsided"):
        with h5py.File(parts, "r+") as f:
            cells = f["parts/rank"]
            for what in (f, cells):
                what.attrs.pop("fnv1a64", None), what.attrs.pop("attributes_fnv1a64", None)  # of what hilo-part wrote
            if how == "random":
                cells[:] = numpy.random.default_rng(ranks).integers(0, ranks, len(cells))
            else:
                with h5py.File(mesh) as t:
                    rigid = numpy.array([word == b"rigid" for word in t["tags/fidelity"][:]])
                    cells[:] = numpy.where(rigid[t["mesh/cells/region"][:]], 0, ranks - 1)
            cells.attrs["n_parts"] = numpy.int64(ranks)
    return parts


def difference(path_a, path_b):
    """Of displacements over their peak; of the peak stress; of forces, moments, positions, velocities and accelerations over theirs."""
    worst, where = {"displacement": 0.0, "stress": 0.0, "history": 0.0}, ""
    length = json.load(open(path_a.replace(".h5", ".json")))["length"]
    with h5py.File(path_a) as a, h5py.File(path_b) as b:
        for kind, field in (("displacement", "displacement"), ("stress", "von_mises")):
            steps = [k for k in a.get("field", {}) if field in a["field"][k]]
            if steps and a["field"][max(steps)].attrs["t"] == 0:
                raise RuntimeError(f"{path_a} has no {field} but those of the start")
            peak = max((abs(a["field"][k][field][:]).max() for k in steps), default=0)
            if kind == "displacement":  # equilibrium leaves the angle of what turns freely to rounding, 1e-12 of the scene
                peak = max(peak, 1e-3 * length)
            for k in steps:
                if peak > 0:
                    worst[kind] = max(worst[kind], abs(a["field"][k][field][:] - b["field"][k][field][:]).max() / peak)
        if a["history/t"].shape != b["history/t"].shape:
            return {"displacement": 9, "stress": 9, "history": 9}, f"{len(a['history/t'])} and {len(b['history/t'])} times"
        # A force 1e4 below the largest is round-off of the others; so are differences of velocities and accelerations below 1e-12 L/h, L/h^2.
        h = numpy.diff(a["history/t"][:]).min(initial=1)
        forces = ("joint", "spring", "stop", "motor", "friction", "motion")
        largest = [max((abs(a["history"][k][n][:, 3 * p:3 * p + 3]).max() for k in forces for n in a["history"].get(k, {})), default=0)
                   for p in (0, 1)]
        floors = {k: [1e-4 * f for f in largest] for k in forces}
        floors |= {"probe": [1e-6 * length / h**p for p in (0, 1, 2)], "sensor": [1e-6 * length / h**2 / 9.8]}
        for kind, floor in floors.items():
            for n in a["history"].get(kind, {}):
                for p in range(len(floor)):
                    A, B = a["history"][kind][n][:, 3 * p:3 * p + 3], b["history"][kind][n][:, 3 * p:3 * p + 3]
                    scale = max(abs(A).max(), floor[p])
                    if scale == 0:
                        continue
                    d = abs(A - B).max() / scale
                    if not d <= worst["history"]:
                        worst["history"], where = d, f"{kind} {n}, part {p}"
    return worst, where


# stress: positions agree to 2e-14 m, which in steel and cells of .25 m is 0.02 Pa: rounding, where the stress has only begun to grow
LIMITS = {"displacement": 1e-8, "stress": 5e-6, "history": 1e-6}
ROUNDED = {"stability-light_bob": {"history": 1e-4},  # 1e8 N/m times the rounding of a metre, beside a force of 1e-3 N
           "stability-spin_up": {"stress": 5e-5, "history": 2e-5},  # eight steps from rest: 2e-15 m times E, beside a peak of 170 Pa
           "stability-near_joints": {"history": 5e-3},  # 5e4 N on a lever of 0.1 mm: 5e-7 of them, beside a force that is zero
           "firing": {"history": 4e-5},  # before the shot, as below
           "firing-flexible": {"history": 4e-5}}  # the trunnion's moment before the shot is 1e-4 of the largest, so 4e-9 of that


def agrees(name, ranks, how):
    mesh = mesh_of(name)
    serial = name + "-run.h5"
    if not os.path.exists(serial):
        solve(name, mesh, serial, 1)
    parts = divide(name, mesh, ranks, how) if mesh else ""
    if parts is None:
        return True
    out = f"{name}-{ranks}-{how}-run.h5"
    try:
        solve(name, parts, out, ranks)
    except (RuntimeError, subprocess.TimeoutExpired) as e:
        print(f"{name} on {ranks} ranks, {how}: FAILED: {e}", flush=True)
        return False
    a, b = (json.load(open(p.replace(".h5", ".json"))) for p in (serial, out))
    worst, where = difference(serial, out)
    same = all(a[key] == b[key] for key in ("unknowns", "steps", "bodies", "joint_rows", "redundant_rows"))
    ok = same and all(worst[k] <= ROUNDED.get(name, {}).get(k, LIMITS[k]) for k in worst)
    told = ", ".join(f"{k} {worst[k]:.0e}" for k in worst)
    print(f"{name} on {ranks} ranks, {how} ({b['solver']}): {b['unknowns']} unknowns, {b['steps']} steps, {told}"
          + ("" if ok else f"  WRONG (serial: {a['unknowns']} unknowns, {a['steps']} steps; {where})"), flush=True)
    for path in (out, parts):
        if path:
            os.remove(path)
    return ok


def everything():
    for name in SCENES:
        hows = ("scene", "uniform", "random", "lopsided") if SCENES[name][1] else ("-",)
        for ranks in (2, 3, 4, 5, 7):
            for how in hows:
                yield name, ranks, how
        if name in ("crank", "design-loop"):
            yield name, 1, "random"


def chosen():
    if len(sys.argv) == 3:
        return [what for number, what in enumerate(SUITE) if share.today(number, 3)]
    if sys.argv[3] == "all":
        return everything()
    return [w for w in everything() if w[0] == sys.argv[3] and (len(sys.argv) < 5 or w[1] == int(sys.argv[4]))]


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        prepare()
        wrong = [what for what in chosen() if not agrees(*what)]
        print(f"{len(wrong)} wrong: {wrong}" if wrong else "all agree")
    sys.exit(1 if wrong else 0)
