#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Flipped bytes: a random bit of every kind of hilo's files is turned, and each tool that reads it is run.  None may crash, hang or end with
an internal fault (exit 5), and hilo-show --check must find each flip that changes what the file says (by h5py, a reader of others).  Usage: flipped_bytes.py REPO BIN FLIPS [SEED]"""
import os, random, shutil, subprocess, sys, tempfile

flips, seed = int(sys.argv[3]), int(sys.argv[4]) if len(sys.argv) > 4 else 1
os.environ["PATH"] = os.path.realpath(sys.argv[2]) + ":" + os.environ["PATH"]
os.environ["OPENBLAS_NUM_THREADS"] = "1"
os.chdir(tempfile.mkdtemp())
dice = random.Random(seed)

cells, nodes = [], []
for k in range(9):
    for j in range(3):
        for i in range(3):
            nodes.append(f"{len(nodes) + 1}, {i}, {j}, {k}")
for k in range(8):
    for j in range(2):
        for i in range(2):
            a = 1 + i + 3 * j + 9 * k
            cells.append(", ".join(map(str, [len(cells) + 1, a, a + 1, a + 4, a + 3, a + 9, a + 10, a + 13, a + 12])))
with open("bar.inp", "w") as f:
    f.write("*NODE\n" + "\n".join(nodes) + "\n*ELEMENT, TYPE=C3D8, ELSET=foot\n" + "\n".join(cells[:16]) +
            "\n*ELEMENT, TYPE=C3D8, ELSET=top\n" + "\n".join(cells[16:]) + "\n*NSET, NSET=base\n" + ", ".join(str(n) for n in range(1, 10)) + "\n")
with open("scene.toml", "w") as f:
    f.write('gravity = [9.81, 0, -9.81]\n[time]\nend = 5e-3\nstep = 1e-3\n[material.steel]\nE = 2e9\nnu = 0.3\ndensity = 7850\n'
            '[region."*"]\nmaterial = "steel"\n[[motion]]\nkind = "fixed"\nname = "ground"\non = "base"\n')


def run(words, patience=60):
    try:
        return subprocess.run(words, capture_output=True, text=True, timeout=patience)
    except subprocess.TimeoutExpired:
        return None


for words in ("hilo-import bar.inp --regions foot,top -o mesh.h5", "hilo-tag mesh.h5 --nonlinear foot --linear top -o tags.h5", "hilo-part tags.h5 -n 2 -o parts-2.h5",
              "hilo-reduce scene.toml tags.h5 -o reduced.h5", "hilo-solve --quiet scene.toml tags.h5 -o run.h5"):
    made = run(words.split())
    if made is None or made.returncode:
        sys.exit(f"flipped_bytes: {words}: {made and made.stderr}")

# What a file says, whatever lies between: names, types, values, attributes and links, as one number.
content = r"""
import hashlib, sys, h5py
h = hashlib.md5()
with h5py.File(sys.argv[1]) as f:
    def walk(group, path):
        for key in sorted(group):
            link = group.get(key, getlink=True)
            h.update(repr((path, key, type(link).__name__, getattr(link, "filename", ""), getattr(link, "path", ""))).encode())
            if isinstance(link, h5py.HardLink):
                o = group[key]
                look(o)
                walk(o, path + "/" + key) if isinstance(o, h5py.Group) else h.update(repr((o.shape, o.dtype, o[()].tolist())).encode())
    def look(o):
        for key in sorted(o.attrs):
            h.update(repr((key, o.attrs[key])).encode())
    look(f)
    walk(f, "")
print(h.hexdigest())
"""


def said_by(name):
    ran = run(["/usr/bin/python3", "-c", content, name])
    return ran.stdout if ran and ran.returncode == 0 else None


readers = {
    "mesh.h5": ["hilo-show mesh.h5", "hilo-part mesh.h5 -n 2 -o out.h5", "hilo-solve --quiet --dry-run scene.toml mesh.h5"],
    "tags.h5": ["hilo-show tags.h5", "hilo-part tags.h5 -n 2 -o out.h5", "hilo-solve --quiet --dry-run scene.toml tags.h5"],
    "parts-2.h5": ["hilo-show parts-2.h5"],
    "reduced.h5": ["hilo-show reduced.h5", "hilo-solve --quiet --dry-run scene.toml tags.h5 --modes reduced.h5"],
    "run.h5": ["hilo-show run.h5", "hilo-post series run.h5 --list", "hilo-post series run.h5 energy.kinetic"],
}
bad, missed = [], []
for name, commands in readers.items():
    with open(name, "rb") as f:
        whole = f.read()
    shutil.copy(name, "kept")
    truth = said_by(name)
    tally = dict(found=0, idle=0, crash=0, hang=0, fault=0)
    for _ in range(flips):
        at, bit = dice.randrange(len(whole)), 1 << dice.randrange(8)
        broken = bytearray(whole)
        broken[at] ^= bit
        with open(name, "wb") as f:
            f.write(broken)
        for words in [f"hilo-show --check {name}"] + commands:
            ran = run(words.split())
            what = "hang" if ran is None else "crash" if ran.returncode < 0 or ran.returncode > 5 else "fault" if ran.returncode == 5 else ""
            if what:
                tally[what] += 1
                bad.append(f"{what}: {words}, byte {at} ^ {bit} (seed {seed}): {'' if ran is None else ran.stderr.strip()[-200:]}")
            elif "--check" in words:
                if ran.returncode:
                    tally["found"] += 1
                elif said_by(name) == truth:  # nothing was there
                    tally["idle"] += 1
                else:
                    missed.append(f"{name}, byte {at} ^ {bit} (seed {seed}), after {whole[max(0, at - 40):at]}")
    shutil.copy("kept", name)
    print(f"{name}: {len(whole)} bytes, {flips} flips, {tally['found']} found by --check, {tally['idle']} without effect, "
          f"{flips - tally['found'] - tally['idle']} missed, {tally['crash']} crashes, {tally['hang']} hangs, "
          f"{tally['fault']} internal faults")
for line in missed:
    print("flipped_bytes: missed:", line, file=sys.stderr)
for line in bad:
    print("flipped_bytes:", line, file=sys.stderr)
sys.exit(1 if bad or missed else 0)
