#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""hilo's linear solvers beside PETSc's on the same matrices, by hilo's assembly, to the same tolerance, in one run: tables as Markdown.
Usage: run.py REPO BIN OUT [TABLE ...]; tables: serial, block, large, ranks, subdomains (all but large, which takes ten minutes, by default).
Every row is the best of two, taken in turn.  Meshes are made in OUT."""
import os
import subprocess
import sys

repo, tools, out = (os.path.abspath(a) for a in sys.argv[1:4])
limit = int(os.environ.get("LIMIT", 300))  # seconds that a row may take
most = int(os.environ.get("MOST", 128 if (os.cpu_count() or 1) >= 16 else 16))  # subdomains: more ranks take minutes on two cores
wanted = sys.argv[4:] or ["serial", "block", "ranks", "subdomains"]
sys.path.insert(0, os.path.join(repo, "tests/cli"))
import on_ranks

on_ranks.use(tools)
os.environ["OMP_NUM_THREADS"] = "1"
os.makedirs(out, exist_ok=True)
scene = os.path.join(repo, "data/firing/scene.toml")


def made(name, *command):
    """The file of that name in OUT, made by the command where it is not there."""
    path = os.path.join(out, name)
    if not os.path.exists(path):
        subprocess.run([*command, "-o", path], check=True, stdout=subprocess.DEVNULL)
    return path


def vehicle(size, tags, ranks):
    mesh = made(f"mesh-{size}.h5", "hilo-import", "--quiet", os.path.join(repo, "data/firing/vehicle.geo"), "--define", f"SIZE={size}")
    tagged = made(f"tags-{size}.h5", "hilo-tag", "--quiet", mesh, os.path.join(repo, "data/firing", tags))
    return tagged if ranks == 1 else made(f"parts-{size}-{ranks}.h5", "hilo-part", "--quiet", tagged, scene, "-n", str(ranks))


def solve(ranks, case, kind, tolerance, subdomains=None):
    """A row of linear-bench, or why there is none."""
    command = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    command += ["linear-bench", *map(str, case), kind, str(tolerance)] + ([str(subdomains)] if subdomains else [])
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return {"kind": kind, "failed": f"more than {limit} s"}
    lines = [line for line in done.stdout.splitlines() if line.startswith(kind + ",")]
    if not lines:
        return {"kind": kind, "failed": (done.stderr.strip().splitlines() or ["no answer"])[-1][:100]}
    f = lines[-1].split(",", 10)
    row = {"kind": kind, "unknowns": int(f[3]), "fill": float(f[4]), "set_up": float(f[5]), "solve": float(f[6]), "iterations": int(f[7]),
           "residual": f[8], "MB": int(f[9]), "name": f[10]}
    if "FAILED" in row["name"]:
        row["failed"] = row["name"].split("FAILED: ")[1]
    return row


def all_in_all(row):
    """Seconds of a Newton step with two iterations: the matrix twice, one set-up, two solves."""
    return 2 * row["fill"] + row["set_up"] + 2 * row["solve"]


def table(title, ranks, case, kinds, tolerance, rounds=2):
    best = {}
    for _ in range(rounds):
        for kind in kinds:
            row = solve(ranks, case, kind, tolerance)
            if kind not in best or ("failed" in best[kind] or ("failed" not in row and all_in_all(row) < all_in_all(best[kind]))):
                best[kind] = row
    unknowns = max((r["unknowns"] for r in best.values() if "unknowns" in r), default=0)
    print(f"\n{title} ({unknowns} unknowns, {ranks} rank{'s' if ranks > 1 else ''}, to {tolerance:g}):\n")
    print("| kind | s to fill | s of set-up | s of a solve | iterations | 2 fills, set-up, 2 solves | MB | residual |")
    print("|---|---|---|---|---|---|---|---|")
    for kind in kinds:
        r = best[kind]
        if "set_up" not in r:
            print(f"| {kind} | {r['failed']} | | | | | | |", flush=True)
            continue
        print(f"| {kind} | {r['fill']:.2f} | {r['set_up']:.2f} | {r['solve']:.2f} | {r['iterations']}{' (fails)' if 'failed' in r else ''} |"
              f" {all_in_all(r):.2f} | {r['MB']} | {r['residual']} |", flush=True)


whole = ["cg", "petsc-icc", "petsc-gamg", "petsc-hypre"]
unsymmetric = ["iterative", "petsc-ilu"]
factors = ["cholesky", "petsc-cholmod"]
substructured = ["bddc", "petsc-bddc", "petsc-bddc-deluxe", "petsc-bddc-adaptive", "feti-dp", "petsc-fetidp", "direct"]

if "serial" in wanted:
    mesh = vehicle(1, "tags.toml", 1)
    for step in (2.5e-5, 1e-4):
        table(f"Vehicle M, steps of {1e6 * step:g} us", 1, ["scene", scene, mesh, step, 0.0125], whole + unsymmetric + factors, 1e-4)
if "block" in wanted:
    for cfl, jump in ((5, 1), (50, 1), (50, 1e4)):
        table(f"Block of 40^3 cubes, CFL {cfl}, jumps of {jump:g}", 1, ["block", 40, cfl, jump, 64], whole + unsymmetric, 1e-4)
if "ranks" in wanted:
    mesh = vehicle(1, "tags.toml", 2)
    table("Vehicle M, steps of 100 us", 2, ["scene", scene, mesh, 1e-4, 0.0125], [k for k in substructured if k != "petsc-fetidp"], 1e-6)
    for jump in (1, 1e4):
        table(f"Block of 24^3 cubes, CFL 50, jumps of {jump:g}", 2, ["block", 24, 50, jump, 16], substructured, 1e-6)
if "large" in wanted:
    mesh = vehicle(2, "tags-L.toml", 2)
    for step in (2.5e-5, 2.5e-4):
        table(f"Vehicle L, steps of {1e6 * step:g} us", 2, ["scene", scene, mesh, step, 0.0125], whole + unsymmetric, 1e-4, 1)
if "subdomains" in wanted:
    kinds = ["bddc", "petsc-bddc", "petsc-bddc-deluxe", "petsc-bddc-adaptive", "feti-dp", "petsc-fetidp"]
    print("\nIterations (seconds of set-up and solve of the wall clock) by subdomains, one a rank, block of 20^3 cubes, to 1e-8:\n")
    print("| case | subdomains | " + " | ".join(kinds) + " |\n|---|---|" + "---|" * len(kinds))
    for name, cfl, jump in (("static", 1e6, 1), ("CFL 50", 50, 1), ("static, jumps of 1e4", 1e6, 1e4)):
        for n in [n for n in (2, 4, 8, 16, 32, 64, 128) if n <= most]:
            cells = []
            for kind in kinds:
                r = solve(n, ["block", 20, cfl, jump, n], kind, 1e-8)
                cells.append("fails" if "failed" in r else f"{r['iterations']} ({r['set_up'] + r['solve']:.2f})")
            print(f"| {name} | {n} | " + " | ".join(cells) + " |", flush=True)
