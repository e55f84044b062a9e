#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Seeds of the fuzzer, a folder for each reader: decks that stand in the tests' sources, small meshes in every format that gmsh writes, and
files of hilo.  Usage: seeds.py REPO BIN FOLDER"""
import glob, os, re, shutil, struct, subprocess, sys, tempfile, zlib

repo, bin, folder = (os.path.realpath(p) for p in sys.argv[1:4])


def put(reader, name, content):
    os.makedirs(os.path.join(folder, reader), exist_ok=True)
    if 0 < len(content) <= 1 << 16:
        with open(os.path.join(folder, reader, name), "wb") as f:
            f.write(content)


def take(reader, pattern):
    for path in glob.glob(os.path.join(repo, pattern), recursive=True):
        if "/out/" not in path and not path.startswith(os.path.join(repo, "build")):
            with open(path, "rb") as f:
                put(reader, path[len(repo) + 1 :].replace("/", "-"), f.read())


for reader, pattern in [("inp", "**/*.inp"), ("vtk", "**/*.vtk"), ("vtu", "**/*.vtu"), ("geo", "**/*.geo"), ("scene", "**/*.toml"),
                        ("tags", "**/tags*.toml")] + [(r, "**/*.csv") for r in ("csv", "points", "history")]:
    take(reader, pattern)
for reader, pattern in [("bdf", "import_bdf*"), ("inp", "import_inp*"), ("vtk", "import_vtk*"), ("msh", "import_gmsh*"), ("unv", "import_*"),
                        ("scene", "../verify/*/*_test"), ("scene", "../model/scene*_test"), ("tags", "tag_test")]:
    for path in glob.glob(os.path.join(repo, "tests/tools", pattern + ".cpp")):
        with open(path) as f:
            for number, text in enumerate(re.findall(r'R"\((.*?)\)"', f.read(), re.S)):
                put(reader, f"{os.path.basename(path)}-{number}", text.encode())

for bits in 4, 8, 16:  # grey images of 4 x 3 pixels
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    lines = b"".join(bytes([0] + [37 * (i + j) % 256 for i in range(bits // 2)]) for j in range(3))
    put("heights", f"{bits}.png", b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 4, 3, bits, 0, 0, 0, 0)) +
        chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b""))

os.chdir(tempfile.mkdtemp())
solids = ["Point(1) = {0, 0, 0}; Extrude {1, 0, 0} {Point{1}; Layers{1};} Extrude {0, 1, 0} {Line{1}; Layers{2}; Recombine;} "
          "Extrude {0, 0, 1} {Surface{5}; Layers{1}; Recombine;}\n",
          'SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 1, 1, 1};\n']
save = "".join(f'Save "%s.{ending}";\n' for ending in "msh mesh unv bdf stl inp vtk".split())
for number, solid in enumerate(solids):
    for order in 1, 2:
        for version, binary in ("2.2", 0), ("2.2", 1), ("4.1", 0), ("4.1", 1), ("4.0", 0):
            with open("make.geo", "w") as f:
                f.write(f'{solid}Physical Volume("box", 7) = {{1}};\nPhysical Surface("side", 9) = {{5}};\nMesh 3;\nSetOrder {order};\n'
                        f'Mesh.MshFileVersion = {version};\nMesh.Binary = {binary};\n{save.replace("%s", f"{number}-{order}-{version}-{binary}")}')
            subprocess.run([bin + "/hilo-import", "make.geo", "--trust", "--size", "1", "-o", f"{number}.h5"], capture_output=True)
for path in glob.glob("*-*"):
    with open(path, "rb") as f:
        put({"mesh": "medit"}.get(path.split(".")[-1], path.split(".")[-1]), path, f.read())
for order in 1, 2:
    with open("face.geo", "w") as f:
        f.write("Point(1) = {0, 0, 0}; Extrude {1, 0, 0} {Point{1}; Layers{2};} Extrude {0, 1, 0} {Line{1}; Layers{2};" + " Recombine;" * (order - 1) + "}\n")
    subprocess.run([bin + "/hilo-import", "face.geo", "--face", "--order", str(order), "-o", "face.msh", "--quiet"], check=True)
    with open("face.msh", "rb") as f:
        put("section", f"{order}.msh", f.read())
subprocess.run([bin + "/hilo-tag", "0.h5", "--rest", "rigid", "-o", "tags.h5", "--quiet"], check=True)
subprocess.run([bin + "/hilo-part", "tags.h5", "-n", "2", "-o", "parts.h5", "--quiet"], check=True)
for path in "0.h5", "1.h5", "tags.h5", "parts.h5":
    with open(path, "rb") as f:
        put("store", path, f.read())
for reader in sorted(os.listdir(folder)):
    print(reader, len(os.listdir(os.path.join(folder, reader))))
shutil.rmtree(os.getcwd())
