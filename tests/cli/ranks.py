#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The firing scene on 1, 2, 3 and 4 ranks (MUMPS, and BDDC on 3; conjugate gradients on 1 and 2 and FETI-DP on 2, in dynamics; Newton at
1e-12): displacements agree to 1e-8 of the history's peak and reactions to 1e-6 of theirs, because partition, summation order and solver
change round-off only.

  ranks.py REPO BIN        some of them each day: in the suite
  ranks.py REPO BIN all    all: make -C tests ranks"""
import json
import os
import shutil
import subprocess
import sys
import tempfile

import h5py

import on_ranks
import share

repo, tools = sys.argv[1:3]
on_ranks.use(tools)
scene = os.path.join(repo, "data/firing")
sets = ["--set", "solver.tolerance=1e-12", "--set", "solver.kind=direct", "--set", "time.end=0.0125", "--set", "output.interval=0.0025"]

as_drawn = ["--set", "time.start=as given", "--set", "time.step=1e-4", "--set", "time.end=0.001", "--set", "output.interval=0.0005",
            "--set", "load.shot.history={t=[0,2.5e-3],value=[0,3e6]}"]


def run(*command):
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, timeout=300)


def difference(a, b):
    """Largest difference of displacements over their peak, and of reactions (forces and moments apart) over theirs."""
    peak = max(abs(a["field"][k]["displacement"][:]).max() for k in a["field"])
    u = max(abs(a["field"][k]["displacement"][:] - b["field"][k]["displacement"][:]).max() for k in a["field"]) / peak
    worst = 0
    for kind in ("joint", "spring"):
        for name in a["history"][kind]:
            A, B = a["history"][kind][name][:], b["history"][kind][name][:]
            for part in (slice(0, 3), slice(3, 6)):
                if abs(A[:, part]).max() > 1e-6 * abs(A).max():
                    worst = max(worst, abs(A[:, part] - B[:, part]).max() / abs(A[:, part]).max())
    return u, worst


def profile_is_whole(path, ranks):
    """The phases of run.json add up to all of it, and messages are counted where there are ranks to send to."""
    report = json.load(open(path))
    rows = report["profile"]
    parts = [row for name, row in rows.items() if name != "all"]
    seconds = sum(row["seconds"] for row in parts)
    ok = abs(seconds - rows["all"]["seconds"]) <= 1e-3 * seconds and all(row["imbalance"] >= 0.999 for row in rows.values())
    ok = ok and report["solver_bytes"] > 0 and report["result_bytes"] == os.path.getsize(path.replace(".json", ".h5"))
    if ranks == 1:
        return ok and rows["all"]["messages"] == 0 and rows["all"]["bytes_sent"] == 0
    return ok and rows["solve"]["messages"] > 0 and rows["all"]["bytes_sent"] > rows["solve"]["bytes_sent"] > 0


def agrees(kind, ranks, sets, serial):
    """Does the scene on so many ranks come out as in the serial run?"""
    mesh, mpirun = (f"parts-{ranks}.h5", ["mpirun", "-n", str(ranks)]) if ranks > 1 else ("tags.h5", [])
    solver = ["--set", "solver.kind=" + kind, "--set", "solver.linear_tolerance=1e-12"]
    run(*mpirun, "hilo-solve", "--quiet", *sets, *solver, "scene.toml", mesh, "-o", f"run-{ranks}-{kind}.h5")
    u, reaction = difference(h5py.File(serial), h5py.File(f"run-{ranks}-{kind}.h5"))
    print(f"{ranks} ranks, {kind}: displacements {u:.1e} (limit 1e-8), reactions {reaction:.1e} (limit 1e-6)")
    return u <= 1e-8 and reaction <= 1e-6 and profile_is_whole(f"run-{ranks}-{kind}.json", ranks)


with tempfile.TemporaryDirectory() as folder:
    for name in ("scene.toml", "load.csv", "tags.toml"):
        shutil.copy(os.path.join(scene, name), folder)
    os.chdir(folder)
    run("hilo-import", os.path.join(scene, "vehicle.geo"), "--define", "SIZE=0", "-o", "mesh.h5")
    run("hilo-tag", "mesh.h5", "tags.toml", "-o", "tags.h5")
    run("hilo-solve", "--quiet", *sets, "scene.toml", "tags.h5", "-o", "run-1.h5")
    failed = not profile_is_whole("run-1.json", 1)
    for n in (2, 3, 4):
        run("hilo-part", "tags.h5", "scene.toml", "-n", str(n), "-o", f"parts-{n}.h5")
    for number, (kind, n) in enumerate([("direct", 2), ("direct", 3), ("bddc", 3), ("direct", 4)]):
        if len(sys.argv) > 3 or share.today(number, 4):
            failed = not agrees(kind, n, sets, "run-1.h5") or failed
    run("hilo-solve", "--quiet", *sets, *as_drawn, "scene.toml", "tags.h5", "-o", "drawn.h5")
    for number, (kind, n) in enumerate([("cg", 1), ("cg", 2), ("feti-dp", 2)]):
        if len(sys.argv) > 3 or share.today(number, 3):
            failed = not agrees(kind, n, [*sets, *as_drawn, "--set", "solver.subdomains=4"], "drawn.h5") or failed
sys.exit(int(failed))
