#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Decks with shells, beams or trusses that run as they come: imported by --thicken and solved, one line each, and the share of those that
state an elastic material, supports and loads and no heat.

  thin_decks.py BIN [FOLDER]      decks *.inp, *.inp.gz; without FOLDER those of the package calculix-ccx-test"""
import gzip
import pathlib
import re
import subprocess
import sys
import tempfile

THIN = re.compile(r"(?im)^\*ELEMENT\b[^\n]*TYPE\s*=\s*(S3R?|S4R?|S6|S8R?|B31R?|B32R?|B33|T2D2|T3D2|T3D3)\b")
HEAT = r"(HEAT TRANSFER|UNCOUPLED|COUPLED TEMP|ELECTRO|DFLUX)"


def said(text, words):
    return re.search(r"(?im)^\*" + words, text) is not None


def try_deck(tools, text):
    with tempfile.TemporaryDirectory() as folder:
        open(f"{folder}/d.inp", "w").write(text)
        try:
            for what in ([f"{tools}/hilo-import", "d.inp", "--thicken", "--scene-out", "s.toml", "-o", "m.h5"],
                         [f"{tools}/hilo-solve", "s.toml", "m.h5", "-o", "r.h5", "--quiet"]):
                ran = subprocess.run(what, cwd=folder, capture_output=True, text=True, timeout=120)
                if ran.returncode:
                    return [line for line in ran.stderr.splitlines() if "warning" not in line][-1:][0] if ran.stderr else "no word"
        except subprocess.TimeoutExpired:
            return "more than two minutes"
    return ""


def main():
    tools = pathlib.Path(sys.argv[1]).resolve()
    folder = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "/usr/share/doc/calculix-ccx-test/examples/test")
    thin = whole = ran = 0
    for path in sorted(folder.glob("*.inp*")):
        text = (gzip.open(path).read() if path.suffix == ".gz" else path.read_bytes()).decode(errors="replace")
        cards = "\n".join(line for line in text.splitlines() if not line.startswith("**"))
        if not THIN.search(cards):
            continue
        loaded = said(cards, "(CLOAD|DLOAD|DSLOAD|FREQUENCY|BUCKLE|BASE MOTION)") or re.search(r"(?ims)^\*STEP.*^\*BOUNDARY", cards)
        states = said(cards, "ELASTIC") and said(cards, "BOUNDARY") and loaded and not said(cards, HEAT)
        why = try_deck(tools, text)
        thin, whole, ran = thin + 1, whole + bool(states), ran + bool(states and not why)
        print(f"{path.name:28} {'' if states else '(states not all) '}{why or 'runs'}"[:230], flush=True)
    print(f"{thin} decks with thin parts; {whole} state material, supports and loads, and no heat; {ran} of these run")


if __name__ == "__main__":
    sys.exit(main())
