# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the probes of the charts' scenes are at the end: closed forms, published values, and Runge-Kutta on one to six coordinates
that know neither joints nor multipliers.  Lengths in m; each returns (x, y, z), NaN where nothing is known."""
from math import asin, cos, pi, sin, sqrt


def rk4(rate, y, end, n):
    """Classical Runge-Kutta, n steps."""
    h = end / n
    for _ in range(n):
        k1 = rate(y)
        k2 = rate([a + h / 2 * b for a, b in zip(y, k1)])
        k3 = rate([a + h / 2 * b for a, b in zip(y, k2)])
        k4 = rate([a + h * b for a, b in zip(y, k3)])
        y = [a + h / 6 * (b + 2 * c + 2 * d + e) for a, b, c, d, e in zip(y, k1, k2, k3, k4)]
    return y


def jacobi_sn(u, k):
    """sn(u, k) by the arithmetic-geometric mean (Abramowitz and Stegun 16.4)."""
    a, b, c = [1.0], sqrt(1 - k * k), [k]
    while abs(c[-1]) > 1e-16:
        a.append((a[-1] + b) / 2)
        c.append((a[-2] - b) / 2)
        b = sqrt(a[-2] * b)
    phi = 2 ** (len(a) - 1) * a[-1] * u
    for i in range(len(a) - 1, 0, -1):
        phi = (phi + asin(max(-1, min(1, c[i] / a[i] * sin(phi))))) / 2
    return sin(phi)


def pendulum(t):
    """Elliptic functions: sin(theta/2) = k sn(K + w t), k = sin(45 deg), from the horizontal at x = -1 m (IFToMM A01)."""
    k, w, K = sqrt(0.5), sqrt(9.81), 1.8540746773013719
    s = k * jacobi_sn(K + w * t, k)
    theta = 2 * asin(s)
    return -sin(theta), -cos(theta), 0


def double_four_bar(t):
    """All cranks turn alike: 1.5 theta'' = 1.75 g sin(theta) for three cranks of 1/3 and two couplers of 1 kg m^2 (IFToMM A02)."""
    theta, _ = rk4(lambda y: [y[1], 3.5 * 9.81 / 3 * sin(y[0])], [0.0, 1.0], t, 100000)
    return sin(theta), cos(theta), 0


def parallelogram(t):
    """No gravity: the rate of 3 rad/s stays."""
    return sin(3 * t), cos(3 * t), 0


def fixed_point(mass, com, J, spin, gravity, point, t, n):
    """Euler's equations in body axes, J' = J + m (c^2 - c c^T), and the directors."""
    cross = lambda a, b: [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    c2 = sum(x * x for x in com)
    I = [[(J[i] if i == j else 0) + mass * ((c2 if i == j else 0) - com[i] * com[j]) for j in range(3)] for i in range(3)]
    det = sum(I[0][i] * (I[1][(i + 1) % 3] * I[2][(i + 2) % 3] - I[1][(i + 2) % 3] * I[2][(i + 1) % 3]) for i in range(3))
    inv = [[(I[(j + 1) % 3][(i + 1) % 3] * I[(j + 2) % 3][(i + 2) % 3] - I[(j + 1) % 3][(i + 2) % 3] * I[(j + 2) % 3][(i + 1) % 3]) / det
            for j in range(3)] for i in range(3)]
    times = lambda A, x: [sum(A[i][j] * x[j] for j in range(3)) for i in range(3)]

    def rate(y):
        w, R = y[:3], [y[3:6], y[6:9], y[9:12]]  # rows of R: inertial components of the body axes
        g = [sum(R[i][j] * gravity[i] for i in range(3)) for j in range(3)]
        moment = [a - b for a, b in zip(cross(com, [mass * x for x in g]), cross(w, times(I, w)))]
        return times(inv, moment) + cross(R[0], w) + cross(R[1], w) + cross(R[2], w)

    y = rk4(rate, list(map(float, spin)) + [1.0, 0, 0, 0, 1.0, 0, 0, 0, 1.0], t, n)
    return tuple(sum(y[3 + 3 * i + j] * point[j] for j in range(3)) for i in range(3))


def brick(t):
    return fixed_point(8, [0.5, 0.1, 0.2], [2 / 15, 2 * 0.58 / 1.5, 2 * 0.52 / 1.5], [0.5, 1, 2], [0, 0, -9.81], [1, 0.2, 0.4], t, 4000)


def top(t):
    return fixed_point(15, [0, 1, 0], [0.234375, 0.46875, 0.234375], [0, 150, -4.61538], [0, 0, -9.81], [0, 1, 0], t, 20000)


def squeezer(t):
    """Crank angle at 0.03 s, PSIDE at 1e-14 (IVP test set)."""
    return 0.007 * cos(15.81077119629904), 0.007 * sin(15.81077119629904), 0


def slider_crank(t):
    """One coordinate: M(theta) theta'^2 stays; r 0.5, l 1 m; 1, 2, 0.5 kg; from 0.5 rad at 6 rad/s."""
    r, l = 0.5, 1.0

    def inertia(theta):
        s, c = sin(theta), cos(theta)
        phi = -asin(r / l * s)
        d = -r / l * c / cos(phi)
        x, xc, yc = -r * s - l * sin(phi) * d, -r * s - l / 2 * sin(phi) * d, r / 2 * c
        return r * r / 3 + 2 * (xc * xc + yc * yc) + 2 * l * l / 12 * d * d + 0.5 * x * x

    level = inertia(0.5) * 36
    theta, = rk4(lambda y: [sqrt(level / inertia(y[0]))], [0.5], t, 20000)
    return r * cos(theta) + l * cos(asin(r / l * sin(theta))), 0, 0


def elastic_pendulum(t):
    """Polar coordinates, m r^2 phi' = m L v: m (r'' - r phi'^2) = -k (r - L)."""
    L, v, k, m = 3.0443, 7.72, 1e7, 10
    r, _, phi = rk4(lambda y: [y[1], L * L * v * v / y[0] ** 3 - k / m * (y[0] - L), L * v / y[0] ** 2], [L, 0.0, 0.0], t, 200000)
    return r * sin(phi), -r * cos(phi), 0


def guided_mass(t):
    """z = 8/5 (7 + 8 cos 2 pi t) sin^4 pi t (FEBio rj17)."""
    return 0, 0, 1.6 * (7 + 8 * cos(2 * pi * t)) * sin(pi * t) ** 4
