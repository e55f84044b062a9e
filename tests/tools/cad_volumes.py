#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume of meshes beside that of the CAD kernel: each STEP, brep and IGES file with and without cells by curvature, at the default size.

  tests/tools/cad_volumes.py build/bin FILE...     (files may be gzipped)"""
import gzip
import json
import os
import re
import subprocess
import sys
import tempfile

if len(sys.argv) < 3:
    sys.exit(__doc__)
tool = os.path.abspath(sys.argv[1]) + "/hilo-import"


def off(path, *options):
    """Cells, and by how much of a percent the volume is off; None where there is no mesh within two minutes."""
    try:
        ran = subprocess.run([tool, path, "-o", "mesh.h5", "--json", *options], capture_output=True, text=True, errors="replace", timeout=120)
    except subprocess.TimeoutExpired:
        return None, "120 s"
    if ran.returncode:
        return None, ran.stderr.strip().splitlines()[-1].split(": ", 2)[-1][:60] if ran.stderr else "-"
    told = json.loads(ran.stdout)
    said = re.search(r"the mesh has (?:as much|(\S+) % (less|more)) volume", " ".join(told["notes"]))
    if not said:
        return None, "no volume of the kernel"
    return told["cells"], float(said[1] or 0) * (-1 if said[2] == "less" else 1)


def text(cells, by):
    return f"{cells:>7} cells {by:+8.3f} %" if cells else f"{by}"


paths = [os.path.abspath(p) for p in sys.argv[2:]]
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    rows = []
    for path in paths:
        name = os.path.basename(path)
        if name.endswith(".gz"):
            name = name[:-3]
            open(name, "wb").write(gzip.open(path).read())
            path = name
        before, after = off(path, "--per-turn", "0"), off(path)
        rows.append((before, after))
        print(f"{name:<32} {text(*before):<40} {text(*after)}", flush=True)
    os.chdir("/")
for title, k in ("without", 0), ("default", 1):
    ok = [r[k] for r in rows if r[k][0]]
    far = [by for _, by in ok if abs(by) > 1]
    print(f"{title}: {len(ok)} meshed, {len(far)} off by more than 1 %, worst {max((abs(by) for _, by in ok), default=0):.3g} %")
both = [(b[0], a[0]) for b, a in rows if b[0] and a[0]]
if both:
    ratio = sorted(a / b for b, a in both)
    print(f"cells of {len(both)}: {sum(b for b, _ in both)} and {sum(a for _, a in both)}, median ratio {ratio[len(ratio) // 2]:.2g}")
