#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The flexible slider-crank of the IVP test set [simeon-1996]: how it starts, and where one sine mode of its rod is.

o17.py start N                   scene lines: the published velocities at the start, section by section of N cells along the rod
o17.py modes END STEP            q1 of two modes over time: the published reduced model, and the same with the axial force
o17.py table BESIDE.csv SOLID.csv    both runs beside the modes: CSV on stdout, the table on stderr; each run is "t, q1 [m], lag [m]"

A mode is M q'' = f - (K + k K_N - phi'^2 M) q about the rigid motion: k = 0 is the published reduced model, k = 1 has the axial force that
it leaves out.  The tests hold runs against the same functions (tests/verify/flexible_crank)."""
import csv
import sys
from math import cos, pi, sin, sqrt

CRANK, ROD, RATE = 0.15, 0.30, 150            # [m], [m], [rad/s]
SIDE, LINE_MASS = 0.008, 7870 * 0.008**2      # of the rod  [m], [kg/m]
SLIDER_MASS = 0.075552                        # [kg]
Q1_START, Q2_START = 0.444896105, 0.00463434311                 # published velocities of the sine modes  [m/s]
Q1_PUBLISHED, X3_PUBLISHED = 1.893192460247e-4, 0.1697373326718410  # at 0.1 s  [m]


def rigid_slider(t):
    return CRANK * cos(RATE * t) + sqrt(ROD**2 - (CRANK * sin(RATE * t)) ** 2)


def start(cells):
    """Velocities of the sections: those of the rigid rod and of two sine modes."""
    text = ""
    for i in range(cells + 1):
        s = i / cells
        v = RATE * CRANK * (1 - s) + Q1_START * sin(pi * s) + Q2_START * sin(2 * pi * s)
        spin = (-RATE * CRANK + Q1_START * pi * cos(pi * s) + Q2_START * 2 * pi * cos(2 * pi * s)) / ROD
        text += (f'\n[[initial]]\non = ["section{i}"]\nvelocity = [0, {v!r}, 0]\nspin = [0, 0, {spin!r}]\n'
                 f"about = [{CRANK + s * ROD!r}, 0, 0]\n")
    return text


def motion(t):
    """Force on the mode, stiffness by the axial force, rate of the rod's angle."""
    r, l, w, m = CRANK, ROD, RATE, LINE_MASS
    s, c = sin(w * t), cos(w * t)
    sp = -r / l * s
    cp = sqrt(1 - sp * sp)
    rate = -r / l * c * w / cp
    beta = (r / l * s * w * w + sp * rate * rate) / cp
    ax, ay = -r * c * w * w, -r * s * w * w  # of the pin
    along, across = cp * ax + sp * ay, -sp * ax + cp * ay
    f = -m * (across * 2 * l / pi + beta * l * l / pi)
    # N(x) holds the rod beyond x and the slider on its course; K_N = int N (pi/l cos(pi x/l))^2 dx
    shear = m * (across * l / 2 + beta * l * l / 3)
    N_end = (SLIDER_MASS * (r * c * w * w + l * (cp * rate * rate + sp * beta)) + shear * sp) / cp
    K_N, n = 0.0, 20
    for i in range(n):
        x = (i + 0.5) * l / n
        K_N += (N_end - m * (along * (l - x) - rate * rate * (l * l - x * x) / 2)) * (pi / l * cos(pi * x / l)) ** 2 * l / n
    return f, K_N, rate


def modes(times):
    """q1 at these times without and with the axial force: a Runge-Kutta step from each to the next."""
    M, K = LINE_MASS * ROD / 2, 2e11 * SIDE**4 / 12 * pi**4 / (2 * ROD**3)
    q, v, rows = [0.0, 0.0], [Q1_START, Q1_START], [(0.0, 0.0)]
    for before, t in zip(times, times[1:]):
        h = t - before
        at = [motion(before), motion(before + h / 2), motion(t)]
        for k in range(2):
            acceleration = lambda where, x: (where[0] - (K + k * where[1]) * x) / M + where[2] ** 2 * x
            a1 = acceleration(at[0], q[k])
            v2, a2 = v[k] + h / 2 * a1, acceleration(at[1], q[k] + h / 2 * v[k])
            v3, a3 = v[k] + h / 2 * a2, acceleration(at[1], q[k] + h / 2 * v2)
            v4, a4 = v[k] + h * a3, acceleration(at[2], q[k] + h * v3)
            q[k] += h / 6 * (v[k] + 2 * v2 + 2 * v3 + v4)
            v[k] += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
        rows.append(tuple(q))
    return rows


def columns(path):
    with open(path) as f:
        rows = list(csv.reader(f))[1:]
    return [[float(x) for x in column] for column in zip(*rows)]


def table(beside_csv, solid_csv):
    (_, beside, beside_lag), (t, solid, solid_lag) = columns(beside_csv), columns(solid_csv)
    q = modes(t)
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow(["time [s]", "solid: force beside it [mm]", "solid [mm]", "mode of the published model [mm]", "mode with the axial force [mm]"])
    for row in zip(t, beside, solid, q):
        out.writerow([f"{row[0]:.9g}"] + [f"{x * 1e3:.6g}" for x in (row[1], row[2], *row[3])])
    peak = max(abs(q0) for q0, _ in q)
    off = lambda a, b: 100 * max(abs(x - y) for x, y in zip(a, b)) / peak
    without, with_force = zip(*q)
    lag_published = X3_PUBLISHED - rigid_slider(0.1)

    def line(what, x, y=0):
        text = f"{what:<48} {x * 1e6:7.1f} {100 * (x / Q1_PUBLISHED - 1):6.1f} %"
        if y:
            text += f" {y * 1e6:16.2f} {100 * (y / lag_published - 1):6.1f} %"
        print(text, file=sys.stderr)

    print("at 0.1 s, and how far from the published value    q1 [um]            slider from the rigid one [um]", file=sys.stderr)
    line("published", Q1_PUBLISHED, lag_published)
    line("mode of the published model", without[-1])
    line("solid, the axial force beside it", beside[-1], beside_lag[-1])
    line("mode with the axial force", with_force[-1])
    line("solid", solid[-1], solid_lag[-1])
    print(f"at most, of the peak {1e6 * peak:.0f} um: solid with the force beside it off the published model's mode by {off(beside, without):.2g} %,\n"
          f"solid off the mode with the axial force by {off(solid, with_force):.2g} %; the two modes are {off(with_force, without):.2g} % apart",
          file=sys.stderr)


def main():
    match sys.argv[1:]:
        case ["start", cells]:
            print(start(int(cells)), end="")
        case ["modes", end, step]:
            n = round(float(end) / float(step))
            print("time [s],mode of the published model [m],mode with the axial force [m]")
            times = [float(step) * i for i in range(n + 1)]
            for t, q in zip(times, modes(times)):
                print(f"{t!r},{q[0]!r},{q[1]!r}")
        case ["table", beside_csv, solid_csv]:
            table(beside_csv, solid_csv)
        case _:
            sys.exit(__doc__)


if __name__ == "__main__":
    main()
