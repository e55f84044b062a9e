#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nothing that was written is lost: runs are killed, and find the disk full, at many instants; then they go on.

  fault_drill.py REPO BIN LIB            a part of it, two minutes: in the suite (a fifth of the scenes, another one each day)
  fault_drill.py REPO BIN LIB STRIDE     each STRIDE-th write, and 200 instants of kill -9 on 1, 2 and 3 ranks: make -C tests faults (1);
                                         files cut off after each STRIDE-th 4096 bytes; a clock that jumps
LIB: the preloaded library tests/faults/preload/failing_writes.cpp.

What must hold after every fault: the former results are there as they were, or the new ones are sound up to what was written last
(hilo-show --check); a failing disk is exit 4 with one line; with --restart the run goes on to the same numbers bit by bit on as many ranks,
to the solver's tolerance on others."""
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import h5py

import on_ranks
import share
from drill import SCENES, command, make_meshes, numbers, run, same, scene_files

repo, tools, library = (os.path.abspath(a) for a in sys.argv[1:4])
stride = int(sys.argv[4]) if len(sys.argv) > 4 else 97
all_of_it = len(sys.argv) > 4
kills = 20 if all_of_it else 2
on_ranks.use(tools)
random.seed(2026)
CHECKPOINT = ["--checkpoint", "7steps"]
counts = {"kills": 0, "full disks": 0, "cut files": 0, "restarts": 0, "rows kept": 0}
failures = []


def wrong(text):
    failures.append(text)
    print("WRONG", text, flush=True)


def reference(name, ranks):
    files = scene_files(name)
    done = run(command(name, ranks, *files, "-o", "whole.h5", "--quiet", *CHECKPOINT))
    if done.returncode:
        sys.exit(f"{name}: {done.stderr}")
    return numbers("whole.h5")


def clean():
    for name in os.listdir("."):
        if name.startswith("run"):
            os.remove(name)


def sound(name, what, former):
    """After a fault: the rows of run.h5 if it is the new one, 0 if it is the former or not there."""
    if not os.path.exists("run.h5"):
        if former is not None:
            wrong(f"{name}, {what}: the former results are gone")
        return 0
    with open("run.h5", "rb") as f:
        if former is not None and f.read() == former:
            return 0
    checked = run(["hilo-show", "--check", "run.h5"])
    if checked.returncode or "sound up to" not in checked.stdout and ": ok" not in checked.stdout:
        wrong(f"{name}, {what}: {checked.stdout}{checked.stderr}")
        return 0
    with h5py.File("run.h5", "r") as f:
        return len(f["history/t"])


def go_on(name, ranks, whole, what):
    """From what a fault left to the end, and the numbers are those of the run that was never left."""
    if not os.path.exists("run.checkpoint.h5") and not os.path.exists("run.checkpoint-1.h5"):
        return
    counts["restarts"] += 1
    done = run(command(name, ranks, "--restart", "run.h5", "--quiet", *CHECKPOINT))
    if done.returncode:
        return wrong(f"{name}, {what}, restart: exit {done.returncode} {done.stderr}")
    if bad := same(numbers("run.h5"), whole):
        wrong(f"{name}, {what}, restart: {bad} differ")


def every_write(name, stride):
    """Killed in, and refused from, the n-th write on."""
    whole = reference(name, 1)
    line = command(name, 1, *scene_files(name), "-o", "run.h5", "--quiet", *CHECKPOINT)
    clean()
    run(line, env=dict(os.environ, LD_PRELOAD=library, FAIL_COUNT="count"))
    n = int(open("count").read())
    rows_before = 0
    for how in ("kill", "28", "5"):
        for at in range(1 + random.randrange(stride), n + 1, stride):
            clean()
            former = None
            if at % 2:
                shutil.copy("whole.h5", "run.h5")
                former = open("run.h5", "rb").read()
            done = run(line, env=dict(os.environ, LD_PRELOAD=library, FAIL_AT=str(at), FAIL_HOW=how))
            what = f"{how} at write {at} of {n}"
            counts["kills" if how == "kill" else "full disks"] += 1
            if how == "kill":
                if done.returncode != -signal.SIGKILL:
                    wrong(f"{name}, {what}: exit {done.returncode}, not killed")
            elif done.returncode != 4 or len(done.stderr.strip().splitlines()) != 1:
                wrong(f"{name}, {what}: exit {done.returncode}: {done.stderr}")
            counts["rows kept"] += sound(name, what, former)
            go_on(name, 1, whole, what)
    print(f"{name:20} each {stride}th of {n} writes: killed, no space, input/output error", flush=True)


def five_instants(name, ranks):
    """Killed at five instants from three eighths of its writes on: each time it goes on to the same numbers."""
    whole = reference(name, 1)
    run(command(name, 1, *scene_files(name), "-o", "run.h5", "--quiet", *CHECKPOINT), env=dict(os.environ, LD_PRELOAD=library, FAIL_COUNT="count"))
    n = int(open("count").read())  # on ranks the first one writes about as often
    if ranks > 1:
        whole = reference(name, ranks)
    before = counts["restarts"]
    for k in range(1, 6):
        clean()
        line = command(name, ranks, *scene_files(name), "-o", "run.h5", "--quiet", *CHECKPOINT)
        if run(line, env=dict(os.environ, LD_PRELOAD=library, FAIL_AT=str(n * (k + 2) // 8), FAIL_HOW="kill")).returncode == 0:
            wrong(f"{name} on {ranks} rank(s): not killed at write {n * (k + 2) // 8}")
        go_on(name, ranks, whole, f"killed at write {n * (k + 2) // 8} on {ranks} rank(s)")
    if counts["restarts"] - before != 5:
        wrong(f"{name} on {ranks} rank(s): {counts['restarts'] - before} restarts of five")
    print(f"{name:20} killed at five instants on {ranks} rank(s), gone on with", flush=True)


def any_instant(name, ranks, kills):
    """kill -9 of a rank by the clock."""
    whole = reference(name, ranks)
    line = command(name, ranks, *scene_files(name), "-o", "run.h5", "--quiet", *CHECKPOINT)
    clean()
    began = time.time()
    run(line)
    seconds = time.time() - began
    for k in range(kills):
        clean()
        process = subprocess.Popen(line, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True)
        time.sleep(random.random() * seconds)
        ours = subprocess.run(["pgrep", "-s", str(process.pid), "-f", "^hilo-solve"], capture_output=True, text=True).stdout.split()
        if ranks == 1:
            ours = [str(process.pid)]
        if ours:
            subprocess.run(["kill", "-9", random.choice(ours)], stderr=subprocess.DEVNULL)
        try:
            process.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            wrong(f"{name} on {ranks} ranks: hangs behind kill {k}")
            os.killpg(process.pid, signal.SIGKILL)
        for _ in range(3000):  # mpirun ends before the last of its ranks does
            if subprocess.run(["pgrep", "-s", str(process.pid), "--runstates", "RSD"], capture_output=True).returncode != 0:
                break
            time.sleep(0.01)
        else:
            wrong(f"{name} on {ranks} ranks: a rank outlives kill {k}")
        counts["kills"] += 1
        counts["rows kept"] += sound(name, f"kill {k} on {ranks} ranks", None)
        if process.returncode != 0:
            go_on(name, ranks, whole, f"kill {k} on {ranks} ranks")
    print(f"{name:20} {kills} kills by the clock on {ranks} rank(s)", flush=True)


def other_ranks(name, ranks, others):
    """Kept on some ranks, gone on with on others."""
    whole = reference(name, ranks)
    for other in others:
        clean()
        done = run(command(name, ranks, *scene_files(name), "-o", "run.h5", "--quiet", "--checkpoint", "28steps"))
        if done.returncode:
            return wrong(f"{name}: {done.stderr}")
        done = run(command(name, other, "--restart", "run.h5", "--quiet"))
        if done.returncode:
            wrong(f"{name} kept on {ranks} ranks, on {other}: exit {done.returncode} {done.stderr}")
        elif bad := same(numbers("run.h5"), whole, 1e-6):
            wrong(f"{name} kept on {ranks} ranks, on {other}: {bad} differ")
        counts["restarts"] += 1
    print(f"{name:20} kept on {ranks} rank(s), gone on with on {', '.join(map(str, others))}", flush=True)


def cut_off(name, stride):
    """Results and checkpoints that end too early are told, and the checkpoint before serves."""
    whole = reference(name, 1)
    clean()
    line = command(name, 1, *scene_files(name), "-o", "run.h5", "--quiet", *CHECKPOINT)
    run(line, env=dict(os.environ, LD_PRELOAD=library, FAIL_COUNT="count"))
    n = int(open("count").read())
    for at in range(n * 3 // 4, n * 3 // 4 - 60, -4):  # not while a checkpoint takes the place of the one before
        clean()
        run(line, env=dict(os.environ, LD_PRELOAD=library, FAIL_AT=str(at), FAIL_HOW="kill"))
        left = {f: open(f, "rb").read() for f in os.listdir(".") if f.startswith("run")}
        if {"run.h5", "run.checkpoint.h5", "run.checkpoint-1.h5"} <= left.keys():
            break
    else:
        return wrong(f"{name}: a killed run left {sorted(left)} alone")
    for victim in ("run.h5", "run.checkpoint.h5"):
        for size in range(random.randrange(stride) * 4096, len(left[victim]), 4096 * stride):
            clean()
            for f, content in left.items():
                open(f, "wb").write(content)
            os.truncate(victim, size)
            what = f"{victim} cut off at {size} of {len(left[victim])}"
            counts["cut files"] += 1
            checked = run(["hilo-show", "--check", victim])
            if checked.returncode != 2 or len(checked.stderr.strip().splitlines()) != 1:
                wrong(f"{name}, {what}: exit {checked.returncode} {checked.stdout}{checked.stderr}")
            done = run(command(name, 1, "--restart", "run.h5", "--quiet", *CHECKPOINT))
            if victim == "run.h5":
                if done.returncode != 2 or len(done.stderr.strip().splitlines()) != 1:
                    wrong(f"{name}, {what}, restart: exit {done.returncode} {done.stderr}")
            elif done.returncode:
                wrong(f"{name}, {what}, restart: exit {done.returncode} {done.stderr}")
            elif bad := same(numbers("run.h5"), whole):
                wrong(f"{name}, {what}, restart: {bad} differ")
    print(f"{name:20} results and checkpoint cut off after each {stride}th 4096 bytes", flush=True)


def jumping_clock(name, ranks):
    """The time of day goes to and fro by hours: nothing of a run rests on it."""
    whole = reference(name, ranks)
    clean()
    done = run(command(name, ranks, *scene_files(name), "-o", "run.h5", "--quiet", *CHECKPOINT, "--time-limit", "1h"),
               env=dict(os.environ, LD_PRELOAD=library, FAIL_CLOCK="7200"))
    if done.returncode:
        wrong(f"{name}, a clock that jumps: exit {done.returncode} {done.stderr}")
    elif bad := same(numbers("run.h5"), whole):
        wrong(f"{name}, a clock that jumps: {bad} differ")
    print(f"{name:20} a clock that jumps, {ranks} rank(s)", flush=True)


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    make_meshes(repo)
    for number, (name, (_, _, all_ranks)) in enumerate(SCENES.items()):
        if not all_of_it and not share.today(number, 5):
            continue
        if name != "modes":  # one step: it keeps nothing to go on from
            five_instants(name, all_ranks[0])
        if all_ranks[0] == 1:
            every_write(name, stride)
        for ranks in all_ranks:
            any_instant(name, ranks, kills)
    for name in ("friction and stops", "plastic"):
        cut_off(name, max(1, stride // 24))
    jumping_clock("driven", 1), jumping_clock("flexible", 2)
    for number, name in enumerate(("flexible", "plastic", "parallel")):
        if all_of_it or share.today(number, 3):
            other_ranks(name, 1, [2, 3])
            other_ranks(name, 3, [1, 2])
    print(", ".join(f"{n} {what}" for what, n in counts.items()))
    if min(counts.values()) < (20 if all_of_it else 5):
        wrong("the drill saw too little to say anything")
sys.exit(f"{len(failures)} wrong" if failures else 0)
