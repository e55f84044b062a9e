#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a page of docs in an empty folder: a toml block that names its file in its first line is written there, sh and python blocks run, in
the order of the page.  Usage: page.py REPO BIN PAGE"""
import os
import re
import subprocess
import sys
import tempfile

repo, bin_folder, page = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2]), sys.argv[3]
text = open(os.path.join(repo, "docs", page)).read()
environment = dict(os.environ, PATH=bin_folder + ":" + os.environ["PATH"])
ran = 0
with tempfile.TemporaryDirectory() as folder:
    for kind, block in re.findall(r"^```(\w+)\n(.*?)^```$", text, re.M | re.S):
        name = re.match(r"# (\S+\.toml):", block)
        if kind == "toml" and name:
            open(os.path.join(folder, name[1]), "w").write(block)
        elif kind in ("sh", "python"):
            command = ["bash", "-euo", "pipefail", "-c", block] if kind == "sh" else ["/usr/bin/python3", "-c", block]
            done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=300)
            print(done.stdout, end="")
            if done.returncode != 0:
                sys.exit(f"{page}: exit {done.returncode} of\n{block}{done.stderr}")
            ran += 1
    print(f"{page}: {ran} blocks ran; it left {sorted(os.listdir(folder))}")
    assert ran > 0, "the page has no block that runs"
