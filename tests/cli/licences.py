#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# The table of docs/licence.md has a row for every library that the programs load (NEEDED of the binaries), that is inside them (archives of
# the link lines in build.ninja), and for every library that .setup installs.  Usage: licences.py REPO BUILD
import pathlib
import re
import subprocess
import sys

repo, build = (pathlib.Path(a).resolve() for a in sys.argv[1:3])
page = (repo / "docs/licence.md").read_text()
rows = [line for line in page.split("## All libraries")[1].split("\n## ")[0].splitlines() if line.startswith("| ")][1:]
bare = [re.sub(r"[^a-z0-9|+]", "", row.lower().replace("\\|", "")) for row in rows]
ALIAS = {"mpi": "openmpi", "z": "zlib", "sz": "szip", "c": "gnuclibrary", "m": "gnuclibrary", "dl": "gnuclibrary", "pthread": "gnuclibrary",
         "rt": "gnuclibrary", "ld-linux-x86": "gnuclibrary", "simtkcommon": "simbody", "simtkmath": "simbody", "simtksimbody": "simbody", "gcc_s": "libgcc", "spqr": "spqr", "hdf5_openmpi": "hdf5", "vtk": "vtk",
         "petsc_real": "petsc", "gtest_main": "googletest", "gtest": "googletest", "egl": "egl"}


def has(name):
    key = ALIAS.get(name, name)
    if name.startswith("vtk"):
        key = "vtk"
    key = re.sub(r"[^a-z0-9+]", "", key.lower())
    return any(key in row for row in bare)


found = {}
programs = sorted((build / "bin").glob("hilo-*")) + [build / "lib/libhilo-petsc.so", build / "lib/hilo-import-geometry"]
for program in programs:
    if not program.is_file():
        continue
    said = subprocess.run(["objdump", "-p", program], capture_output=True, text=True, check=True).stdout
    for library in re.findall(r"NEEDED\s+(\S+)", said):
        found.setdefault(re.sub(r"^lib|(-\d[\d.]*)?\.so.*$", "", library).lower(), program.name)
for line in (build / "build.ninja").read_text().splitlines():
    if line.strip().startswith("LINK_LIBRARIES"):
        for archive in re.findall(r"/usr/\S*/lib([\w-]+)\.(?:a|so)\b", line):
            found.setdefault(archive.lower(), "a link line")
for package in re.search(r'packages="([^"]*)"', (repo / ".setup").read_text())[1].split():
    stem = re.fullmatch(r"(?:lib)?([a-z0-9+-]+?)\d*(?:-(?:dev|serial|dri|core))+|fonts-([a-z]+)-core", package)
    if stem:
        name = {"petsc-real": "petsc", "hdf5-openmpi": "hdf5", "tomlplusplus": "toml++", "zlib1g": "zlib", "gl1-mesa": "mesa", "vtk9": "vtk", "opencv": "opencv",
                "gtest": "googletest", "eigen3": "eigen", "openblas0": "openblas", "suitesparse": "suitesparse", "gl": "mesa", "nlohmann-json": "nlohmann"}.get(stem[1] or stem[2], stem[1] or stem[2])
        found.setdefault(name, f".setup ({package})")
missing = {name: where for name, where in found.items() if not has(name)}
for name, where in sorted(missing.items()):
    print(f"licences: {name}, of {where}, has no row in docs/licence.md", file=sys.stderr)
if len(found) < 30 or len([p for p in programs if p.is_file()]) < 9:
    sys.exit(f"licences: only {len(found)} libraries of {len(programs)} programs were looked at")
print(f"{len(found)} libraries, {len(rows)} rows")
sys.exit(1 if missing else 0)
