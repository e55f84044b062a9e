#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Solves decks of calculix-ccx-test with CalculiX (ccx) and with hilo and compares the displacements of all nodes after the first step.

  tests/cli/ccx_compare.py REPO BIN achtelp beam20p beamp

Both run geometrically nonlinear; --full makes C3D20 of C3D20R for both, so that the elements are the same."""
import os, re, sys, tempfile

import calculix as ccx


def nodes_of(lines):
    ids, inside = [], False
    for line in lines:
        if line.startswith("**") or not line.strip():
            continue
        if line.startswith("*"):
            inside = re.match(r"\*NODE *(,|$)", line.strip().upper()) is not None
        elif inside:
            ids.append(int(line.split(",")[0]))
    return ids


def first_step(lines):
    """The deck up to the end of its first step, nonlinear, printing all displacements."""
    ids, out, seen = nodes_of(lines), [], False
    for line in lines:
        word = line.upper().replace(" ", "")
        if word.startswith("*STEP") and not seen:
            seen = True
            out += ["*NSET,NSET=HILOALL"] + [", ".join(map(str, ids[i:i + 8])) + "," for i in range(0, len(ids), 8)]
            line = line.rstrip() + ("" if "NLGEOM" in word else ",NLGEOM")
        if word.startswith("*ENDSTEP"):
            return out + ["*NODE PRINT,NSET=HILOALL", "U", line]
        out.append(line)
    return out


def displacements(path):
    """The last ones of set HILOALL in a .dat file."""
    blocks = re.split(r"(?m)^(?= displacements .* for set )", open(path).read())
    return ccx.last(ccx.printed([b for b in blocks if "HILOALL" in b][-1].splitlines()))


def compare(deck, full):
    text = ccx.stored(deck + ".inp")
    text = re.sub("C3D20R", "C3D20", text, flags=re.I) if full else text
    ccx.write("deck.inp", re.split(r"^\*END *STEP.*$", text, maxsplit=1, flags=re.M | re.I)[0] + "*END STEP\n")
    ccx.imported("deck")
    ours = ccx.solved()
    ccx.write("ccx.inp", "\n".join(first_step(text.splitlines())) + "\n")
    ccx.run("ccx", "ccx")
    nodes, largest, difference = ccx.apart(ours, displacements("ccx.dat"))
    return f"{nodes} nodes, largest |u| {largest:.5e}; largest difference {difference:.1e} of it"


words = [w for w in sys.argv[3:] if w != "--full"]
if not words:
    sys.exit(__doc__)
ccx.tools()
for deck in words:
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        print(f"{deck}: {compare(deck, '--full' in sys.argv)}", flush=True)
        os.chdir("/")
