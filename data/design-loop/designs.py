#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The books of the design loop: names of designs, a line for each, the table and the points of the chart.

designs.py cases SWEEP.txt                     names of the designs: t8_k100_c6 is 8 mm, 100 kN/m, 6 kN s/m
designs.py header                              the names of the columns of designs.csv
designs.py row NAME DENSITY STATUS FILE...     one design as a line of designs.csv, from its status and the mesh, peak and injury tables
designs.py table DESIGNS.csv                   for people; * marks the front: none is as good in mass, stress and DRI and better in one
designs.py pareto DESIGNS.csv                  for the chart: of each thickness the front of stress and DRI as a line, the others as points
                                               between lines without numbers, which break a curve
"""
import csv
import os
import sys

HEADER = ["design", "thickness [mm]", "stiffness [kN/m]", "damping [kN s/m]", "state", "mass [kg]", "stress [MPa]", "DRI [1]", "exit",
          "message"]


def cases(sweep):
    names = {}  # in order, once each
    with open(sweep) as f:
        for number, line in enumerate(f, 1):
            values = line.split()
            if not values or values[0].startswith("#"):
                continue
            if len(values) != 3:
                sys.exit(f"{sweep}:{number}: expected thickness, stiffness and damping, comma-separated values without blanks")
            thickness, stiffness, damping = (v.split(",") for v in values)
            names |= {f"t{t}_k{k}_c{c}": None for t in thickness for k in stiffness for c in damping}
    return names


def row(name, density, status_file, files):
    with open(status_file) as f:
        status = dict(line.rstrip("\n").split("=", 1) for line in f if "=" in line)
    mass = stress = dri = ""
    if status["state"] == "done":
        for path in files:
            with open(path) as f:
                if path.endswith(".csv"):  # of hilo-post injury
                    driver = next(r for r in csv.DictReader(f) if r["sensor"] == "driver")
                    dri = next(v for k, v in driver.items() if k.startswith("DRI"))
                    continue
                cheeks = next((line.split() for line in f if line.split()[:1] == ["cheeks"]), None)
            if not cheeks:
                continue
            if os.path.basename(path) == "peak.txt":
                stress = f"{float(cheeks[1]):.1f}"
            else:  # the table of hilo-import: region, cells, volume
                mass = f"{float(cheeks[2]) * density:.2f}"
    state = "converged" if status["state"] == "done" else "failed"
    values = [v[1:] for v in name.split("_")]
    message = status.get("message", "").replace('"', '""')
    return ",".join([name, *values, state, mass, stress, dri, status.get("exit", "0")]) + f',"{message}"'


def designs(path):
    with open(path) as f:
        return list(csv.DictReader(f))


def beaten(a, all_designs):
    wanted = ["mass [kg]", "stress [MPa]", "DRI [1]"]
    mine = [float(a[w]) for w in wanted]
    for b in all_designs:
        if b["state"] == "converged":
            theirs = [float(b[w]) for w in wanted]
            if theirs != mine and all(x <= y for x, y in zip(theirs, mine)):
                return True
    return False


def table(all_designs):
    print(f"  {'design':<18} {'mass [kg]':>9} {'[MPa]':>9} {'DRI':>9}  state")
    failed = 0
    for d in all_designs:
        if d["state"] == "converged":
            mark = " " if beaten(d, all_designs) else "*"
            print(f"{mark} {d['design']:<18} {d['mass [kg]']:>9} {d['stress [MPa]']:>9} {d['DRI [1]']:>9}  converged")
        else:
            failed += 1
            print(f"  {d['design']:<18} {'-':>9} {'-':>9} {'-':>9}  failed, exit {d['exit']}: {d['message']}")
    print(f"{len(all_designs)} designs, {failed} failed; *: none is better in one of mass, stress and DRI and as good in the others")


def pareto(all_designs):
    print("cheeks,stress [MPa],DRI [1]")
    by_thickness = {}
    for d in all_designs:
        if d["state"] == "converged":
            by_thickness.setdefault(d["thickness [mm]"], []).append(d)
    for thickness, group in by_thickness.items():
        label = f'"{thickness} mm, {float(group[-1]["mass [kg]"]):.1f} kg"'
        least, rest = float("inf"), []
        for d in sorted(group, key=lambda d: float(d["stress [MPa]"])):
            point = f"{label},{d['stress [MPa]']},{d['DRI [1]']}"
            if float(d["DRI [1]"]) < least:
                least = float(d["DRI [1]"])
                print(point)
            else:
                rest += [f"{label},,", point]
        print("\n".join(rest + [""]), end="")


def main():
    match sys.argv[1:]:
        case ["cases", sweep]:
            print("\n".join(cases(sweep)))
        case ["header"]:
            print(",".join(HEADER))
        case ["row", name, density, status, *files]:
            print(row(name, float(density), status, files))
        case ["table", path]:
            table(designs(path))
        case ["pareto", path]:
            pareto(designs(path))
        case _:
            sys.exit(__doc__)


if __name__ == "__main__":
    main()
