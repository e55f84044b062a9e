#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Natural frequencies of decks of calculix-ccx-test, as hilo-import and hilo-solve find them, against the results the package brings along.

  tests/cli/ccx_frequency.py REPO BIN

beamf: a cantilever.  contact5, beamptied3: cells beside each other, before they touch.  damper1: a held cell and a free one on a rigid body, whose
rigid motions are not compared.  beamf2 and beampisof: the frequencies of the second step about the loads of the first, a compression near buckling and a
tension.  There CalculiX takes the stress of the loads on the shape as drawn, hilo the shape that the loads give it: their difference is of the order
of the strain, .5 and .4 per cent; so is that of the first frequency of beamf2, over (1 - load/buckling load), and it is not compared.  The last
modes are left out: C3D20R leaves modes of a cell without stiffness, which hex20r holds, and these come in there."""
import os, sys, tempfile
import h5py

import calculix as ccx

DECKS = [("beamf", range(0, 9), 1e-3), ("contact5", range(0, 10), 1e-3), ("beamptied3", range(0, 10), 1e-3),
         ("damper1", range(6, 8), 1e-3),
         ("beamf2", range(1, 8), 2e-3), ("beampisof", range(0, 8), 4e-3)]


def expected(name):
    lines = ccx.stored(name + ".dat.ref").splitlines()
    start = next(i for i, l in enumerate(lines) if "E I G E N V A L U E" in l)
    rows = [l.split() for l in lines[start:start + 40]]
    return [float(r[3]) for r in rows if len(r) == 5 and r[0].isdigit()]


def main():
    ccx.tools(need_ccx=False)
    failed = 0
    print(f"{'deck':10} {'modes':>6} {'largest difference':>19} {'limit':>7}")
    for name, modes, limit in DECKS:
        text = ccx.stored(name + ".inp")
        if "*MODAL DYNAMIC" in text:  # becomes a run in time, and its modes are asked for by the step alone
            text = text[: text.index("*END STEP") + len("*END STEP")] + "\n"
        if "*FREQUENCY" not in text:
            print(f"{name:10} is not there in this version of the package, or another deck: left out")
            continue
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            ccx.write("deck.inp", text)
            ccx.imported("deck", "--units", "mm-t-s")
            ccx.run("hilo-solve", "scene.toml", "mesh.h5", "-o", "run.h5", "--quiet", "--accept-left-out")
            with h5py.File("run.h5") as f:
                found = f["history/mode"][1:, 0]
            os.chdir("/")
        true = expected(name)
        worst = max(abs(found[k] / true[k] - 1) for k in modes)
        print(f"{name:10} {len(modes):6} {worst:19.2e} {limit:7.0e}")
        failed += not worst < limit
    return failed


sys.exit(1 if main() else 0)
