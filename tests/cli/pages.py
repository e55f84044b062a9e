#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What pages of docs show runs as it stands: files that a block names in its first line ("# scene.toml: ..."), blocks of sh and python, and
indented commands of hilo, each page in a folder of its own: its files first, then its commands in their order.  What a command says that it
writes must be there.
A page that makes no scene of its own finds an arm of one cell across in its folder: arm.step, deck.bdf, scene.toml, mesh.h5, tags.h5, run.h5,
modes.h5.  Usage: pages.py REPO BIN [PAGE.md ...]"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

import on_ranks

# Run elsewhere, or not here at all.
ELSEWHERE = {"cluster.md": "make -C tests slurm", "tour.md": "cli.tour", "tour-assembly.md": "cli.tour", "errors.md": "cli.errors",
             "library.md": "cli.library", "ccx-decks.md": "cli.ccx_decks", "pictures.md": "needs the runs of data/firing",
             "design-loop.md": "make -C data/design-loop", "contributing.md": "builds", "verification.md": "builds"}
ARM = """title = "An arm"
gravity = [0, -9.80665, 0]
material.aluminium = {E = 70e9, nu = 0.33, density = 2700}
material.steel = {E = 205e9, nu = 0.29, density = 7850}
region.arm = {material = "aluminium"}
region.block = {material = "steel"}
probe = [{name = "tip", on = "face"}]
sensor = [{name = "seat", on = "face"}]
motion = [{kind = "fixed", name = "wall", on = "bore"}]
quantity = [{name = "sag", kind = "peak", formula = "x [mm] = 1000*probe.tip.y", tolerance = "5%"}]
time = {end = 0.02, step = 1e-3, start = "equilibrium"}
"""
PLATE = "".join(f"GRID,{1 + i + 2 * j + 4 * k},,{i}.,{j}.,{k}.\n" for k in (0, 1) for j in (0, 1) for i in (0, 1))
DECK = ("SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBEGIN BULK\nMAT1,1,2.1+5,,.3,7.85-9\nPSOLID,1,1\n" + PLATE + "CHEXA,1,1,1,2,4,3,5,6,+\n+,8,7\n"
        "SPC1,1,123,1,2,3,4\nFORCE,2,5,,100.,1.,0.,0.\nENDDATA\n")
SET_UP = """hilo-import --quiet arm.step --size 60 --order 2 -o mesh.h5 \\
  --set 'bore=cylinder:at=[0,0,15],axis=[0,0,1],radius=10' --set 'face=near:460,0,15'
hilo-tag --quiet mesh.h5 --nonlinear arm --rigid block -o tags.h5
hilo-solve --quiet scene.toml tags.h5 -o run.h5 --checkpoint 5steps
hilo-solve --quiet scene.toml tags.h5 --set 'time.analysis="modes"' --set time.modes=4 -o modes.h5"""


def blocks_of(text):
    """(language or "", text) of each block, fenced or indented."""
    for fenced, kind, block, indented in re.findall(r"^(```(\w*)\n(.*?)^```$)|((?:^    [^\n]*\n)+)", text, re.M | re.S):
        yield (kind, block) if fenced else ("", re.sub(r"^    ", "", indented, flags=re.M))


def parts_of(text):
    """What to do: ("file", text, name), ("sh" or "python", text, "")."""
    for kind, block in blocks_of(text):
        name = re.match(r"(?:#|//|\*\*) ([\w-]+\.\w+):?", block)
        if kind in ("toml", "") and name:
            yield "file", block, name[1]
        elif kind in ("sh", "python"):
            yield kind, block, ""
        elif kind == "" and block.startswith("hilo-"):
            yield "sh", "".join(line + "\n" for line in block.splitlines() if re.match(r"hilo-|  ", line)), ""


def run(kind, block, folder, environment):
    command = ["bash", "-euo", "pipefail", "-c", block] if kind == "sh" else ["/usr/bin/python3", "-c", block]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=300)
    if done.returncode:
        raise SystemExit(f"exit {done.returncode} of\n{block}{done.stdout}{done.stderr}")
    for _, name in re.findall(r"(-o|--png|--eiband|--scene-out|--apply) ([a-z0-9-]+\.[a-z0-9]+)", block) if kind == "sh" else []:
        if not os.path.exists(os.path.join(folder, name)):
            raise SystemExit(f"{name} is missing after\n{block}")


def main(repo, tools, pages):
    environment = dict(os.environ, **on_ranks.ENVIRONMENT, PATH=tools + ":" + os.environ["PATH"])
    wanted = pages or sorted(p for p in os.listdir(os.path.join(repo, "docs")) if p.endswith(".md") and p not in ELSEWHERE)
    ran = 0
    with tempfile.TemporaryDirectory() as place:
        ready = os.path.join(place, "ready")
        os.mkdir(ready)
        shutil.copy(os.path.join(repo, "data/tour/arm.step"), ready)
        for name, text in (("scene.toml", ARM), ("deck.bdf", DECK)):
            open(os.path.join(ready, name), "w").write(text)
        run("sh", SET_UP, ready, environment)
        for page in wanted:
            parts = list(parts_of(open(os.path.join(repo, "docs", page)).read()))
            commands = sum(kind != "file" for kind, _, _ in parts)
            if not commands:
                continue
            if not shutil.which("ccx") and any(re.search(r"\bccx -i", block) for _, block, _ in parts):
                print(f"{page}: left out, as this Debian has no CalculiX")
                continue
            folder = os.path.join(place, page[:-3])
            shutil.copytree(ready, folder)
            for kind, block, name in parts:
                if kind == "file":
                    open(os.path.join(folder, name), "w").write(block)
            for kind, block, _ in parts:
                try:
                    if kind != "file":
                        run(kind, block.replace("--checkpoint 10m", "--checkpoint 5steps"), folder, environment)  # shorter than ten minutes
                except SystemExit as e:
                    sys.exit(f"docs/{page}: {e}")
            print(f"{page}: {commands} blocks ran")
            ran += commands
            shutil.rmtree(folder)
    assert ran, "no block ran"


main(os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2]), sys.argv[3:])
