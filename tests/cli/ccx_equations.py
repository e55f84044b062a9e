#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Decks of calculix-ccx-test with *EQUATION of several terms, and one without any, through ccx and through hilo: the same displacements.

  tests/cli/ccx_equations.py REPO BIN

C3D20R becomes C3D20, which both programs integrate alike.  ccx answers linearly, so hilo's loads are multiplied by 1e-4, and its displacements
divided by that.  The limit is that of the digits which ccx prints."""
import os, sys, tempfile

import calculix as ccx

LIMIT = 1e-6
ccx.tools()
bad = 0
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for deck in ("achtelp", "achtel2", "achtel9", "achtelcas", "achtel29"):
        ccx.write(deck + ".inp", ccx.stored(deck + ".inp").replace("C3D20R", "C3D20"))
        ccx.run("ccx", deck)
        lost = ccx.imported(deck)
        ours = ccx.solved("\n[solver]\ntolerance = 1e-12\n", 1e-4)
        nodes, largest, off = ccx.apart(ours, ccx.last(ccx.printed(open(deck + ".dat"))))
        wrong = bool(lost) or nodes < 50 or not off < LIMIT
        bad += wrong
        rows = open("scene.toml").read().count("weighted-sum")
        print(f"{deck:<12}{rows:>4} rows {nodes:>4} nodes  largest u {largest:.4g}  difference {off:.1e}{'  WRONG ' if wrong else ''}" + "".join(lost))
sys.exit(bad > 0)
