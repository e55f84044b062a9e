#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Decks with shells, beams or trusses that run as they come: imported by --thicken and solved, one line each, and the share of those that
state an elastic material, supports and loads and no heat.

  thin_decks.py BIN [FOLDER]      decks *.inp, *.inp.gz, and of Nastran *.bdf, *.dat, *.nas; without FOLDER those of calculix-ccx-test"""
import gzip
import pathlib
import re
import subprocess
import sys
import tempfile

THIN = re.compile(r"(?im)^\*ELEMENT\b[^\n]*TYPE\s*=\s*(S3R?|S4R?|S6|S8R?|B31R?|B32R?|B33|T2D2|T3D2|T3D3)\b")
NASTRAN = re.compile(r"(?im)^\s*(CQUAD[48R]|CTRIA[36R]|CBAR|CBEAM|CROD|CONROD|CTUBE)\b")
HEAT = r"(HEAT TRANSFER|UNCOUPLED|COUPLED TEMP|ELECTRO|DFLUX)"


def said(text, words):
    return re.search(r"(?im)^\*" + words, text) is not None


def whole(path):
    """A Nastran deck with what it includes."""
    text = path.read_text(errors="replace")
    cards = [line for line in text.splitlines() if not line.startswith("$")]
    for line in cards:
        if named := re.match(r"(?i)\s*INCLUDE\s*['\"]?([^'\"]+)", line):
            cards += whole(path.parent / named[1].strip()).splitlines()
    return "\n".join(cards)


def states_all(cards, nastran):
    if nastran:
        card = lambda names: re.search(rf"(?im)^\s*({names})\b", cards)
        held = card("SPC1?") or re.search(r"(?im)^GRID .{48}\s*[1-6]", cards) or re.search(r"(?im)^GRID,([^,]*,){6}\s*[1-6]", cards)
        loads = card(r"FORCE1?(?=[ ,\t*]+\d)|MOMENT1?|PLOAD[124]?|GRAV|RFORCE|SPCD|EIGRL?") or re.search(r"(?im)^SPC\*? .*[1-9]\d*[.-]", cards)
        return bool(card("MAT[189]") and held and loads and not card("TEMP(ERATURE)?[(]LOAD[)]|CHBDY."))
    loads = said(cards, "(CLOAD|DLOAD|DSLOAD|FREQUENCY|BUCKLE|BASE MOTION)") or re.search(r"(?ims)^\*STEP.*^\*BOUNDARY", cards)
    return bool(said(cards, "ELASTIC") and said(cards, "BOUNDARY") and loads and not said(cards, HEAT))


def try_deck(tools, path, text):
    with tempfile.TemporaryDirectory() as folder:
        if text:
            open(f"{folder}/d.inp", "w").write(text)
        try:
            for what in ([f"{tools}/hilo-import", "d.inp" if text else path.resolve(), "--thicken", "--scene-out", "s.toml", "-o", "m.h5"],
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
    thin = all_stated = ran = 0
    for path in sorted(folder.iterdir()):
        nastran = path.suffix.lower() in (".bdf", ".dat", ".nas")
        if not nastran and not path.name.endswith((".inp", ".inp.gz")):
            continue
        text = "" if nastran else (gzip.open(path).read() if path.suffix == ".gz" else path.read_bytes()).decode(errors="replace")
        cards = whole(path) if nastran else "\n".join(line for line in text.splitlines() if not line.startswith("**"))
        if not (NASTRAN if nastran else THIN).search(cards):
            continue
        states = states_all(cards, nastran)
        why = try_deck(tools, path, text)
        thin, all_stated, ran = thin + 1, all_stated + states, ran + (states and not why)
        print(f"{path.name:28} {'' if states else '(states not all) '}{why or 'runs'}"[:230], flush=True)
    print(f"{thin} decks with thin parts; {all_stated} state material, supports and loads, and no heat; {ran} of these run")


if __name__ == "__main__":
    sys.exit(main())
