#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Decks of calculix-ccx-test with beams and shells: imported by --thicken, solved as they come, and the largest displacement beside that of ccx;
beside a closed form where the deck has one quadratic element in a span whose curvature varies, which ccx makes too stiff.

  tests/cli/ccx_thin.py REPO BIN"""
import gzip, math, os, pathlib, re, shutil, subprocess, sys, tempfile
import h5py
import numpy as np

tools = os.path.abspath(sys.argv[2])
folder = pathlib.Path("/usr/share/doc/calculix-ccx-test/examples/test")
if not shutil.which("ccx") or not folder.is_dir():
    print("ccx_thin: no ccx (apt-get install calculix-ccx calculix-ccx-test)")
    sys.exit(77)
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


def run(work, *command):
    ran = subprocess.run(command, cwd=work, capture_output=True, text=True, timeout=100, env=dict(os.environ, OMP_NUM_THREADS="1"))
    if ran.returncode:
        sys.exit(f"{' '.join(command)}: exit {ran.returncode}\n{ran.stdout[-500:]}{ran.stderr[-500:]}")
    return ran


def of_ccx(work, deck):
    text = (work / f"{deck}.inp").read_text(errors="replace")
    (work / "x.inp").write_text(re.sub(r"(?im)^\*\s*END STEP", "*NODE FILE, OUTPUT=2D\nU\n*END STEP", text))
    run(work, "ccx", "x")
    most, inside = 0.0, False
    for line in open(work / "x.frd", errors="replace"):
        if line.startswith(" -4  DISP"):
            most, inside = 0.0, True
        elif line.startswith(" -3"):
            inside = False
        elif inside and line.startswith(" -1"):
            most = max(most, math.hypot(*(float(line[13 + 12 * k:25 + 12 * k]) for k in range(3))))
    return most


def of_hilo(work, deck, at=None):
    run(work, f"{tools}/hilo-import", f"{deck}.inp", "--thicken", "--scene-out", "s.toml", "-o", "m.h5")
    run(work, f"{tools}/hilo-solve", "s.toml", "m.h5", "-o", "r.h5", "--quiet")
    with h5py.File(work / "r.h5") as results:
        bodies = results.get("history/body", {})
        ways = {name: bodies[name][-1][:3] - bodies[name][0][:3] for name in bodies if bodies[name].ndim == 2}
        if at:
            return abs(ways[at[0]][at[1]])
        fields = sorted(results["field"]) if "field" in results else []
        cells = np.linalg.norm(results[f"field/{fields[-1]}/displacement"][:], axis=1).max() if fields else 0
    return max([cells] + [np.linalg.norm(w) for w in ways.values()])


wrong = 0
with tempfile.TemporaryDirectory() as where:
    work = pathlib.Path(where)
    for deck in [*BESIDE_CCX, *CLOSED]:
        source = next(p for p in (folder / f"{deck}.inp", folder / f"{deck}.inp.gz") if p.exists())
        (work / f"{deck}.inp").write_bytes(gzip.open(source).read() if source.suffix == ".gz" else source.read_bytes())
        want, limit, at = CLOSED.get(deck, (None, BESIDE_CCX.get(deck), None))
        ccx = of_ccx(work, deck)
        hilo = of_hilo(work, deck, at)
        off = abs(hilo / (want or ccx) - 1)
        print(f"{deck:16} hilo {hilo:.6g}  ccx {ccx:.6g}  {f'closed form {want:.6g}' if want else '':26} off {off:.1e} (limit {limit:g})")
        wrong += not off < limit
sys.exit(1 if wrong else 0)
