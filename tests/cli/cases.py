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

repo, tools = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
to_the_end = len(sys.argv) > 3
os.environ.update(PATH=tools + ":" + os.environ["PATH"], OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                  OMPI_MCA_rmaps_base_oversubscribe="1", OMPI_MCA_mpi_yield_when_idle="1", OMPI_MCA_hwloc_base_binding_policy="none",
                  OPENBLAS_NUM_THREADS="1")
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


# scene: exit code, truth, mesh, end of the run on 2 ranks in the suite [s]
CASES = {
    "half_turn_chain": (0, chain, "", 0.3), "half_turn_rods": (0, chain, "", 0.2), "half_turn_two": (0, two, "", 0.5),
    "flat_parallelogram": (0, flat, "", 0.02), "flat_parallelogram_driven": (0, flat, "", 0.02), "dead_point": (3, None, "", 0),
    "held_and_moved": (2, None, "", 0), "moved_body": (0, moved_body, "", 0), "moved_crank": (0, moved_crank, "", 0),
    "moved_set": (0, still, "bar", 0.001), "driven_set": (0, still, "bar", 0.001),
    "motor_jump": (0, jump, "", 0), "load_jump": (0, jump, "", 0), "static_inverted": (3, None, "block", 0)}

CASES |= {"unstable_start": (0, unstable, "", 0), "ranks_deadlock": (0, asked, "ranks_deadlock", 0.01)}
TAGS = {"ranks_deadlock": ["--nonlinear", "arm", "--rigid", "block"]}  # else all of it is nonlinear


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
    cut = ["--set", f"time.end={end}"] if ranks > 1 and end and not to_the_end else []
    launcher = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    done = subprocess.run([*launcher, "hilo-solve", "--quiet", *cut, f"{scenes}/{name}.toml", *mesh_of(mesh, ranks), "-o", "run.h5"],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=1500)
    ok, told = done.returncode == code, f"exit {done.returncode}"
    if ok and truth:
        with h5py.File("run.h5") as run:
            found = truth(run, json.load(open("run.json")))
        ok = all(value <= bound for value, bound in found.values())
        told = ", ".join(f"{what} {value:.1e}" for what, (value, _) in found.items())
    elif code:  # a stop says why, by name
        ok = ok and any(word in done.stdout for word in ('joint "', 'body "', 'region "'))
    print(f"{name} on {ranks}: {told}" + ("" if ok else f"  WRONG\n{done.stdout[-1000:]}"), flush=True)
    return ok


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    wrong = [(name, ranks) for name in CASES for ranks in (1, 2) if not right(name, ranks)]
sys.exit(1 if wrong else 0)
