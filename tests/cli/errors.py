#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Each row of tests/cli/errors.md is run: `command` | exit code | message.  errors.py REPO BIN [--print] [WORD]

That list's own code blocks make the folder: those that begin with `# FILE` are files, the block behind "runs before" is a script.  Every
command runs in a folder of its own; stderr must have the parts of the message in their order, `...` standing for anything, and a command that
fails must leave the files as they were, but for what its exit code says it keeps (3 and 6: results and checkpoints).
Each row of docs/errors.md, `message` | code | what to do, or `said` | meaning | what to do of warnings, is a part of one of them, with its hint
where that is `code`.  --print writes what each command says instead; WORD chooses rows."""
import os
import re
import shutil
import subprocess
import sys
import tempfile

import on_ranks

repo, tools = (os.path.abspath(a) for a in sys.argv[1:3])
words = [a for a in sys.argv[3:] if a != "--print"]
on_ranks.use(tools)
page = open(os.path.join(repo, "tests/cli/errors.md")).read()
reader = open(os.path.join(repo, "docs/errors.md")).read()


def contents(folder):
    found = {}
    for at, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(at, name)
            found[os.path.relpath(path, folder)] = open(path, "rb").read()
    return found


def check(row, start):
    command, code, message = row
    folder = tempfile.mkdtemp(dir=os.path.dirname(start))
    shutil.copytree(start, folder, dirs_exist_ok=True)
    before = contents(folder)
    done = subprocess.run(["bash", "-c", command], cwd=folder, capture_output=True, text=True, timeout=120, stdin=subprocess.DEVNULL)
    wrong = []
    if done.returncode != code:
        wrong.append(f"exit code {done.returncode}, not {code}")
    if len(message.replace(".", "").strip()) < 8:
        wrong.append("a message so short that any other has it")
    at = 0
    for part in filter(None, (p.strip() for p in message.split("..."))):
        found = done.stderr.find(part, at)
        if found < 0:
            wrong.append(f"lacks \"{part}\"")
            break
        at = found + len(part)
    if code in (1, 2, 4):
        lines = [l for l in done.stderr.splitlines() if re.match(r"hilo-\w+: (?!warning: |note: )", l)]
        if len(lines) != 1:
            wrong.append(f"{len(lines)} lines, not one")
    if code == 0:
        shutil.rmtree(folder)
        return wrong, done
    after = contents(folder)
    situation = re.split(r"[;&] ", command)[:-1]  # what comes before the command in question may change files, that command may not
    may = [re.escape(word) for part in situation for word in re.split(r"[\s=]", part)] + [r"run\..*"] * (code in (3, 6) or "hilo-solve" in str(situation))
    changed = sorted(n for n in before.keys() | after.keys() if before.get(n) != after.get(n) and not any(re.fullmatch(m, n) for m in may))
    if changed:
        wrong.append("changed " + ", ".join(changed))
    shutil.rmtree(folder)
    return wrong, done


def unfounded(rows):
    """Rows of the page that no command of the list shows."""
    found = re.findall(r"^\| `([^`]+)` \| (\d|[^|`][^|]*) \| (.*) \|$", reader, re.M)
    if len(found) != len(re.findall(r"^\| `", reader, re.M)) or not found:
        sys.exit("docs/errors.md has rows that are not: message | code | what to do, or said | meaning | what to do")
    for said, code, do in found:
        hint = re.fullmatch(r"`([^`]+)`(?:[;,.] .*)?", do)
        wanted = [w.replace("\\|", "|") for w in (said, hint[1] if hint else "")]
        if not any(int(code) == c if code.isdigit() else c == 0 for _, c, m in rows if all(w in m for w in wanted)):
            yield said


def main():
    rows = re.findall(r"^\| `([^`]+)` \| (\d) \| `([^`]*)` \|$", page, re.M)
    rows = [(command.replace("\\|", "|"), int(code), message.replace("\\|", "|")) for command, code, message in rows]
    if len(rows) != len(re.findall(r"^\| `", page, re.M)) or not rows:
        sys.exit("tests/cli/errors.md has rows that are not: command | code | message")
    if lost := list(unfounded(rows)):
        sys.exit("\n".join(f"docs/errors.md: no command of tests/cli/errors.md says with this code and hint: {said}" for said in lost))
    with tempfile.TemporaryDirectory() as temporary:
        start = os.path.join(temporary, "start")
        os.mkdir(start)
        for name, text in re.findall(r"^```\w*\n# (\S+)\n(.*?)^```", page, re.M | re.S):
            open(os.path.join(start, name), "w").write(text)
        script = re.search(r"runs before.*?^```\w*\n(.*?)^```", page, re.M | re.S).group(1)
        subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=start, check=True)
        bad = 0
        for row in rows:
            if words and not any(w in row[0] for w in words):
                continue
            wrong, done = check(row, start)
            if "--print" in sys.argv:
                print(f"$ {row[0]}\n  {done.returncode}: {done.stderr.strip()}")
            if wrong:
                bad += 1
                print(f"$ {row[0]}\n  {'; '.join(wrong)}\n  exit {done.returncode}: {done.stderr.strip()}", file=sys.stderr)
        print(f"{len(rows)} rows, {bad} wrong")
        missing = set(range(1, 7)) - {5} - {code for _, code, _ in rows}
        if missing:
            sys.exit(f"no row for exit codes {missing}")
        sys.exit(1 if bad else 0)


main()
