#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# What the documentation names is there: relative links and their anchors, pictures, `make -C FOLDER TARGET` (by make -n), `ctest -R NAME` (by
# ctest -N), options of the tools (in their pages, which cli.tool_pages holds), sources and scripts.  Each source file tells its licence.
# Usage: docs_links.py REPO BUILD
import pathlib
import re
import subprocess
import sys

repo, build = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
faults = []
count = {"links": 0, "targets": 0, "tests": 0, "options": 0, "sources": 0, "licences": 0}
pages = sorted({repo / "README.md", *(repo / "docs").rglob("*.md"), *(repo / "data").glob("*/README.md"), *(repo / "solver").rglob("README.md"),
                *(repo / "tests").rglob("README.md")})


def fault(page, text):
    faults.append(f"{page.relative_to(repo)}: {text}")


def anchors(page):
    """Of the headings of a page, as GitHub makes them."""
    found = set()
    fenced = False
    for line in page.read_text().splitlines():
        if line.startswith("```"):
            fenced = not fenced
        if not fenced and line.startswith("#"):
            text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", line.lstrip("#").strip()).lower()
            found.add(re.sub(r"[^\w\- ]", "", text).replace(" ", "-"))
    return found


def links(page):
    text = re.sub(r"```.*?```", "", page.read_text(), flags=re.S)
    text = re.sub(r"`[^`]*`", "", text)
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"\w+://|mailto:", target):
            continue
        count["links"] += 1
        path, _, anchor = target.partition("#")
        to = (page.parent / path).resolve() if path else page
        if not to.exists():
            fault(page, f"links to {target}, which is not there")
        elif anchor and anchor not in anchors(to):
            fault(page, f"links to {target}, which has no such heading")


tests = subprocess.run(["ctest", "--test-dir", build, "-N"], capture_output=True, text=True, check=True).stdout
tests = re.findall(r"Test\s+#\d+: (\S.*)", tests)


def named_tests(page, text):
    for quoted, bare in re.findall(r"ctest (?:--test-dir \S+ )?-R (?:'([^']+)'|([^\s`'\"]+))", text):
        name = quoted or bare.rstrip(".,;:)")
        if name.isupper():
            continue  # a placeholder
        count["tests"] += 1
        if not any(re.search(name, t) for t in tests):
            fault(page, f"ctest -R '{name}' finds no test")


made = {}


def targets(page, text):
    for line in re.findall(r"make -C (?:~/hilo/)?((?:data|tests|docs)/?[^\s`]*)([^`\n#;&|(]*)", text):
        folder, rest = line[0].rstrip("/.,;:)"), line[1]
        if re.search(r"[A-Z]{2,}$", folder) or "$" in folder:
            continue  # a placeholder
        words = []
        for word in re.findall(r"\w+=(?:\"[^\"]*\"|'[^']*'|\S+)|\S+", rest):
            if re.fullmatch(r"[a-z][\w-]*", word) and re.search(rf"^(\.PHONY:.*\b)?{re.escape(word)}\b.*:?", makefile(folder), re.M):
                words.append(word)
            elif not re.match(r"[A-Z]+=|-j\d*", word):
                break  # the sentence goes on
        key = (folder, tuple(words))
        if key in made:
            continue
        count["targets"] += 1
        done = subprocess.run(["make", "-n", "-C", repo / folder, f"BUILD={build}", "BUILT=1", *words], capture_output=True, text=True)
        made[key] = done.returncode
        if done.returncode:
            fault(page, f"make -C {folder} {' '.join(words)}: {done.stderr.strip().splitlines()[-1] if done.stderr.strip() else 'fails'}")


def makefile(folder):
    path = repo / folder / "Makefile"
    return path.read_text() if path.exists() else ""


tool_options = {p.stem: set(re.findall(r"--[a-z][\w-]*", "".join(q.read_text() for q in [p, *p.with_suffix("").glob("*.md")])))
                for p in (repo / "docs/tools").glob("hilo-*.md")}
for every in tool_options.values():
    every |= {"--help", "--version", "--completion", "--man", "--markdown", "--quiet"}


def options(page, text):
    for code in re.findall(r"`([^`\n]+)`", text) + re.findall(r"^(?:    )?(?:mpirun .*)?(hilo-[a-z]+ .*)$", text, re.M):
        for command in re.split(r"[;|&#]", code):
            tool = re.search(r"(?:^|\s)(hilo-[a-z]+)\s(.*)", command)
            if not tool or tool[1] not in tool_options:
                continue
            for option in re.findall(r"(?:^|\s)(--[a-z][\w-]*)", tool[2]):
                count["options"] += 1
                if option not in tool_options[tool[1]]:
                    fault(page, f"{tool[1]} has no {option}")


rooms = "base|model|physics|system|linear|dynamics"


def sources(page, text):
    for name in re.findall(rf"`((?:tests|data|docs|tools|post|solver|import|{rooms})/[\w./-]+)`", text):
        if "NAME" in name or "/out" in name or name.endswith("/"):
            continue
        count["sources"] += 1
        places = [repo / name, repo / "solver" / name, repo / "tools" / name]
        if not any(p.exists() or list(p.parent.glob(p.name + ".?pp")) or list(p.parent.glob(p.name + "*_test.cpp")) for p in places):
            fault(page, f"{name} is not there")


for page in pages:
    text = page.read_text()
    links(page)
    if "shared/" in text:
        fault(page, "names shared/, which no reader has")
    if page.name.startswith("changes"):
        continue  # what was named then may have another name now
    named_tests(page, text)
    targets(page, text)
    if page.name != "errors.md":  # where commands are wrong on purpose; cli.errors runs them
        options(page, text)
    sources(page, text)
for source in subprocess.run(["git", "-C", repo, "ls-files"], capture_output=True, text=True).stdout.splitlines() or [
        str(p.relative_to(repo)) for folder in ("solver", "tools", "post", "tests", "docs") for p in (repo / folder).rglob("*")]:
    path = repo / source
    if path.suffix in (".cpp", ".hpp", ".py", ".sh", ".cmake", ".mk") or path.name in ("CMakeLists.txt", "Makefile", ".setup"):
        if not path.exists():
            continue
        count["licences"] += 1
        if "SPDX-License-Identifier: GPL-3.0-or-later" not in "\n".join(path.read_text(errors="replace").splitlines()[:3]):
            faults.append(f"{source}: no line SPDX-License-Identifier at its start")
for name, n in count.items():
    if n == 0:
        faults.append(f"no {name} were looked at")
for text in faults:
    print(f"docs_links: {text}", file=sys.stderr)
print(", ".join(f"{n} {name}" for name, n in count.items()), f"in {len(pages)} pages")
sys.exit(1 if faults else 0)
