#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files from strangers: scripts that would leave a file behind, under every ending that hilo-import takes, leave none and are refused with
their line; what hilo reads of .msh and .mesh is what gmsh reads, array by array.  Usage: strangers.py REPO BIN"""
import os, subprocess, sys, tempfile
import h5py, numpy as np

repo, tool = os.path.realpath(sys.argv[1]), os.path.join(os.path.realpath(sys.argv[2]), "hilo-import")
os.chdir(tempfile.mkdtemp())
box = 'SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 1, 1, 1};\n'
failed = []


def write(name, text):
    with open(name, "w") as f:
        f.write(text)


def run(*words):
    return subprocess.run([tool, *words], capture_output=True, text=True, timeout=120)


def refused(name, where=None, *options):
    """Exit 2, one line of stderr that begins with the place, and nothing made."""
    before = set(os.listdir("."))
    ran = run(name, "-o", "out.h5", *options)
    made = set(os.listdir(".")) - before
    place = f"hilo-import: {where or name}"
    if made or ran.returncode != 2 or ran.stderr.count("\n") != 1 or not ran.stderr.startswith(place):
        failed.append(f"{name} {options}: made {sorted(made)}, exit {ran.returncode}, said {ran.stderr!r}, wanted {place}")


# Line 2 of each must be named.
hostile = [
    'SystemCall "touch made";', 'System "touch made";', "NonBlockingSystemCall 'touch made';", 'SystemCall /* " */ "touch made";',
    'If (1) SystemCall "touch made"; EndIf', 'For k In {1:2} SystemCall "touch made"; EndFor', 'Macro m SystemCall "touch made"; Return Call m;',
    's = "/*"; SystemCall "touch made"; t = "*/";', '1SystemCall "touch made";', 'OnelabRun("a", "touch made");', 'Plugin(MathEval).Run;',
    'Field[1] = ExternalProcess; Field[1].CommandLine = "touch made";', 'If (0) "EndIf SystemCall" EndIf', 'Printf("x") > "made";',
    'Printf("%g", 1) >> "made";', 'Error("x") > "made";', 'Save "made.msh";', 'Mesh 3; Save Str("made.msh");', 'Print "made.png";',
    'CreateDir "made";', 'General.ErrorFileName = "made";', 'Solver.Executable0 = "touch made";', 'a = GetEnv("HOME");', 'Exit;',
    'Include "/etc/hostname";', 'Include "../other.geo";', 'Merge "/etc/hostname";', 'Merge "text.dat";', 'Include Str("in", "c.geo");',
    'Merge name;', f'x = "{"0" * 1100}"; SystemCall "touch made";', 's = "no end']
write("text.dat", 'SystemCall "touch made";')
for number, line in enumerate(hostile):
    write(f"h{number}.geo", box + line + "\n")
    refused(f"h{number}.geo", f"h{number}.geo:2: ")
write("inner.geo", "\n\n" + 'SystemCall "touch made";')
write("middle.geo", 'Include "inner.geo";')
for command in "Include", "Merge":
    write("outer.geo", box + f'{command} "middle.geo";')
    refused("outer.geo", "inner.geo:3: ")
write("beside.geo", box)
write("beside.geo.opt", 'SystemCall "touch made";')  # gmsh runs it after the script
refused("beside.geo", "beside.geo.opt:1: ")
for ending in "inp bdf nas dat fem unv vtk vtu msh MSH mesh stl step stp Step brep iges igs".split():
    write(f"s.{ending}", 'SystemCall "touch made";\nPrintf("x") > "made2";\n')
    refused(f"s.{ending}")
write("m.geo", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n" + 'SystemCall "touch made";\n')
refused("m.geo", "m.geo:1: ")
write("late.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n" + 'SystemCall "touch made";\n')
refused("late.msh", "late.msh:4: ")
# With --trust the same script runs.
if run("h0.geo", "--trust", "-o", "out.h5").returncode or not os.path.exists("made"):
    failed.append("--trust does not let a script run")
refused("h23.geo", "h23.geo: the script ends the program", "--trust")


def arrays(name):
    found = {}
    with h5py.File(name) as f:
        f["mesh"].visititems(lambda key, o: found.__setitem__(key, np.asarray(o[()])) if isinstance(o, h5py.Dataset) else None)
    return found


def same(a, b):
    return a.shape == b.shape and (np.array_equal(a, b) or (a.dtype.kind == "f" and np.array_equal(a, b, equal_nan=True)))


# A mesh read here and merged into a script, which gmsh reads.
compared = 0
sources = [f"{repo}/tests/cases/block.geo", f"{repo}/tests/cli/rod.geo", f"{repo}/data/stability/block.geo"]
tutorial = "/usr/share/doc/gmsh-doc/doc/gmsh/tutorial/t16.geo"
sources += [tutorial] if os.path.exists(tutorial) else []
for number, source in enumerate(sources):
    with open(source) as f:
        script = f.read()
    kinds = [(v, b, o) for v in ("2.2", "4.1") for b in (0, 1) for o in (1, 2)] + [("4.0", 0, 1), ("4.0", 0, 2)]
    if source.endswith("t16.geo"):
        kinds = [("2.2", 1, 1), ("4.1", 0, 1)]
    names = []
    for version, binary, order in kinds:
        names.append(f"c{number}-{version}-{binary}-{order}.msh")
        write("make.geo", f'{script}\nMesh.MshFileVersion = {version};\nMesh.Binary = {binary};\nMesh.SecondOrderIncomplete = 1;\nMesh 3;\n'
              f'SetOrder {order};\nSave "{names[-1]}";\n')
        run("make.geo", "--trust", "-o", "made.h5")
    write("make.geo", f'{script}\nMesh 3;\nSave "c{number}.mesh";\n')
    run("make.geo", "--trust", "-o", "made.h5")
    for name in names + [f"c{number}.mesh"]:
        write("merge.geo", f'Merge "{name}";\nMesh.Renumber = 0;\n')  # numbers of the file are kept
        ours, theirs = run(name, "-o", "ours.h5"), run("merge.geo", "-o", "theirs.h5")
        if ours.returncode or theirs.returncode:
            if ours.stderr.split(":", 2)[-1] != theirs.stderr.split(":", 2)[-1]:
                failed.append(f"{source}: {name}: {ours.stderr!r}, gmsh {theirs.stderr!r}")
            continue
        a, b = arrays("ours.h5"), arrays("theirs.h5")
        if name.endswith(".mesh"):  # references become sets here, and entities without a group there (cli.nothing_lost_mesh compares them)
            a, b = ({key: v for key, v in one.items() if not key.startswith("sets/")} for one in (a, b))
        differ = [key for key in sorted(set(a) | set(b)) if key not in a or key not in b or not same(a[key], b[key])]
        if differ:
            failed.append(f"{source}: {name}: {differ}")
        compared += 1
if compared < 25:
    failed.append(f"only {compared} meshes were compared")
print(f"{len(hostile) + 24} hostile files, {compared} meshes as gmsh reads them")
for line in failed:
    print("strangers:", line, file=sys.stderr)
sys.exit(1 if failed else 0)
