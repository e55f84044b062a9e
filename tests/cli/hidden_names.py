#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sources of one target can be compiled together (CMAKE_UNITY_BUILD, docs/contributing.md): no two of them declare the same name in
their unnamed namespaces, except overloads and aliases of the same type.  Usage: hidden_names.py REPO"""
import collections
import glob
import os
import re
import sys

repo = os.path.abspath(sys.argv[1])
TOGETHER = ["solver/base", "solver/model", "solver/dynamics", "tools/import", "post"]  # others are compiled one by one
TOGETHER += ["solver/linear/petsc", "solver/system/build", "solver/system/reduction"]
TOGETHER += [f"tests/{room}" for room in ("model", "physics", "linear", "system", "dynamics", "tools", "geometry", "post", "verify")]


def declared(path):
    """Name, what it is and the line, of each thing at the outermost level of the unnamed namespaces (clang-format puts it at column 1)."""
    text = re.sub(r'R"(\w*)\(.*?\)\1"', lambda m: '""' + "\n" * m[0].count("\n"), open(path).read(), flags=re.S)
    lines = text.splitlines()
    outer, inside = [], False
    for n, line in enumerate(lines, 1):
        if line == "namespace {":
            inside = True
        elif line == "}  // namespace":
            inside = False
        elif m := re.match(r"(?:inline )?namespace (\S+) \{$", line):
            outer.append(m[1])
        elif re.match(r"\}  // namespace \S", line):
            outer.pop()
        elif inside and line and line[0] not in " }/#)" and not re.match("using [^=]*;|namespace ", line):
            text = re.sub(r"^template <.*?> ?(?=\w)", "", line)
            where = "::".join(outer) + "::"
            if m := re.match(r"(?:struct|class|enum class|enum) (\w+)", text):
                if not text.endswith(";"):
                    yield where + m[1], "type " + path, n
            elif m := re.match(r"using (\w+) = (.*);", text):
                yield where + m[1], "alias of " + m[2], n
            elif m := re.match(r"(?:[\w:<>,&*\[\] ]+?[ &*])(\w+)\(", text):
                k = n
                while ")" not in text:
                    text, k = text + lines[k].strip(), k + 1
                kinds = [re.sub(r" ?=.*| \w+$", "", p.strip()) for p in text[m.end():text.rindex(")")].split(",")]
                if m[1] not in ("TEST", "TEST_P", "TEST_F", "INSTANTIATE_TEST_SUITE_P"):
                    yield where + m[1], f"function({', '.join(kinds)})", n
            elif m := re.match(r".*?\b(\w+)(?:\[\w*\])? ?(?:=|\{|;)", text):
                yield where + m[1], "variable " + path, n


wrong = files = 0
for folder in TOGETHER:
    seen = collections.defaultdict(dict)
    for path in sorted(glob.glob(f"{repo}/{folder}/**/*.cpp", recursive=True)):
        files += 1
        for name, what, n in declared(path):
            for other, place in seen[name].items():
                overload = what.startswith("function") and other.startswith("function") and what != other
                alias = what.startswith("alias") and what == other
                if place.split(":")[0] != path and not overload and not alias:
                    wrong += 1
                    print(f"{os.path.relpath(path, repo)}:{n}: {name.split('::')[-1]} is declared in {os.path.relpath(place, repo)} too")
            seen[name].setdefault(what, f"{path}:{n}")
print(f"{files} files, {wrong} names twice")
sys.exit(1 if wrong or files < 300 else 0)
