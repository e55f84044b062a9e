#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every key that a scene may have, on ranks of which all but one have no cell: the run ends in seconds, complete (exit 0) or refused by name
(2) or stopped with a reason, and never waits.  A cell alone is the whole mesh; keys come from the schema (extreme_keys.py), words from the lists below, quantities of
every kind beside sets of every kind.

  keys_on_ranks.py BIN         each key once for its section, on 2 ranks or 3, a sixth of them a day: in the suite
  keys_on_ranks.py BIN all     for each kind, on 2 and on 3: make -C tests ranks"""
import os
import re
import signal
import subprocess
import sys
import tempfile

import extreme_keys as keys
import on_ranks
import share

everything = "all" in sys.argv[2:]
on_ranks.use()
SECONDS = int(os.environ.get("SECONDS_EACH", 60))
PLAIN = """material.plain = {E = 2e9, nu = 0.3, density = 1000}
region."*" = {material = "plain"}
set.plane = {kind = "plane", at = [0, 0, 1], axis = [0, 0, 1]}
set.box = {kind = "box", low = [0.9, -0.1, 0.9], high = [1.1, 1.1, 1.1]}
set.ball = {kind = "ball", at = [0, 0, 1], radius = 1.1}
set.cylinder = {kind = "cylinder", at = [0.5, 0.5, 0.5], axis = [0, 0, 1], radius = 0.7071, tolerance = 0.01}
set.near = {kind = "near", at = [0.5, 0.5, 1]}
motion = [{kind = "fixed", name = "held", on = "base"}]
sensor = [{name = "felt", on = "plane"}]
probe = [{name = "p", on = "ball"}, {name = "q", on = "top"}, {name = "r", on = "cylinder"}]
[[load]]
kind = "traction"
name = "pull"
on = "near"
traction = [0, 0, 10]
"""
TIMES = "[time]\nend = 0.05\nstep = 0.01\n"
FINE = "[time]\nend = 0.005\nstep = 0.001\n"  # gauss on ranks halves steps that are too long, a minute where ranks share a core
QUANTITIES = ('kind = "peak"\nstress = "block"', 'kind = "peak"\nsensor = "felt"', 'kind = "peak"\nsensor = "felt"\ncfc = 60',
              'kind = "at"\nt = 0.03\nbetween = ["p", "q"]', 'kind = "rms"\nbetween = ["p", "q", "r"]', 'kind = "peak"\nformula = "w [m] = probe.p.x"',
              'kind = "injury"\nsensor = "felt"\ncfc = 60\nmeasure = "DRI"', 'kind = "peak"\nstress = "block"\ntolerance = "2%"')


def allowed(section, key):
    """The words that the schema lists."""
    page = subprocess.run([keys.tools + "/hilo-show", "--schema"], capture_output=True, text=True, check=True).stdout
    part = page[page.index(f"### {section}\n"):]
    return re.search(rf"\| `{key}` \|[^|]*\|[^|]*\|[^|]*\| ([^|]*) \|", part)[1].strip().split(", ")


def word_scenes():
    """What is tried, and the scene: on the block, with sets by place."""
    for q in QUANTITIES:
        yield "quantity " + q.replace("\n", ", "), PLAIN + TIMES + f'[[quantity]]\nname = "q"\n{q}\n'
    for word in allowed("time", "integrator"):
        yield "integrator " + word, PLAIN + FINE + f'integrator = "{word}"\n'
    for word in allowed("time", "analysis"):
        yield "analysis " + word, PLAIN + "[time]\n" + ("steps = 2\n" if word in ("static", "path") else "") + (
            "end = 0.05\nstep = 0.01\n" if word == "dynamic" else "") + f'analysis = "{word}"\n[[quantity]]\nname = "s"\nkind = "peak"\nstress = "block"\n'
    for word in allowed("solver", "kind"):
        yield "solver " + word, PLAIN + TIMES + f'[solver]\nkind = "{word}"\n'
    for word in allowed("output", "fields"):
        yield "field " + word, PLAIN + TIMES + f'[output]\nfields = ["{word}"]\n'
    for what in ('start = "equilibrium"', "tolerance = 1e-3"):
        yield what, PLAIN + TIMES + what + "\n"
    for what in ('nodes = "skin"', "envelope = true", 'precision = "single"', 'nodes = "skin"\nenvelope = true\nprecision = "single"'):
        yield what, PLAIN + TIMES + f'[output]\n{what}\n[[quantity]]\nname = "s"\nkind = "peak"\nstress = "block"\n'
    for word in allowed("history", "interpolation"):
        yield word, PLAIN + TIMES + f'[[load]]\nkind = "pressure"\nname = "push"\non = "top"\npressure = 10\nhistory = "h"\n[history.h]\nfile = "h.csv"\ninterpolation = "{word}"\n'
    yield "stiffening", (PLAIN + TIMES).replace('material = "plain"', 'material = "plain", stiffening = true')
    yield "a redundant joint", PLAIN + TIMES + "".join(
        f'[[joint]]\nkind = "fixed"\nname = "j{k}"\nb = "near"\nat = [0.5, 0.5, 1]\n' for k in (1, 2)).replace('b = "near"', 'b = "plane"')


def ends(what, text, with_mesh, ranks, may_refuse):
    """Does it end as it must?"""
    with open("scene.toml", "w") as f:
        f.write(text)
    words = ["mpirun", "-n", str(ranks), keys.tools + "/hilo-solve", "scene.toml"] + (["mesh.h5"] if with_mesh else []) + ["-o", "run.h5", "--checkpoint", "2steps"]
    child = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True)
    try:
        said, code = child.communicate(timeout=SECONDS)[0], child.returncode
    except subprocess.TimeoutExpired:
        os.killpg(child.pid, signal.SIGTERM)
        said, code = child.communicate()[0], -1
    lines = [line for line in said.splitlines() if line.startswith("hilo-solve: ") and "warning" not in line]
    ok = code == 0 or (code in (2, 3) and may_refuse and lines)  # 3: as in the serial run
    if not ok:
        print(f"{what} on {ranks} ranks: {'not done in %d s' % SECONDS if code < 0 else 'exit %d' % code}: {lines[-1:] or said[-300:]}", flush=True)
    return ok


def main():
    wrong = n = 0
    seen = set()
    for (section, kind), rows in keys.keys_of_schema().items():
        for key, type_, _ in rows:
            if type_ not in ("number", "3 numbers", "numbers", "history") or (section in ("time", "solver", "output") and key != "interval"):
                continue
            if not everything and (section, key) in seen and (section, kind) in seen:
                continue
            seen |= {(section, key), (section, kind)}
            text, with_mesh = keys.scene(section, kind, rows, key, keys.usual(section, kind, key, type_))
            for ranks in (2, 3) if everything else (2 + n % 2,):
                n += 1
                wrong += (everything or share.today(n, 6)) and not ends(f"{section} {kind} {key}", text, with_mesh, ranks, key == "about" or kind == "box" or section in ("contact", "obstacle", "tie"))  # a single node; one rank alone
    for what, text in word_scenes():
        for ranks in (2, 3) if everything else (2 + n % 2,):
            n += 1
            wrong += (everything or share.today(n, 6)) and not ends(what, text, True, ranks, what.split()[0] in ("integrator", "analysis", "solver", "field", "stiffening"))
    print(f"{n} runs{'' if everything else ', a sixth of them today'}, {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        keys.make_mesh()
        with open("h.csv", "w") as f:
            f.write("t,value\n0,0\n0.02,1\n0.05,0.5\n")
        sys.exit(main())
