# SPDX-License-Identifier: GPL-3.0-or-later
"""What the benches of growth share: processor seconds and memory of a command, and how they grow."""
import math
import os
import resource
import subprocess


def cost(words, limit):
    """Processor seconds (user and system) and the largest memory [bytes] of a process, or None where it fails or takes more than `limit` of
    them; what it said is in the file `words`."""
    with open("words", "w") as said:
        child = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=said,
                                 preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 1)))
        _, status, used = os.wait4(child.pid, 0)
    return (used.ru_utime + used.ru_stime, used.ru_maxrss * 1024.0) if status == 0 else None


def slope(points):
    """Of log y over log n, by least squares."""
    points = [(math.log(n), math.log(y)) for n, y in points if y > 0]
    if len(points) < 2:
        return math.nan
    mx, my = (sum(p[k] for p in points) / len(points) for k in (0, 1))
    over = sum((x - mx)**2 for x, _ in points)
    return sum((x - mx) * (y - my) for x, y in points) / over if over > 0 else math.nan
