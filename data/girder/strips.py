#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Buckling of a thin-walled square box by finite strips (Cheung), apart from hilo: walls of cubic bending and linear membrane strips.  Along
the girder displacements are sums of Y_m = sin(m pi x/L) sin(pi x/L) where its ends are clamped [li-2009], one sin(pi x/a) where it
is long, of the half wave a with the lowest load.  Stress before buckling is that of beams.

  strips.py [WIDTH THICKNESS LENGTH E NU]     moment and force at which it buckles, N m and N, and their k"""
import sys

import numpy as np


def along(length, terms, points=1200):
    """Integrals over the length of products of Y, Y', Y'' of displacements v and w, and of U = Y' L/(m pi) of u."""
    x = (np.arange(points) + 0.5) / points * length
    if terms == 1:
        q = np.pi / length
        Y, Y1, Y2 = ([f] for f in (np.sin(q * x), q * np.cos(q * x), -q * q * np.sin(q * x)))
    else:  # sin a sin b = (cos(a - b) - cos(a + b))/2
        Y, Y1, Y2 = [], [], []
        for m in range(1, terms + 1):
            p, q = (m - 1) * np.pi / length, (m + 1) * np.pi / length
            Y.append((np.cos(p * x) - np.cos(q * x)) / 2)
            Y1.append((q * np.sin(q * x) - p * np.sin(p * x)) / 2)
            Y2.append((q * q * np.cos(q * x) - p * p * np.cos(p * x)) / 2)
    Y, Y1, Y2 = np.array(Y), np.array(Y1), np.array(Y2)
    scale = (length / np.pi / np.arange(1, terms + 1))[:, None]
    U, U1 = Y1 * scale, Y2 * scale
    product = lambda a, b: a @ b.T * (length / points)
    return {name: product(a, b) for name, a, b in
            (("00", Y, Y), ("11", Y1, Y1), ("22", Y2, Y2), ("20", Y2, Y), ("UU", U, U), ("U1U1", U1, U1), ("U10", U1, Y), ("U1", U, Y1))}


def strip(b, t, E, nu, s, I):
    """Stiffness and geometric stiffness of a strip under the pressures s of its edges; unknowns u1 v1 w1 r1 u2 v2 w2 r2, a row of terms each."""
    Q, G, D = E * t / (1 - nu * nu), E * t / 2 / (1 + nu), E * t**3 / 12 / (1 - nu * nu)
    n = len(I["00"])
    K, S = np.zeros((8, n, 8, n)), np.zeros((8, n, 8, n))
    u, v, w = [0, 4], [1, 5], [2, 3, 6, 7]

    def add(to, rows, columns, f, g, integral, factor):
        part = factor * np.einsum("i,j,mn->imjn", f, g, integral)
        to[np.ix_(rows, range(n), columns, range(n))] += part
        if rows != columns:
            to[np.ix_(columns, range(n), rows, range(n))] += part.transpose(2, 3, 0, 1)

    for y, weight in zip(*np.polynomial.legendre.leggauss(5)):
        y, weight = (y + 1) / 2, weight / 2 * b
        N, N1 = np.array([1 - y, y]), np.array([-1, 1]) / b
        H = np.array([1 - 3 * y**2 + 2 * y**3, b * (y - 2 * y**2 + y**3), 3 * y**2 - 2 * y**3, b * (y**3 - y**2)])
        H1 = np.array([-6 * y + 6 * y**2, b * (1 - 4 * y + 3 * y**2), 6 * y - 6 * y**2, b * (3 * y**2 - 2 * y)]) / b
        H2 = np.array([-6 + 12 * y, b * (-4 + 6 * y), 6 - 12 * y, b * (6 * y - 2)]) / b**2
        add(K, u, u, N, N, I["U1U1"], Q * weight)
        add(K, v, v, N1, N1, I["00"], Q * weight)
        add(K, u, v, N, N1, I["U10"], nu * Q * weight)
        add(K, u, u, N1, N1, I["UU"], G * weight)
        add(K, v, v, N, N, I["11"], G * weight)
        add(K, u, v, N1, N, I["U1"], G * weight)
        add(K, w, w, H, H, I["22"], D * weight)
        add(K, w, w, H2, H2, I["00"], D * weight)
        both = np.einsum("i,j,mn->imjn", H, H2, I["20"])
        K[np.ix_(w, range(n), w, range(n))] += nu * D * weight * (both + both.transpose(2, 3, 0, 1))
        add(K, w, w, H1, H1, I["11"], 2 * (1 - nu) * D * weight)
        pressed = t * weight * (s[0] * (1 - y) + s[1] * y)
        add(S, w, w, H, H, I["11"], pressed)
        add(S, v, v, N, N, I["11"], pressed)
    return K, S


def buckling_stress(width, t, length, E, nu, bends, terms=14, per_wall=6):
    """The pressure of the upper wall at which the box buckles."""
    I = along(length, terms)
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * width / 2
    points = np.array([c + (d - c) * k / per_wall for c, d in zip(corners, np.roll(corners, -1, 0)) for k in range(per_wall)])
    count, n = len(points), len(I["00"])
    K, S = np.zeros((4 * count, n, 4 * count, n)), np.zeros((4 * count, n, 4 * count, n))
    for e in range(count):
        ends = [e, (e + 1) % count]
        way = points[ends[1]] - points[ends[0]]
        b = np.hypot(*way)
        c, s = way / b
        pressure = [points[i][1] / (width / 2) if bends else 1.0 for i in ends]
        turn = np.kron(np.eye(2), np.array([[1, 0, 0, 0], [0, c, s, 0], [0, -s, c, 0], [0, 0, 0, 1]]))  # own u v w r of u y z r
        rows = [4 * i + k for i in ends for k in range(4)]
        for to, own in zip((K, S), strip(b, t, E, nu, pressure, I)):
            to[np.ix_(rows, range(n), rows, range(n))] += np.einsum("ai,ambn,bj->imjn", turn, own, turn)
    size = 4 * count * n
    K, S = K.reshape(size, size), S.reshape(size, size)
    half = np.linalg.inv(np.linalg.cholesky(K + 1e-14 * np.trace(K) / size * np.eye(size)))
    return 1 / np.linalg.eigvalsh(half @ S @ half.T)[-1]


def main():
    width, t, length, E, nu = map(float, sys.argv[1:]) if len(sys.argv) == 6 else (0.3, 0.003, 1.8, 2.1e11, 0.3)
    plate = np.pi**2 * E / 12 / (1 - nu * nu) * (t / width) ** 2
    print("             ends    stress [MPa]       k   load [kN m, kN]")
    for name, bends, load in (("moment", True, 4 / 3 * width**2 * t), ("force", False, 4 * width * t)):
        long = min(buckling_stress(width, t, a * width, E, nu, bends, 1) for a in np.arange(0.7, 1.21, 0.025))
        clamped = buckling_stress(width, t, length, E, nu, bends)
        for ends, stress in (("long", long), ("clamped", clamped)):
            print(f"{name:8}{ends:>9}{stress / 1e6:16.2f}{stress / plate:8.3f}{stress * load / 1e3:18.2f}")


if __name__ == "__main__":
    main()
