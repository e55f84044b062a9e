#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Speed of two builds of hilo-solve, in turn in one run, so that what else the machine does falls on both: scenes of data/ of every size
that a suite can wait for, rigid and flexible, serial and on two ranks.  Prints the median of processor seconds of the steps
(`processor_seconds` of run.json) and their ratio; the first run of each is not counted.

  beside.py REPO BIN BEFORE [ROUNDS [KEY=VALUE ...]]     folders with hilo-solve after and before, 7 rounds; nothing else should run

REPO: a working tree whose scenes both builds can read, that of the older one, say.  KEY=VALUE: settings of the newer build alone, which the
older one does not know."""
import json
import os
import statistics
import subprocess
import sys
import tempfile

repo, after, before = (os.path.abspath(p) for p in sys.argv[1:4])
rounds, newer = int(sys.argv[4]) if len(sys.argv) > 4 else 7, sys.argv[5:]
sys.argv[1:] = [repo, after]
sys.path.insert(0, os.path.join(repo, "tests/cli"))
from any_ranks import SCENES, mesh_of, prepare, run  # noqa: E402

# name in SCENES, ranks, overrides
RUNS = [("firing-rigid", 1, ["time.end=0.2"]), ("firing", 1, ["time.end=0.02"]), ("firing", 2, ["time.end=0.01"]),
        ("crank", 1, ["time.end=0.004"]), ("crank-rigid", 1, ["time.end=0.04"]), ("suspension", 1, ["time.end=0.1"]),
        ("turret", 1, ["time.end=0.3"]), ("scaling-bar", 1, ["time.end=0.6"]), ("scaling-bar", 2, ["time.end=0.1"]),
        ("scaling-tube", 1, ["time.end=3e-3"]), ("scaling-turning", 1, ["time.end=0.6"]), ("stability-bricard", 1, ["time.end=150"]),
        ("stability-slider_crank", 1, ["time.end=200"])]


def seconds(solver, name, ranks, sets):
    mesh = mesh_of(name)
    if mesh and ranks > 1:
        parts = f"{name}-{ranks}.h5"
        if not os.path.exists(parts):
            run("hilo-part", "--quiet", mesh, SCENES[name][0], "-n", str(ranks), "-o", parts)
        mesh = parts
    sets = sets + (newer if solver == after else [])
    options = [word for s in sets + ["output.interval=1e3", "output.fields=[\"displacement\", \"von_mises\"]"] for word in ("--set", s)]
    launcher = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    command = [*launcher, os.path.join(solver, "hilo-solve"), "--quiet", *options, SCENES[name][0], *([mesh] if mesh else []), "-o", "beside.h5"]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode:
        raise RuntimeError(" ".join(command) + "\n" + done.stdout[-500:])
    told = json.load(open("beside.json"))
    return told["processor_seconds"], told["newton_iterations"], told["counts"]["solves"]


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    prepare()
    print(f"{'scene':24} {'ranks':>5} {'before s':>9} {'after s':>9} {'ratio':>7} {'least':>7} {'iterations':>12} {'solves':>12}")
    for name, ranks, sets in RUNS:
        try:
            took = {before: [], after: []}
            for k in range(rounds + 1):
                for solver in (before, after) if k % 2 else (after, before):
                    took[solver].append(seconds(solver, name, ranks, sets))
            b, a = ([t for t, *_ in took[s][1:]] for s in (before, after))
            print(f"{name:24} {ranks:5} {statistics.median(b):9.3f} {statistics.median(a):9.3f} {statistics.median(a) / statistics.median(b):7.3f} "
                  f"{min(a) / min(b):7.3f} {took[before][0][1]:>6} {took[after][0][1]:>5} {took[before][0][2]:>6} {took[after][0][2]:>5}", flush=True)
        except RuntimeError as e:
            print(f"{name:24} {ranks:5} {e}", flush=True)
