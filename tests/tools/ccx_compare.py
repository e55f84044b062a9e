#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Solves decks of calculix-ccx-test with CalculiX (ccx) and with hilo and compares the displacements of all nodes after the first step.

  tests/tools/ccx_compare.py build/bin achtelp beam20p beamp

Both run geometrically nonlinear; --full makes C3D20 of C3D20R for both, so that the elements are the same."""
import gzip, os, re, subprocess, sys, tempfile
import h5py
import numpy as np

DECKS = "/usr/share/doc/calculix-ccx-test/examples/test/"


def lines_of(deck):
    path = DECKS + deck + ".inp"
    with gzip.open(path + ".gz", "rt", errors="replace") if not os.path.exists(path) else open(path, errors="replace") as f:
        return f.read().splitlines()


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


def first_step(lines, full):
    """The deck up to the end of its first step, nonlinear, printing all displacements."""
    ids, out, seen = nodes_of(lines), [], False
    for line in lines:
        word = line.upper().replace(" ", "")
        if word.startswith("*STEP") and not seen:
            seen = True
            out += ["*NSET,NSET=HILOALL"] + [", ".join(map(str, ids[i:i + 8])) + "," for i in range(0, len(ids), 8)]
            line = line.rstrip() + ("" if "NLGEOM" in word else ",NLGEOM")
        if word.startswith("*ELEMENT") and full:
            line = re.sub("C3D20R", "C3D20", line, flags=re.I)
        if word.startswith("*ENDSTEP"):
            return out + ["*NODE PRINT,NSET=HILOALL", "U", line]
        out.append(line)
    return out


def printed(path):
    """The last displacements of set HILOALL in a .dat file."""
    u, inside = {}, False
    for line in open(path):
        field = line.split()
        if "displacements" in line:
            inside = "HILOALL" in line
            if inside:
                u = {}
        elif inside and len(field) == 4 and field[0].isdigit():
            u[int(field[0])] = [float(x) for x in field[1:]]
        elif field and not re.match(r"[-\d.]", field[0]):
            inside = False
    return u


def compare(binaries, deck, full):
    with open(deck + ".inp", "w") as f:
        text = re.split(r"^\*END *STEP.*$", "\n".join(lines_of(deck)), maxsplit=1, flags=re.M | re.I)[0] + "*END STEP\n"
        f.write(re.sub("C3D20R", "C3D20", text, flags=re.I) if full else text)
    for command in ([binaries + "/hilo-import", deck + ".inp", "-o", deck + ".h5", "--scene-out", deck + ".toml"],
                    [binaries + "/hilo-solve", deck + ".toml", deck + ".h5", "-o", "run.h5"]):
        ran = subprocess.run(command, capture_output=True, text=True)
        if ran.returncode:
            return f"{os.path.basename(command[0])} exit {ran.returncode}: {ran.stderr.strip().splitlines()[-1]}"
    with open("ccx.inp", "w") as f:
        f.write("\n".join(first_step(lines_of(deck), full)) + "\n")
    subprocess.run(["ccx", "ccx"], capture_output=True)
    theirs = printed("ccx.dat")
    with h5py.File(deck + ".h5") as f:
        ids = f["/mesh/nodes/id"][:]
    with h5py.File("run.h5") as f:
        ours = f["field"][sorted(f["field"])[-1]]["displacement"][:]
    rows = [i for i, n in enumerate(ids) if n in theirs]
    if not rows:
        return "ccx printed nothing"
    a, b = ours[rows], np.array([theirs[ids[i]] for i in rows])
    return f"largest |u|: ccx {abs(b).max():.5e}, hilo {abs(a).max():.5e}; largest difference {abs(a - b).max() / abs(b).max():.1e} of it"


def main():
    words = [w for w in sys.argv[1:] if w != "--full"]
    if len(words) < 2:
        sys.exit(__doc__)
    binaries = os.path.abspath(words[0])
    for deck in words[1:]:
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            print(f"{deck}: {compare(binaries, deck, '--full' in sys.argv)}", flush=True)
            os.chdir("/")


main()
