#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Truths of the notched bar and the fillet of benchmarks_test.cpp, by polynomials of high degree in a few elements (numpy alone).

Plane strain, E = 210 GPa, nu = 0.3, traction 1 MPa along x on the right end.  Prints the stress at the point that the test looks at for
rising degrees; what stands still is the truth.
"""
import numpy as np

E, NU = 210e9, 0.3
LAM, MU = E * NU / (1 + NU) / (1 - 2 * NU), E / 2 / (1 + NU)


def gauss_lobatto(p):
    c = np.zeros(p + 1)
    c[p] = 1
    return np.r_[-1, np.sort(np.polynomial.legendre.legroots(np.polynomial.legendre.legder(c)).real), 1]


def lagrange(nodes, x):
    """Values and derivatives (len(x), len(nodes)) through a Legendre basis."""
    p = len(nodes) - 1
    leg = np.polynomial.legendre
    inverse = np.linalg.inv(leg.legvander(nodes, p))
    slopes = np.stack([leg.legval(x, leg.legder(np.eye(p + 1)[k])) if k else 0 * x for k in range(p + 1)], 1)
    return leg.legvander(x, p) @ inverse, slopes @ inverse


def solve(blocks, p, loaded, held_x, held_y, at):
    """blocks: maps of (s, t) in [0, 1]^2; loaded, held_x, held_y: of a point; stress xx yy xy at the node nearest to `at`."""
    xn = gauss_lobatto(p)
    g, w = np.polynomial.legendre.leggauss(p + 4)
    n1, d1 = lagrange(xn, g)
    s, t = np.meshgrid((xn + 1) / 2, (xn + 1) / 2, indexing="ij")
    index, X, cells = {}, [], []
    for block in blocks:
        places = np.stack(block(s.ravel(), t.ravel()), 1)
        cell = []
        for x in places:
            key = tuple(np.round(x, 9) + 0.0)
            if key not in index:
                index[key] = len(X)
                X.append(x)
            cell.append(index[key])
        cells.append(np.array(cell))
    X = np.array(X)
    n = len(X)
    K, f = np.zeros((2 * n, 2 * n)), np.zeros(2 * n)
    D = [np.einsum("ai,bj->abij", d1, n1).reshape(len(g) ** 2, -1), np.einsum("ai,bj->abij", n1, d1).reshape(len(g) ** 2, -1)]
    W = np.outer(w, w).ravel()
    for cell in cells:
        J = np.stack([d @ X[cell] for d in D], 1)
        G = np.einsum("qid,dqm->qmi", np.linalg.inv(J), np.stack(D))
        det = np.linalg.det(J)
        assert det.min() > 0
        A = np.einsum("qmi,qnj->minj", G * (W * det)[:, None, None], G, optimize=True)
        k = LAM * A + MU * A.transpose(0, 3, 2, 1)
        for i in range(2):
            k[:, i, :, i] += MU * np.einsum("minI->mniI", A).trace(axis1=2, axis2=3)
        dof = (2 * cell[:, None] + np.arange(2)).ravel()
        K[np.ix_(dof, dof)] += k.reshape(len(dof), len(dof))
        grid = cell.reshape(p + 1, p + 1)
        for side in (grid[0], grid[-1], grid[:, 0], grid[:, -1]):
            if all(loaded(x) for x in X[side]):
                length = np.linalg.norm(d1 @ X[side], axis=1)
                f[2 * side] += 1e6 * n1.T @ (w * length)
    fixed = np.array([[held_x(x), held_y(x)] for x in X]).ravel()
    free = np.flatnonzero(~fixed)
    u = np.zeros(2 * n)
    u[free] = np.linalg.solve(K[np.ix_(free, free)], f[free])
    u = u.reshape(n, 2)
    node = np.argmin(((X - at) ** 2).sum(1))
    found = []
    for cell in cells:
        for place in np.flatnonzero(cell == node):
            a, b = divmod(place, p + 1)
            (na, da), (nb, db) = lagrange(xn, xn[[a]]), lagrange(xn, xn[[b]])
            d = np.stack([np.outer(da, nb).ravel(), np.outer(na, db).ravel()])
            H = np.linalg.solve(d @ X[cell], d @ u[cell])
            e = (H + H.T) / 2
            sigma = LAM * np.trace(e) * np.eye(2) + 2 * MU * e
            found.append([sigma[0, 0], sigma[1, 1], sigma[0, 1]])
    return X[node], np.mean(found, axis=0), np.ptp(found, axis=0).max()


def corner(centre, radius, half, first, t0, t1, s0=0, s1=1):
    """From the arc of 90 degrees about the centre, beginning at the angle `first`, out to a square of that half width."""

    def place(s, t):
        s, t = s0 + (s1 - s0) * s, t0 + (t1 - t0) * t
        c, d = np.cos(first + t * np.pi / 2), np.sin(first + t * np.pi / 2)
        r = radius + s * (half / np.maximum(abs(c), abs(d)) - radius)
        return centre[0] + r * c, centre[1] + r * d

    return place


def box(x0, x1, y0, y1):
    return lambda s, t: (x0 + (x1 - x0) * s, y0 + (y1 - y0) * t)


def near(value, wanted):
    return abs(value - wanted) < 1e-9


def notched(p):
    """A quarter of a bar 4 m wide and long with notches of radius 1 m: x = 0 and y = 0 are planes of symmetry."""
    blocks = [corner((0, 2), 1, 2, -np.pi / 2, t0, t1, s0, s1)
              for t0, t1 in ((0, 0.25), (0.25, 0.5), (0.5, 1)) for s0, s1 in ((0, 0.3), (0.3, 1))]
    return solve(blocks, p, lambda x: near(x[0], 2), lambda x: near(x[0], 0), lambda x: near(x[1], 0), (0, 1))


def fillet(p):
    """A quarter of a bar whose width falls from 4 to 2 m by a fillet of radius 0.5 m: x = -1 and y = 0 are planes of symmetry."""
    centre = (0.5, 1.5)
    blocks = [corner(centre, 0.5, 1.5, np.pi, t0, t1, s0, s1)
              for t0, t1 in ((0, 0.5), (0.5, 0.75), (0.75, 0.9), (0.9, 1)) for s0, s1 in ((0, 0.3), (0.3, 1))]
    right = [0.5, 0.7, 1.2, 3]
    across = [0, 0.7, 1]
    up = [1.5, 2]
    over = [-1, -0.3, 0]
    blocks += [box(a, b, c, d) for a, b in zip(right, right[1:]) for c, d in zip(across, across[1:])]
    blocks += [box(a, b, c, d) for a, b in zip(over, over[1:]) for c, d in zip(up, up[1:])]
    angle = np.pi * 1.5 - np.pi / 8
    at = (centre[0] + 0.5 * np.cos(angle), centre[1] + 0.5 * np.sin(angle))
    return solve(blocks, p, lambda x: near(x[0], 3), lambda x: near(x[0], -1), lambda x: near(x[1], 0), at)


for name, case in (("notched bar", notched), ("fillet", fillet)):
    for degree in (6, 8, 10, 12):
        where, stress, jump = case(degree)
        print(name, "degree", degree, "at", where.round(6), "stress xx yy xy [MPa]", (stress / 1e6).round(5), "jump", f"{jump / 1e6:.1e}")
