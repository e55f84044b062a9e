#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the crank drive of scene.toml must do, from the kinematics and the equations of motion alone.

truth.py gas                            gauge pressure in the cylinder over time, one row per degree of crank
truth.py forces BODIES.json GAS.csv     forces of the bearings and torque over the crank angle, by the masses that `hilo-show --json` has of
                                        a rigid run

The tests hold runs against the same functions (tests/verify/crank)."""
import csv
import json
import sys
from math import cos, exp, pi, sin, sqrt

RADIUS, ROD, BORE = 0.045, 0.150, 0.086  # [m], as in crank.geo
RATE, START = 6000 * 2 * pi / 60, 0.010  # [rad/s], and the end of the smooth start [s], as in scene.toml
GRAVITY = 9.80665

# ---- Gas: four strokes from START, where the crank stands at the bottom: compression, expansion, exhaust, intake.  One zone of ideal gas,
# dp/dV = -g p/V + (g - 1)/V dQ/dV, heat by Wiebe's law [ghojel-2010]; the valves hold their pressures, and what is left when the exhaust
# valve opens blows down.
COMPRESSION = 10.5
INTAKE, EXHAUST, CASE = 0.95e5, 1.15e5, 1.0e5  # [Pa]; CASE is below the piston
HEAT = 1250                                    # [J] per cycle
BURNS_FROM, BURNS_FOR = -25, 60                # [degrees] from the top
VALVE_OPENS = 140                              # [degrees] exhaust
STROKE_VOLUME = pi / 4 * BORE**2 * 2 * RADIUS


def volume(angle):
    s, c = sin(angle * pi / 180), cos(angle * pi / 180)
    way = ROD + RADIUS - RADIUS * c - sqrt(ROD**2 - RADIUS**2 * s**2)
    return STROKE_VOLUME / (COMPRESSION - 1) + pi / 4 * BORE**2 * way


def burnt(angle):
    u = (angle - BURNS_FROM) / BURNS_FOR
    return 0 if u <= 0 else 1 - exp(-5 * u**3)


def slope(angle, p):
    """dp/dangle [Pa/degree]."""
    if angle > VALVE_OPENS:
        return -(p - EXHAUST) / 8
    d = 0.01
    dV = (volume(angle + d) - volume(angle - d)) / (2 * d)
    g = 1.35 if angle < BURNS_FROM else 1.28
    return (-g * p * dV + (g - 1) * HEAT * (burnt(angle + d) - burnt(angle - d)) / (2 * d)) / volume(angle)


def gas():
    """(t [s], gauge pressure [Pa]) of one cycle."""
    p, rows, n = INTAKE, [], 50  # n sub-steps of a degree
    for angle in range(-180, 541):
        if angle > 360:
            p = INTAKE
        rows.append((START + (angle + 180) * pi / 180 / RATE, p - CASE))
        if angle >= 180:
            target = EXHAUST if angle < 350 else INTAKE
            p = target + (p - target) * exp(-1 / 8)
            continue
        for i in range(n):
            h, a = 1 / n, angle + i / n
            k1 = slope(a, p)
            k2 = slope(a + h / 2, p + h / 2 * k1)
            k3 = slope(a + h / 2, p + h / 2 * k2)
            k4 = slope(a + h, p + h * k3)
            p += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return rows


# ---- Forces.  Plane x-z, angles positive about y: a vector d that turns at w, alpha gains w d_z, -w d_x.
#   psi = -asin(r/l sin theta)                                      the rod
#   m_p a = W + N + gas + weight                                    piston: W from the rod, N from the liner
#   m_r a = B - W + weight,  J_r alpha = (d_B x B) - (d_S x W)      rod: B from the crank
COLUMNS = ["crank angle [deg]", "side thrust [kN]", "big end along the crank [kN]", "big end across [kN]", "small end along z [kN]",
           "small end along x [kN]", "main along z [kN]", "main along x [kN]", "drive torque [N m]"]


class Body:
    """Mass, moment of inertia about y, centre of mass at the start."""

    def __init__(self, row):
        self.m, self.J, self.x, self.z = row["mass [kg]"], row["J3 [kg m^2]"], row["x [m]"], row["z [m]"]


def bodies(shown):
    """Crank, rod and piston of what hilo-show --json says; across the plane of the rod the moment is the largest."""
    return [Body(next(b for b in shown["bodies"] if part in b["body"])) for part in ("crank", "rod", "piston")]


def forces(t, push, crank, rod, piston):
    """The columns at time t under the force `push` on the crown, after the smooth start."""
    r, l, w, g = RADIUS, ROD, RATE, GRAVITY
    theta = w * (t - START / 2)
    s, c = sin(theta), cos(theta)
    sp = -r / l * s
    cp = sqrt(1 - sp * sp)
    wr = -r / l * c * w / cp
    ar = (r / l * s * w * w + sp * wr * wr) / cp
    bx, bz = -r * s * w * w, -r * c * w * w  # acceleration of the crank pin
    # from the pin to the rod's centre and to the piston pin, turned by psi
    ux, uz = cp * rod.x + sp * (rod.z - r), -sp * rod.x + cp * (rod.z - r)
    vx, vz = sp * l, cp * l
    cx, cz = bx + ar * uz - wr * wr * ux, bz - ar * ux - wr * wr * uz  # accelerations: rod's centre, piston
    pz = bz - ar * vx - wr * wr * vz
    # forces on the rod: B at the pin, -W at the piston pin
    Wz = piston.m * (pz + g) + push
    Bz = rod.m * (cz + g) + Wz
    Wx = ((vx - ux) * Wz - rod.J * ar - uz * rod.m * cx + ux * Bz) / vz
    Bx = rod.m * cx + Wx
    # crank: its centre turns about the axis
    kx, kz = c * crank.x + s * crank.z, -s * crank.x + c * crank.z
    Fx, Fz = -crank.m * w * w * kx + Bx, crank.m * (-w * w * kz + g) + Bz
    torque = r * c * Bx - r * s * Bz - kx * crank.m * g
    return [(t - START) * w * 180 / pi - 180, -Wx / 1e3, (s * Bx + c * Bz) / 1e3, (c * Bx - s * Bz) / 1e3, -Wz / 1e3, -Wx / 1e3, Fz / 1e3,
            Fx / 1e3, torque]


def main():
    out = csv.writer(sys.stdout, lineterminator="\n")
    match sys.argv[1:]:
        case ["gas"]:
            out.writerow(["t", "p"])
            out.writerows((f"{t:.15g}", f"{p:.9g}") for t, p in gas())
        case ["forces", bodies_json, gas_csv]:
            with open(bodies_json) as f:
                shown = json.load(f)
            area = next(s["area [m^2]"] for s in shown["sets"] if s["set"] == "crown")
            parts = bodies(shown)
            out.writerow(COLUMNS)
            with open(gas_csv) as f:
                for row in csv.DictReader(f):
                    out.writerow(forces(float(row["t"]), area * float(row["p"]), *parts))
        case _:
            sys.exit(__doc__)


if __name__ == "__main__":
    main()
