#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the ring of the turret must carry, by the laws of momentum, over the times of a run:

truth.py BODIES.json MOTION.csv > HAND.csv

BODIES.json is what `hilo-show --json` says of the rigid run, MOTION.csv `hilo-post series RUN.h5 momentum probe.turret`.  All but the
chassis turns about the ring's axis at x = AXIS, y = 0.  Forces are on the chassis, forward along the gun, to the right and down.  The tests
hold runs against the same functions (tests/verify/turret)."""
import csv
import json
import sys

AXIS = -0.50       # [m]
GRAVITY = 9.80665  # [m/s^2]


def turning(bodies):
    """Sums of m, m (x - AXIS) and m y of what turns, the gun pointing forward."""
    m = mx = my = 0.0
    for b in bodies:
        if b["body"] != "chassis":
            m += b["mass [kg]"]
            mx += b["mass [kg]"] * (b["x [m]"] - AXIS)
            my += b["mass [kg]"] * b["y [m]"]
    return m, mx, my


def by_hand(m, mx, my, rows):
    """Rate of angular momentum about the ring's axis, and the force of masses on circles, at every row but the first and last."""
    t = [row["t [s]"] for row in rows]
    L = [row["momentum.Lz [kg m^2/s]"] - AXIS * row["momentum.py [kg m/s]"] for row in rows]
    omega = []
    for row in rows:
        x, y = row["probe.turret.x [m]"] - AXIS, row["probe.turret.y [m]"]
        omega.append((x * row["probe.turret.vy [m/s]"] - y * row["probe.turret.vx [m/s]"]) / (x * x + y * y))
    for i in range(1, len(t) - 1):
        span = t[i + 1] - t[i - 1]
        alpha = (omega[i + 1] - omega[i - 1]) / span
        yield [t[i], (L[i + 1] - L[i - 1]) / span, mx * omega[i]**2 + my * alpha, mx * alpha - my * omega[i]**2, m * GRAVITY]


def main():
    bodies_json, motion_csv = sys.argv[1:]
    with open(bodies_json) as f:
        m, mx, my = turning(json.load(f)["bodies"])
    with open(motion_csv) as f:
        rows = [{name: float(x) for name, x in row.items()} for row in csv.DictReader(f)]
    print(f"{m:.0f} kg turn, their centre {(mx * mx + my * my)**0.5 / m:.4f} m off the axis", file=sys.stderr)
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow(["t [s]", "torque [N m]", "forward [N]", "right [N]", "down [N]"])
    out.writerows(by_hand(m, mx, my, rows))


if __name__ == "__main__":
    main()
