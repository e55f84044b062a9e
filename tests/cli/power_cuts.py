#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Power cuts: what a disk may have kept of a run, at every instant.

  power_cuts.py REPO BIN LIB [STRIDE [TRIES]]     each STRIDE-th change or sync of a file, TRIES disks each

LIB: the preloaded library tests/faults/preload/failing_writes.cpp, which logs all changes and syncs of a run and lets its clock hurry, so that
it syncs from its first commits on.  The log is replayed up to an instant.  What was synced is on the disk; of each write behind that any of its
sectors may be there, or not, and any of the new ends of a file; names (created, renamed, removed) come in their order, some of the last
missing, and a sync brings all that went before it, as journalling file systems (ext4, xfs, btrfs) do.

What must hold: run.h5, where it is there, is sound, with the rows of the last commit that was synced at least, or it is the former one byte by
byte; with --restart the run goes on to the same numbers bit by bit, and it can wherever a checkpoint was synced."""
import os
import random
import sys
import tempfile

import h5py

from drill import command, make_meshes, numbers, run, same, scene_files

repo, tools, library = (os.path.abspath(a) for a in sys.argv[1:4])
stride = int(sys.argv[4]) if len(sys.argv) > 4 else 101
tries = int(sys.argv[5]) if len(sys.argv) > 5 else 2
os.environ.update(PATH=tools + ":" + os.environ["PATH"], OPENBLAS_NUM_THREADS="1")
random.seed(2026)
SECTOR = 512
CHECKPOINT = ["--checkpoint", "7steps"]
failures, counts = [], {"cuts": 0, "with results": 0, "restarts": 0}


def wrong(text):
    failures.append(text)
    print("WRONG", text, flush=True)


class File:
    def __init__(self, synced=b""):
        self.synced, self.since = synced, []  # since: (place, bytes), or (end, None)

    def content(self, keeps=lambda: True):
        """With those sectors and ends since the last sync that `keeps` says of each."""
        out = bytearray(self.synced)
        for place, data in self.since:
            if data is None:
                if keeps():
                    del out[place:]
                    out.extend(bytes(place - len(out)))
                continue
            at = 0
            while at < len(data):  # up to the next border of sectors
                n = min(SECTOR - (place + at) % SECTOR, len(data) - at)
                if keeps():
                    out.extend(bytes(max(0, place + at + n - len(out))))
                    out[place + at:place + at + n] = data[at:at + n]
                at += n
        return bytes(out)


class Disk:
    """Names and files as the running program sees them, and what of the names is safe."""

    def __init__(self, former):
        self.names = dict(former)
        self.safe, self.since = dict(former), []

    def name(self, change):
        apply(self.names, change)
        self.since.append(change)

    def take(self, what, path, more, data):
        path = os.path.basename(path)
        if what in ("write", "end") and path not in self.names:
            self.name(("new", path, File()))
        if what == "write":
            self.names[path].since.append((int(more[0]), data))
        elif what == "end":
            self.names[path].since.append((int(more[0]), None))
        elif what == "sync" and path in self.names:
            file = self.names[path]
            file.synced, file.since = file.content(), []
            self.safe, self.since = dict(self.names), []
        elif what == "rename" and path in self.names:
            self.name(("rename", path, os.path.basename(more[0])))
        elif what == "unlink" and path in self.names:
            self.name(("unlink", path, None))

    def lay_out(self, names, keeps):
        for old in os.listdir("."):
            if old.startswith("run"):
                os.remove(old)
        for path, file in names.items():
            with open(path, "wb") as f:
                f.write(file.content(keeps))

    def cut(self):
        """What may be there when the power comes back."""
        names = dict(self.safe)
        for change in self.since[:random.randint(0, len(self.since))]:
            apply(names, change)
        share = random.choice([0, 0.1, 0.5, 0.9, 1])
        self.lay_out(names, lambda: random.random() < share)


def apply(names, change):
    what, path, more = change
    if what == "new":
        names[path] = more
    elif what == "rename":
        names[more] = names.pop(path)
    else:
        names.pop(path, None)


def changes(log):
    with open(log, "rb") as f:
        while line := f.readline():
            what, path, *more = line.decode().split()
            yield what, path, more, f.read(int(more[1])) if what == "write" else b""


def rows_of(path):
    with h5py.File(path, "r") as f:
        return len(f["history/t"])


def power_cuts(name, former):
    """`former`: the bytes of a file that the run replaces, or None."""
    for old in os.listdir("."):
        if old.startswith(("run", "log")):
            os.remove(old)
    if former is not None:
        with open("run.h5", "wb") as f:
            f.write(former)
    line = command(name, 1, *scene_files(name), "-o", "run.h5", "--quiet", *CHECKPOINT)
    done = run(line, env=dict(os.environ, LD_PRELOAD=library, FAIL_LOG="log", FAIL_HASTE="300"))
    if done.returncode:
        sys.exit(f"{name}: {done.stderr}")
    whole = numbers("run.h5")
    disk = Disk({} if former is None else {"run.h5": File(former)})
    least, has_checkpoint, began, at = 0, False, random.randrange(stride), 0
    for at, (what, path, more, data) in enumerate(changes("log")):
        disk.take(what, path, more, data)
        if what == "unlink" and path.endswith("run.h5.journal") and not disk.names["run.h5"].since:  # a commit, and synced
            disk.lay_out(disk.names, lambda: True)
            least = max(least, rows_of("run.h5"))
        has_checkpoint |= what == "sync" and "run.checkpoint.h5" in disk.safe
        if (at + began) % stride == 0:
            for _ in range(tries):
                disk.cut()
                judge(name, f"cut behind change {at}{' over a former run' if former else ''}", whole, least, has_checkpoint, former)
    print(f"{name:20} power cut behind each {stride}th of {at + 1} changes and syncs, {tries} disks each; {least} rows safe at the end", flush=True)
    if least < 5:
        wrong(f"{name}: only {least} rows were ever safe")


def judge(name, what, whole, least, has_checkpoint, former):
    counts["cuts"] += 1
    there = os.path.exists("run.h5")
    if former is not None and not there:
        return wrong(f"{name}, {what}: the former results are gone")
    if not there:
        return wrong(f"{name}, {what}: results that were safe are gone") if least else None
    with open("run.h5", "rb") as f:
        if least == 0 and f.read() == former:
            return None
    counts["with results"] += 1
    checked = run(["hilo-show", "--check", "run.h5"])
    if checked.returncode or "sound up to" not in checked.stdout and ": ok" not in checked.stdout:
        return wrong(f"{name}, {what}: {checked.stdout}{checked.stderr}")
    if rows_of("run.h5") < least:
        return wrong(f"{name}, {what}: {rows_of('run.h5')} rows of {least} that were safe")
    if not any(os.path.exists(f"run.checkpoint{k}.h5") for k in ("", "-1")):
        return wrong(f"{name}, {what}: the checkpoint that was safe is gone") if has_checkpoint else None
    counts["restarts"] += 1
    done = run(command(name, 1, "--restart", "run.h5", "--quiet", *CHECKPOINT))
    if done.returncode:
        wrong(f"{name}, {what}, restart: exit {done.returncode} {done.stderr}")
    elif bad := same(numbers("run.h5"), whole):
        wrong(f"{name}, {what}, restart: {bad} differ")
    return None


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    make_meshes(repo)
    for scene in ("friction and stops", "driven", "plastic"):
        power_cuts(scene, None)
        power_cuts(scene, b"what was there before")
    print(", ".join(f"{n} {what}" for what, n in counts.items()))
    if min(counts.values()) < 20:
        wrong("the drill saw too little to say anything")
sys.exit(f"{len(failures)} wrong" if failures else 0)
