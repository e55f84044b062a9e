#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that once got a wrong answer without a word (tests/cases): each is right, or stops with the exit code it should, serial and on ranks.

  cases.py REPO BIN       serial, and the first steps on 2 ranks: in the suite
  cases.py REPO BIN all   to the end on 2 ranks as well (minutes): make -C tests ranks"""
import json
import os
import subprocess
import sys
import tempfile

import h5py
import numpy

import on_ranks

repo, tools = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
to_the_end = len(sys.argv) > 3
on_ranks.use(tools)
scenes = os.path.join(repo, "tests/cases")


def carried(points, at):
    """A material point, given at the start, over time: from the centre of its body and one point along each axis."""
    p = points.reshape(-1, 4, 3)
    axes = numpy.swapaxes(p[:, 1:] - p[:, :1], 1, 2)
    return p[:, 0] + axes @ numpy.linalg.solve(axes[0], at - p[0, 0])


def gap(run, a, b, at):
    """Largest distance between a point of body b and the same of body a, or of the ground for "" [m]."""
    at = numpy.array(at, float)
    ends = [at if body == "" else carried(run["history/body/" + body][:], at) for body in (a, b)]
    return abs(ends[1] - ends[0]).max()


def drift(run):
    """Kinetic, elastic and potential energy against the start, over the largest kinetic energy."""
    e = run["history/energy"][:]
    total = e[:, 0] + e[:, 1] + e[:, 2]
    return abs(total - total[0]).max() / e[:, 0].max()


def flat(run, told):
    return {"joints [m]": (max(gap(run, "", "crank", [0, 0, 0]), gap(run, "crank", "coupler", [1, 0, 0]),
                               gap(run, "coupler", "rocker", [4, 0, 0]), gap(run, "", "rocker", [3, 0, 0])), 1e-9)}


def chain(run, told):
    return {"energy": (drift(run), 1e-10)}


def two(run, told):
    return {"energy": (drift(run), 1e-10), "joint [m]": (gap(run, "b0", "b1", [1, 0, 0]), 1e-9)}


def moved_body(run, told):
    return {"velocity less 1 m/s": (abs(run["history/probe/cart"][:, 3] - 1).max(), 1e-12)}


def still(run, told):
    """A bar that moves along with its end has no stress; elsewhere it was 4.6e6 Pa and 1.3e3 m/s^2."""
    stress = max(abs(run["field"][k]["von_mises"][:]).max() for k in run["field"])
    return {"stress [Pa]": (stress, 0.05), "acceleration [m/s^2]": (abs(run["history/probe/tip"][:, 6:]).max(), 1e-4)}


def moved_crank(run, told):
    force = numpy.linalg.norm(run["history/joint/pin"][:, :3], axis=1)
    return {"velocities changed [m/s]": (told["velocity_change"], 1e-12), "force less 1 N": (abs(force - 1).max(), 1e-3)}


def jump(run, told):
    """1 N m on 1 kg m^2 from 0.0153 s on: a step ends there, and the acceleration is 0 up to it and 1 behind it."""
    t, a = run["history/t"][:], run["history/probe/rim"][:, 7]
    return {"no step ends at 0.0153 s": (abs(t - 0.0153).min(), 1e-12), "before": (abs(a[t < 0.0153 - 1e-9]).max(), 1e-9),
            "behind": (abs(a[t > 0.0153 + 1e-9] - 1).max(), 1e-3)}


def unstable(run, told):
    """Upright beyond its stable load: a disturbance of rounding grows by exp(12 t), to 1e-11 at 1 s, and energy stays."""
    x = run["history/probe/tip"][:, :3]
    return {"leaves by [m]": (abs(x - x[0]).max(), 1e-9), "energy [J]": (abs(run["history/energy"][:, 5]).max(), 1e-13)}


def asked(run, told):
    """A quantity beside a set of the scene: what /history and /field say of it, on ranks too."""
    q = told["quantities"][0]
    peaks = [run["field"][k]["von_mises"][:].max() for k in run["field"]]
    return {"peak over the largest of the field, less 1": (abs(q["value"] / max(peaks) - 1), 1e-6)}


def dragged(run, told):
    """A drag of .7/s on all mass: kinetic energy falls as exp(-1.4 t)."""
    e = run["history/energy"][:, 0]
    return {"energy left less exp(-2.8)": (abs(e[-1] / e[0] - numpy.exp(-2.8)), 1e-4)}


def coupled(run, told):
    """Two masses, two springs, and a damper between them: receptance of the first from 1 to 20 Hz, and the ratios of the modes."""
    out = subprocess.run(["hilo-post", "response", "run.h5", "--force", "p1.x", "--from", "1", "--to", "20", "--points", "400"], check=True,
                         capture_output=True, text=True).stdout.splitlines()
    f, size = numpy.array([line.split(",")[:2] for line in out[1:]], float).T
    w = 2 * numpy.pi * f
    m, c, k = numpy.diag([2., 3.]), 100 * numpy.array([[1., -1], [-1, 1]]), numpy.array([[7000., -3000], [-3000, 3000]])
    exact = [abs(numpy.linalg.inv(k - v * v * m + 1j * v * c)[0, 0]) for v in w]
    poles = numpy.linalg.eigvals(numpy.block([[numpy.zeros((2, 2)), numpy.eye(2)], [-numpy.linalg.solve(m, k), -numpy.linalg.solve(m, c)]]))
    ratios = sorted(-p.real / abs(p) for p in poles if p.imag > 0)
    return {"response": (abs(size / exact - 1).max(), 1e-4), "ratios": (abs(numpy.sort(run["history/mode"][1:, 1]) - ratios).max(), 1e-6)}


def two_percent(run, told):
    """`modal_damping` of .02 is that of each mode of the clamped strip."""
    return {"ratio less .02": (abs(run["history/mode"][1:, 1] - 0.02).max(), 2e-5)}


def half_a_radian(run, told):
    """50 N m on 100 N m/rad."""
    x, y = run["history/probe/p"][-1, :2]
    return {"angle less .5": (abs(numpy.arctan2(y, x) - 0.5), 1e-9)}


def leans(run, told):
    """A bar on a torsion spring: 100 angle = 150 sin(angle) + .15 cos(angle), the larger root."""
    angle = 1.5
    for _ in range(50):
        angle -= (100 * angle - 150 * numpy.sin(angle) - 0.15 * numpy.cos(angle)) / (100 - 150 * numpy.cos(angle) + 0.15 * numpy.sin(angle))
    return {"x": (abs(run["history/probe/tip"][-1, 0] - numpy.sin(angle)), 1e-8), "states": (len(run["history/t"]), 200)}


def yields(run, told):
    """250 MPa on 100 mm^2: half of the 50 kN, then flat."""
    return {"largest load less .5": (abs(run["history/path"][:, 0].max() - 0.5), 1e-3)}


# scene: exit code, truth, mesh, end of the run on 2 ranks in the suite [s]
CASES = {
    "half_turn_chain": (0, chain, "", 0.3), "half_turn_rods": (0, chain, "", 0.2), "half_turn_two": (0, two, "", 0.5),
    "flat_parallelogram": (0, flat, "", 0.02), "flat_parallelogram_driven": (0, flat, "", 0.02), "dead_point": (3, None, "", 0),
    "held_and_moved": (2, None, "", 0), "moved_body": (0, moved_body, "", 0), "moved_crank": (0, moved_crank, "", 0),
    "moved_set": (0, still, "bar", 0.001), "driven_set": (0, still, "bar", 0.001),
    "motor_jump": (0, jump, "", 0), "load_jump": (0, jump, "", 0), "static_inverted": (3, None, "block", 0)}

CASES |= {"unstable_start": (0, unstable, "", 0), "ranks_deadlock": (0, asked, "ranks_deadlock", 0.01)}
CASES |= {
    "mass_damping_rigid": (0, dragged, "mass_damping_rigid", 0), "whirl_bushing_on_rotor": (2, None, "", 0),
    "response_damper": (0, coupled, "", 0), "modal_damping": (0, two_percent, "modal_damping", 0), "bushing_angle": (0, half_a_radian, "", 0),
    "static_past_buckling": (0, leans, "", 0), "path_imperfection": (0, leans, "", 0), "path_plastic_limit": (0, yields, "path_plastic_limit", 0)}
# the scene of another case, with these changes
CHANGED = {"flat_parallelogram_driven": ("flat_parallelogram", ["joint.A.angle=6.28", 'joint.A.history={t=[0,2],value=[0,1],interpolation="smooth"}']),
           "path_imperfection": ("static_past_buckling", ['time.analysis="path"'])}
SERIAL = ("whirl_bushing_on_rotor", "response_damper", "modal_damping", "path_plastic_limit")  # modes; a path of minutes
TAGS = {"ranks_deadlock": ["--nonlinear", "arm", "--rigid", "block"], "mass_damping_rigid": ["--rigid", "blk"],
        "modal_damping": ["--linear", "strip"]}  # else all of it is nonlinear


def mesh_of(name, ranks):
    if not name:
        return []
    path = f"{name}-{ranks}.h5"
    if not os.path.exists(path):
        source = [scenes + "/bar.inp", "--regions", "bar"] if name == "bar" else [f"{scenes}/{name}.geo"]
        subprocess.run(["hilo-import", "--quiet", *source, "-o", "mesh.h5"], check=True)
        subprocess.run(["hilo-tag", "--quiet", "mesh.h5", *TAGS.get(name, ["--rest", "nonlinear"]), "-o", f"{name}-1.h5"], check=True)
        if ranks > 1:
            subprocess.run(["hilo-part", "--quiet", f"{name}-1.h5", "-n", str(ranks), "-o", path], check=True)
    return [path]


def right(name, ranks):
    code, truth, mesh, end = CASES[name]
    scene, sets = CHANGED.get(name, (name, []))
    cut = [f"time.end={end}"] if ranks > 1 and end and not to_the_end else []
    options = [word for key in sets + cut for word in ("--set", key)]
    launcher = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    done = subprocess.run([*launcher, "hilo-solve", "--quiet", *options, f"{scenes}/{scene}.toml", *mesh_of(mesh, ranks), "-o", "run.h5"],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=1500)
    ok, told = done.returncode == code, f"exit {done.returncode}"
    if ok and truth:
        with h5py.File("run.h5") as run:
            found = truth(run, json.load(open("run.json")))
        ok = all(value <= bound for value, bound in found.values())
        told = ", ".join(f"{what} {value:.1e}" for what, (value, _) in found.items())
    elif code:  # a stop says why, by name
        ok = ok and any(word in done.stdout for word in ('joint "', 'body "', 'region "', 'carries: "'))
    print(f"{name} on {ranks}: {told}" + ("" if ok else f"  WRONG\n{done.stdout[-1000:]}"), flush=True)
    return ok


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    wrong = [(name, ranks) for name in CASES for ranks in (1, 2) if ranks == 1 or name not in SERIAL if not right(name, ranks)]
sys.exit(1 if wrong else 0)
