#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every command that README.md and docs/ name, each with a time limit, and a table of what each took and gave: `make -C tests headlines`.

A command is `make -C FOLDER ...`, `ctest ... -R NAME`, or a script below data/ or tests/ with its arguments, in backticks or in a block of
code.  REPO and BIN stand for the repository and its tools.  All run in a copy of the tracked files below build/headlines, with the tools of
build/, so that nothing that was made before counts.  The table and the logs lie there too; a command that went through with the same tools
is not run again, so that the hours it takes may be spent in pieces.  The suite comes first: commands whose tests it passed are seen by it,
as are several targets of a Makefile where each of them went through alone.

  headlines.py REPO BUILD                     all of them
  headlines.py REPO BUILD --only "L soft"     those whose line has one of these words (ONLY="L soft"), also if they went through before
  headlines.py REPO BUILD --list              what would be run, and what is left out and why
  headlines.py REPO BUILD --check             nothing is run, but what is named exists: targets of make, tests, scripts (in the suite)
  --limit SECONDS                             of each (LIMIT=...; else an hour, or what LIMITS says)
  --jobs N                                    so many at once, each in a copy of its own (JOBS=N); their seconds mean less then"""
import argparse
import csv
import datetime
import glob
import hashlib
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import threading
import time

LIMITS = {"make -C tests": 3 * 3600, "make -C data/firing L": 2 * 3600, "make -C data/stability": 3 * 3600, "make -C data/charts": 3 * 3600,
          "make -C data/scaling": 3 * 3600, "make -C tests faults": 3 * 3600, "make -C tests ranks": 3 * 3600,
          "make -C tests bench-growth": 6 * 3600, "make -C tests bench-linear": 3 * 3600}
SUITE = "make -C tests"
LEFT_OUT = {"make -C tests headlines": "this one", "make -C tests sanitize": "a day on two cores", "make -C tests package": "as root, from bare Debian",
            "make -C tests other-system SUITE=trixie": "as root, an hour on another Debian", "make -C data/NAME": "a place holder"}
SHORTER = {"make -C tests fuzz": ["SECONDS=2"],  # as long as one likes: that it builds and begins
           "make -C tests faults": ["EVERY=21", "FLIPS=30"],  # all kinds of faults in all scenes, at some writes
           "make -C tests bench-contact-growth": ["FACETS=10000"]}  # a minute of a quarter of an hour
TOOLS = ["solver", "post", "tools", "CMakeLists.txt"]  # sources, not programs, which hold the name of the commit
LESS = {"make -C tests bench-linear": ["solver/base", "solver/linear", "tests/bench/linear"]}  # what a command measures, where that is less
PLACE_HOLDERS = r"\b(NAME|FOLDER|FLIPS|BEFORE|SEED|FILE)\b|<|\.\.\.|~/"


def commands(repo):
    """Each command once, with the page that names it first."""
    found = {}
    for page in ["README.md"] + sorted(glob.glob("docs/**/*.md", recursive=True, root_dir=repo)):
        if page.startswith("docs/changes") or page == "docs/errors.md":  # histories; cli.errors runs the other
            continue
        text = open(os.path.join(repo, page)).read()
        pieces = re.findall(r"`([^`\n]+)`", text) + [line[4:] for line in text.splitlines() if line.startswith("    ")]
        for piece in pieces:
            piece = re.sub(r"\s+#.*", "", piece).strip()
            if re.match(r"make -C \S+|ctest .*-R |(data|tests)/\S+\.(py|sh)\b", piece) and not piece.startswith("ctest --test-dir build -R NAME"):
                command = re.sub(r"^ctest (--test-dir \S+ )?", "ctest --test-dir build ", piece)
                found.setdefault(command, page)
    return found


def left_out(command):
    if command in LEFT_OUT:
        return LEFT_OUT[command]
    if re.search(PLACE_HOLDERS, command):
        return "a place holder"
    if re.fullmatch(r"\S+\.(py|sh)", command):
        return "named as a file"
    return ""


def exists(command, repo, build):
    """What is wrong with the name, or nothing."""
    words = shlex.split(command)
    if words[0] == "make":
        ran = subprocess.run(["make", "-n", "BUILD=" + build] + words[1:], cwd=repo, capture_output=True, text=True, timeout=60)
        return "" if ran.returncode == 0 else ran.stderr.strip().splitlines()[-1]
    if words[0] == "ctest":
        ran = subprocess.run(["ctest", "--test-dir", build, "-N", "-R", words[words.index("-R") + 1]], capture_output=True, text=True, timeout=60)
        return "" if re.search(r"Total Tests: [1-9]", ran.stdout) else "no such test"
    there = os.path.join(repo, words[0])
    return "" if os.access(there, os.X_OK) or (len(words) == 1 and os.path.exists(there)) else "no such script"


def tracked(repo, *below):
    names = subprocess.run(["git", "ls-files", "-z", *below], cwd=repo, capture_output=True, check=True).stdout.decode().split("\0")
    return [n for n in names if n and os.path.lexists(os.path.join(repo, n))]


def digest(repo, *below):
    """Of the tracked files below these, as they are."""
    return hashlib.sha256(b"".join(n.encode() + open(os.path.join(repo, n), "rb").read() for n in tracked(repo, *below))).hexdigest()[:12]


def copy_of(repo, folder, name):
    """The tracked files as they are, and build/ as a link."""
    tree = os.path.join(folder, name)
    shutil.rmtree(tree, ignore_errors=True)
    for name in tracked(repo):
        os.makedirs(os.path.dirname(os.path.join(tree, name)), exist_ok=True)
        shutil.copy2(os.path.join(repo, name), os.path.join(tree, name), follow_symlinks=False)
    os.symlink(os.path.dirname(folder), os.path.join(tree, "build"))
    return tree


def run(command, tree, build, limit, log):
    """Exit code (124: beyond the limit) and seconds."""
    words = [{"REPO": tree, "BIN": build + "/bin", "build/bin": build + "/bin"}.get(w, w) for w in shlex.split(command)] + SHORTER.get(command, [])
    if words[0] == "ctest":
        words[2] = build
    began = time.time()
    with open(log, "w") as out:
        env = dict(os.environ, BUILD=build, PATH=build + "/bin:" + os.environ["PATH"], PYTHONDONTWRITEBYTECODE="1")
        for name in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL"):
            env.pop(name, None)
        child = subprocess.Popen(words, cwd=tree, stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT, env=env, start_new_session=True)
        try:
            code = child.wait(limit)
        except subprocess.TimeoutExpired:
            code = 124
            for number, patience in ((signal.SIGTERM, 20), (signal.SIGKILL, 20)):  # mpirun takes its ranks along at the first
                try:
                    os.killpg(child.pid, number)
                    child.wait(patience)
                    break
                except (subprocess.TimeoutExpired, ProcessLookupError):
                    pass
    return code, time.time() - began


def log_of(command, folder):
    return os.path.join(folder, re.sub(r"[^\w.=-]+", "_", command)[:120] + ".log")


def seen_by(command, folder, build, done):
    """The commands that went through and together did what this one does, or nothing."""
    words = shlex.split(command)
    if words[0] == "ctest":
        if SUITE not in done:
            return ""
        passed = set(re.findall(r"Test +#\d+: (\S+) \.*\s*(?:Passed|\*\*\*Not Run \(Disabled)", open(log_of(SUITE, folder), errors="replace").read()))
        named = re.findall(r"Test +#\d+: (\S+)", subprocess.run(["ctest", "--test-dir", build, "-N", "-R", words[words.index("-R") + 1]],
                                                                capture_output=True, text=True, timeout=60).stdout)
        return SUITE if named and passed.issuperset(named) else ""
    alone = [" ".join(words[:3] + [target]) for target in words[3:]] if words[:2] == ["make", "-C"] and not re.search("[-=]", " ".join(words[3:])) else []
    return ", ".join(alone) if len(alone) > 1 and all(c in done for c in alone) else ""


def last_line(log):
    lines = [line.strip() for line in open(log, errors="replace") if line.strip()]
    return lines[-1][:120].replace("\t", " ") if lines else ""


def main():
    options = argparse.ArgumentParser()
    options.add_argument("repo"), options.add_argument("build")
    options.add_argument("--only", default=""), options.add_argument("--limit", type=float)
    options.add_argument("--list", action="store_true"), options.add_argument("--check", action="store_true")
    options.add_argument("--jobs", type=int, default=1)
    o = options.parse_args()
    repo, build = os.path.abspath(o.repo), os.path.abspath(o.build)
    named = commands(repo)
    if o.check:
        wrong = {c: why for c in named if left_out(c) != "a place holder" and (why := exists(c, repo, build))}
        for command, why in wrong.items():
            print(f"{named[command]}: {command}: {why}")
        print(f"{len(named)} commands named, {len(wrong)} wrong")
        return 1 if wrong or len(named) < 60 else 0
    only = o.only.split()
    chosen = [c for c in named if (any(w in c.split() or w == c or w in c.split("/") for w in only) if only else not left_out(c))]
    if o.list:
        for c in named:
            print(f"{c:90} {left_out(c) and 'left out: ' + left_out(c)}")
        return 0
    folder = os.path.join(build, "headlines")
    os.makedirs(folder, exist_ok=True)
    whole = digest(repo, *TOOLS)
    tools_of = {c: digest(repo, *LESS[c]) if c in LESS else whole for c in named}
    table, done = os.path.join(folder, "table.tsv"), {}
    if os.path.exists(table):
        done = {row["command"]: row for row in csv.DictReader(open(table), delimiter="\t")}
    went_through = {c for c, row in done.items() if row["exit"] == "0" and row["tools"] == tools_of.get(c)}

    def rank(command):  # the suite first, then what takes longest, as far as that is known; several targets last
        took = float(done[command]["seconds"]) if command in done else LIMITS.get(command, 300)
        return command != SUITE, len(shlex.split(command)) > 4, -took

    waiting = [c for c in sorted(chosen, key=rank) if only or c not in went_through]
    one = threading.Lock()

    def take(command, tree):
        with one:
            by = "" if only else seen_by(command, folder, build, went_through)
        log, code, seconds = log_of(command, folder), 0, 0.0
        if not by:
            limit = o.limit or LIMITS.get(command, 3600)
            print(f"{command} (at most {limit:g} s) ...", flush=True)
            code, seconds = run(command, tree, build, limit, log)
            print(f"  exit {code} after {seconds:.1f} s: {command}", flush=True)
        with one:
            done[command] = {"command": command, "page": named[command], "exit": str(code), "seconds": f"{seconds:.1f}", "tools": tools_of[command],
                             "when": datetime.datetime.now().isoformat(timespec="minutes"), "last": "seen by " + by if by else last_line(log)}
            if code == 0:
                went_through.add(command)
            with open(table + ".new", "w", newline="") as f:
                rows = csv.DictWriter(f, list(done[command]), delimiter="\t")
                rows.writeheader(), rows.writerows(done.values())
            os.replace(table + ".new", table)

    def work(tree):
        while waiting:
            take(waiting.pop(0), tree)

    trees = [copy_of(repo, folder, f"tree-{k}") for k in range(o.jobs)]
    if waiting and waiting[0] == SUITE:  # what it passes is known to all
        take(waiting.pop(0), trees[0])
    workers = [threading.Thread(target=work, args=(tree,)) for tree in trees]
    for w in workers:
        w.start()
    for w in workers:
        w.join()
    print(f"\n{'exit':>4} {'seconds':>8}  command")
    for command in chosen:
        row = done[command]
        print(f"{row['exit']:>4} {row['seconds']:>8}  {command}" + ("" if row["exit"] == "0" else f"   {row['last']}"))
    failed = [c for c in chosen if done[c]["exit"] != "0"]
    print(f"{len(chosen)} commands, {len(failed)} failed; {table}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
