#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Decks of calculix-ccx-test with beams and shells: imported by --thicken, solved as they come, and the largest displacement beside that of ccx;
beside a closed form where the deck has one quadratic element in a span whose curvature varies, which ccx makes too stiff.

  tests/cli/ccx_thin.py REPO BIN"""
import math, os, re, sys, tempfile
import h5py
import numpy as np

import calculix as ccx

ccx.tools()
BESIDE_CCX = {"b31": 5e-3, "beamlin": 5e-3, "section": 5e-3, "simplebeampipe1": 1e-2, "simplebeampipe2": 1e-2, "solidshell1": 5e-3, "solidshell2": 5e-3}
# a cantilever with a force and its shear; the moment M between x = 0.4 and 0.8, on an arc; a tie of two materials pulled off its neutral
# axis by e, bending off its line as it straightens: e (1 - 1/cosh(k L)), k^2 = N/EI
bar = {"E": 1e7, "I": 0.25**4 / 12, "G": 1e7 / 2.6, "A": 0.25**2}
theta = 1e-3 * 0.4 / (210000 * 0.03 * 0.015**3 / 12)
EA, ES = 0.004 * (210000 + 110000), 0.004 * 0.04 * (210000 - 110000)
EJ = (210000 + 110000) * (0.05 * 0.08**3 / 12 + 0.004 * 0.04**2)
CLOSED = {"simplebeam": (1e3 / (3 * bar["E"] * bar["I"]) + 10 / (5 / 6 * bar["G"] * bar["A"]), 1e-3, None),
          "rot2": (0.4 / theta * math.hypot(theta - math.sin(theta), 1 - math.cos(theta)), 1e-3, None),
          "beamcom": (ES / EA * (1 - 1 / math.cosh(2 * math.sqrt(0.1 / (EJ - ES**2 / EA)))), 5e-3, ("node_4", 2))}


def of_ccx(text):
    ccx.write("x.inp", re.sub(r"(?im)^\*\s*END STEP", "*NODE FILE, OUTPUT=2D\nU\n*END STEP", text))
    ccx.run("ccx", "x")
    return max(math.hypot(*u[:3]) for u in ccx.last(ccx.plotted(open("x.frd", errors="replace")))["DISP"].values())


def of_hilo(text, at=None):
    ccx.write("deck.inp", text)
    ccx.imported("deck", "--thicken")
    ccx.run("hilo-solve", "scene.toml", "mesh.h5", "-o", "run.h5", "--quiet")
    with h5py.File("run.h5") as results:
        bodies = results.get("history/body", {})
        ways = {name: bodies[name][-1][:3] - bodies[name][0][:3] for name in bodies if bodies[name].ndim == 2}
        if at:
            return abs(ways[at[0]][at[1]])
        cells = np.linalg.norm(ccx.last_field("displacement"), axis=1).max() if results.get("field") else 0
    return max([cells] + [np.linalg.norm(w) for w in ways.values()])


wrong = 0
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for deck in [*BESIDE_CCX, *CLOSED]:
        text = ccx.stored(deck + ".inp")
        want, limit, at = CLOSED.get(deck, (None, BESIDE_CCX.get(deck), None))
        theirs, ours = of_ccx(text), of_hilo(text, at)
        off = abs(ours / (want or theirs) - 1)
        print(f"{deck:16} hilo {ours:.6g}  ccx {theirs:.6g}  {f'closed form {want:.6g}' if want else '':26} off {off:.1e} (limit {limit:g})")
        wrong += not off < limit
sys.exit(1 if wrong else 0)
