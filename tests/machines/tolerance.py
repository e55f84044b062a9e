#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""time.tolerance on random machines: true and told error at the end over what was asked.  Truth: gauss and radau at small steps, where they
agree to a fiftieth of what is asked, with ten times as many where they do not; a machine may have none.  Writes OUT.csv, and OUT.png of the ratios in rising order.
Usage: tolerance.py BIN OUT [FAMILY:SEED | FAMILY:FIRST-LAST ...]  (30 machines of ten families unless given; BIN holds `machines` too)"""
import csv
import json
import math
import multiprocessing
import os
import subprocess
import sys
import tempfile

import h5py
import numpy

FAMILIES = "chain tree loop polygon parallelogram sprung damped floating bricard compliant"
TOLERANCES = (1e-3, 1e-4)
COLUMNS = ["place", "machine", "tolerance", "true over asked [1]", "told over asked [1]", "called", "passes", "why better"]


def solve(tools, scene, out, *more):
    """run.json of a run, {} where there is none."""
    sets = [word for key in more for word in ("--set", key)]
    try:
        done = subprocess.run([os.path.join(tools, "hilo-solve"), "--quiet", scene, "-o", out, *sets], stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, timeout=200)
    except subprocess.TimeoutExpired:
        return {}
    if done.returncode:
        return {}
    with open(out.replace(".h5", ".json")) as f:
        return json.load(f)


def ends(out):
    """Four points of each body at the end, as far from its centre as its radii of inertia."""
    with h5py.File(out) as f:
        return numpy.vstack([rows[-1].reshape(-1)[-12:].reshape(4, 3) for _, rows in sorted(f["history/body"].items())])


def apart(a, b):
    return float(numpy.linalg.norm(a - b, axis=1).max())


def truth_of(tools, scene, out, end, finer):
    """The ends, and how far two methods are apart there [m]."""
    found = []
    for method, n in (("gauss", 3000 * finer), ("radau", 6000 * finer)):
        if solve(tools, scene, out, f'time.integrator="{method}"', f"time.step={end / n!r}", 'time.error_estimate="never"'):
            found.append(ends(out))
    return (found[0], apart(*found)) if len(found) == 2 else (None, math.inf)


def judged(job):
    """Rows of a machine."""
    tools, family, seed = job
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([os.path.join(tools, "machines"), "--family", family, "--from", str(seed), "--to", str(seed), "--write", folder],
                       check=True, stdout=subprocess.DEVNULL)
        scene, out = os.path.join(folder, f"{family}-{seed}-x1", "machine.toml"), os.path.join(folder, "run.h5")
        end = [float(line.split("=")[1]) for line in open(scene) if line.startswith("end")][0]
        truth, known = truth_of(tools, scene, out, end, 1)
        for tolerance in TOLERANCES:
            row = dict(zip(COLUMNS, (0, f"{family}-{seed}", f"{tolerance:g}", math.nan, math.nan, "stopped", "", "")))
            rows.append(row)
            said = solve(tools, scene, out, f"time.tolerance={tolerance:g}", f"time.step={end / 4!r}")
            if not said:
                continue
            e, at = said["error_estimate"], ends(out)
            if known > e["asked"] / 50:
                truth, known = truth_of(tools, scene, out, end, 10)
            row[COLUMNS[4]] = e.get("end", math.nan) / e["asked"]
            row["called"] = "error not known" if "end" not in e else "chaotic" if e["chaotic"] else "met" if e["met"] else "not met"
            row["passes"] = ", ".join(f"{p['integrator']} {p['steps']}" for p in e["passes"])
            row["why better"] = e.get("why_better", "")
            if known <= e["asked"] / 50:
                row[COLUMNS[3]] = apart(at, truth) / e["asked"]
    for row in rows:
        print("| " + " | ".join(f"{x:.2g}" if isinstance(x, float) else str(x) for x in list(row.values())[1:]) + " |", flush=True)
    return rows


def main():
    tools, out, machines = os.path.abspath(sys.argv[1]), sys.argv[2], sys.argv[3:] or [f"{f}:1-3" for f in FAMILIES.split()]
    jobs = []
    for word in machines:
        family, _, seeds = word.partition(":")
        first, _, last = seeds.partition("-")
        jobs += [(tools, family, seed) for seed in range(int(first), int(last or first) + 1)]
    with multiprocessing.Pool(2) as pool:
        rows = [row for found in pool.imap(judged, jobs) for row in found]
    known = [row for row in rows if row[COLUMNS[3]] == row[COLUMNS[3]]]
    known.sort(key=lambda row: (row["tolerance"], row[COLUMNS[3]]))
    for tolerance in TOLERANCES:
        for place, row in enumerate((row for row in known if row["tolerance"] == f"{tolerance:g}"), 1):
            row["place"] = place
    with open(out + ".csv", "w") as f:
        table = csv.DictWriter(f, COLUMNS[:4])
        table.writeheader()
        table.writerows({key: row[key] for key in COLUMNS[:4]} for row in known)
    subprocess.run([os.path.join(tools, "hilo-post"), "chart", out + ".csv", "-x", "place", "-y", COLUMNS[3], "--by", "tolerance", "--log", "y", "--markers",
                    "--xlabel", "machine, in rising order", "--ylabel", "true error over asked [1]", "--title", "time.tolerance on random machines",
                    "-o", out + ".png"], check=True)
    bad = [row for row in rows if row["called"] == "stopped" or (row[COLUMNS[3]] > 2 and row["called"] not in ("chaotic", "not met"))]
    better = [row for row in known if row[COLUMNS[3]] < 0.1]
    print(f"{len(rows)} runs of {len(jobs)} machines: {len(known)} with a truth, "
          f"{sum(0.1 <= row[COLUMNS[3]] <= 2 for row in known)} of them .1 to 2, {len(better)} better than .1, "
          f"{sum(not row['why better'] for row in better)} of these without saying why; "
          f"neither met nor told: {len(bad)}" + "".join(f"\n  {row['machine']} at {row['tolerance']}" for row in bad))
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
