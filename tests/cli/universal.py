# SPDX-License-Identifier: GPL-3.0-or-later
"""An independent reader of universal files, from the published columns of datasets 58 (Function at Nodal DOF) and 164 (Units)."""
import math

CASES = {2: ("E13.5", 13), 4: ("E20.12", 20)}  # ordinates that are real: single, double


def columns(line, *widths):
    out, at = [], 0
    for w in widths:
        out.append(line[at:at + w])
        at += w
    assert line[at:].strip() == "", line
    return out


def datasets(path):
    lines = open(path, encoding="ascii").read().split("\n")
    assert lines[-1] == "" and all(len(line) <= 80 for line in lines), max(lines, key=len)
    at = 0
    while at < len(lines) - 1:
        assert lines[at] == "    -1", (at, lines[at])
        end = lines.index("    -1", at + 1)
        yield int(lines[at + 1]), lines[at + 2:end]
        at = end + 1


def read(path):
    """Factors to SI of dataset 164, and a dict for each dataset 58."""
    factors, functions = None, []
    for number, lines in datasets(path):
        if number == 164:
            code, label, mode = columns(lines[0], 10, 20, 10)
            factors = [float(x.replace("D", "e")) for line in lines[1:] for x in line.split()]
            assert int(code) == 1 and len(factors) == 4
            continue
        assert number == 58
        f = {"id": [line.rstrip() for line in lines[:5]]}
        kind, index, version, case, _, name, node, direction, _, reference, ref_node, ref_direction = columns(
            lines[5], 5, 10, 5, 10, 1, 10, 10, 4, 1, 10, 10, 4)
        f.update(kind=int(kind), index=int(index), name=name.rstrip(), node=int(node), direction=int(direction))
        ordinate, n, even, first, step, z = columns(lines[6], 10, 10, 10, 13, 13, 13)
        ordinate, n, even = int(ordinate), int(n), int(even)
        for what, line in zip(("x", "y", "denominator", "z"), lines[7:11]):
            data, length, force, temperature, _, label, _, unit = columns(line, 10, 5, 5, 5, 1, 20, 1, 20)
            f[what] = {"type": int(data), "exponents": (int(length), int(force), int(temperature)), "label": label.rstrip(), "unit": unit.rstrip()}
        width = CASES[ordinate][1]
        numbers = []
        for line in lines[11:]:
            at = 0
            while at < len(line):
                w = width if even or len(numbers) % 2 else 13
                numbers.append(float(line[at:at + w]))
                at += w
        if even:
            f["t"], f["values"] = [float(first) + k * float(step) for k in range(n)], numbers
        else:
            f["t"], f["values"] = numbers[0::2], numbers[1::2]
        assert len(f["values"]) == len(f["t"]) == n and all(map(math.isfinite, numbers))
        f["even"] = bool(even)
        functions.append(f)
    return factors, functions
