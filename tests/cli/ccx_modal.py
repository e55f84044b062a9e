#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Decks of calculix-ccx-test whose modes are summed, through ccx and through hilo: *MODAL DYNAMIC as a run in time, *STEADY STATE DYNAMICS as an
analysis of modes and the command that hilo-import names.  Displacements of the printed node agree to 1 % of the largest.

  tests/cli/ccx_modal.py REPO BIN

C3D20R becomes C3D20, which both programs integrate alike.  ccx gets more modes than the deck asks for, as a run in time has all of
them, and loads of a thousandth, as it knows small motions alone.  The runs in time are those of linear regions."""
import os, re, subprocess, sys, tempfile
import h5py
import numpy as np

import calculix as ccx

LIMIT = 1e-2
ccx.tools()


def printed(path):
    """Time or frequency, and displacements of the one node, of each block."""
    rows, at = [], None
    for line in open(path):
        if "displacements" in line:
            at = float(line.split()[-1])
        elif at is not None and len(line.split()) == 4:
            rows.append([at] + [float(w) for w in line.split()[1:]])
            at = None
    return np.array(rows)


bad = 0
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for deck, modes, kind, step, ratio in (("beamdy1", 30, "linear", 2e-7, 0), ("beamdy5", 30, "linear", 2e-7, 0), ("beamdy5", 30, "linear", 2e-7, 0.05),
                                           ("beamdy8", 10, "nonlinear", 0, 0)):
        text = ccx.stored(deck + ".inp").replace("C3D20R", "C3D20").replace("\n10,0.01", f"\n{modes},")
        if ratio:
            text = text.replace("*MODAL DAMPING,RAYLEIGH\n,,5000.,0.", f"*MODAL DAMPING\n1,10,{ratio}\n11,{modes},{ratio}")
        ccx.write(deck + ".inp", text)
        ccx.run("ccx", deck)
        theirs = printed(deck + ".dat")
        talk = ccx.run("hilo-import", deck + ".inp", "--units", "mm-t-s", "-o", "mesh.h5", "--scene-out", "scene.toml")
        lost = ccx.not_read(talk)
        command = re.search(r"`(hilo-post response [^`]*)`", talk)
        scene = open("scene.toml").read()
        if not command:
            scene = re.sub(r"^force = .*$", "force = [0, -1e-3, 0]", re.sub(r"^step = .*$", f"step = {step}", scene, flags=re.M), flags=re.M) + '\n[[probe]]\nname = "N1"\non = "N1"\n'
        open("scene.toml", "w").write(scene)
        ccx.run("hilo-tag", "--quiet", "mesh.h5", "--rest", kind, "-o", "tags.h5")
        ccx.run("hilo-solve", "--quiet", "scene.toml", "tags.h5", "-o", "modes.h5" if command else "run.h5")
        if command:
            table = []
            for f in theirs[::2, 0]:  # ccx prints the real part, then the imaginary one
                words = command[1].replace("PROBE.AXIS", "N1.x --at N1.y --at N1.z").split()
                words[words.index("--from") + 1], words[words.index("--to") + 1], words[words.index("--points") + 1] = repr(float(f)), repr(float(f * (1 + 1e-9))), "2"
                row = subprocess.run(words, capture_output=True, text=True, check=True).stdout.splitlines()[-1].split(",")
                table.append([float(v) for v in row[1::2]])
            ours = 1e3 * np.array(table)
            exact = np.hypot(theirs[::2, 1:], theirs[1::2, 1:])
        else:
            with h5py.File("run.h5") as f:
                t, x = f["history/t"][:], f["history/probe/N1"][:, :3]
            ours = 1e6 * np.array([[np.interp(at, t, x[:, k] - x[0, k]) for k in range(3)] for at in theirs[:, 0]])
            exact = theirs[:, 1:]
        off = abs(ours - exact).max() / abs(exact).max()
        wrong = bool(lost) or (ratio and "modal_damping = 0.05" not in scene) or len(exact) < 5 or not off < LIMIT
        bad += wrong
        print(f"{deck:<12}{len(exact):>4} {'frequencies' if command else 'instants'}  largest u {abs(exact).max():.4g}  difference {off:.1e}{'  WRONG ' if wrong else ''}" + "".join(lost))
sys.exit(bad > 0)
