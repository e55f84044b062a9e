#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""hilo-advise on what not every level can have: ties, contacts with a stiffness of their own, supports of some components, loads by mass,
shells that cannot stiffen. Each scene gets an answer in which only those regions have another level that have to, or is refused with the
solver's own words and exit.  Usage: advise_kinds.py BIN"""
import os
import tempfile

import advised
from advised import imported, peak, told, write


class Deck:
    """Blocks of hexahedra of 8 nodes, with sets of their ends and middle along x: NAME0, NAME1, NAMEm."""

    def __init__(self):
        self.nodes, self.text, self.cells = [], "", 0

    def block(self, name, at, size, n):
        ids = {}
        for place in ((i, j, k) for k in range(n[2] + 1) for j in range(n[1] + 1) for i in range(n[0] + 1)):
            self.nodes.append([a + s * p / m for a, s, p, m in zip(at, size, place, n)])
            ids[place] = len(self.nodes)
        self.text += f"*ELEMENT, TYPE=C3D8, ELSET={name}\n"
        for k in range(n[2]):
            for j in range(n[1]):
                for i in range(n[0]):
                    self.cells += 1
                    corners = [ids[i + a, j + b, k + c] for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
                    self.text += ", ".join(map(str, [self.cells] + corners)) + "\n"
        for end, i in (("0", 0), ("m", n[0] // 2), ("1", n[0])):
            self.text += f"*NSET, NSET={name}{end}\n" + ", ".join(str(v) for p, v in ids.items() if p[0] == i) + "\n"
        self.text += f"*MATERIAL, NAME=m{name}\n*ELASTIC\n2e9, .3\n*DENSITY\n1000\n*SOLID SECTION, ELSET={name}, MATERIAL=m{name}\n"
        return self

    def write(self):
        imported("*NODE\n" + "".join(f"{i + 1}, {x:.9g}, {y:.9g}, {z:.9g}\n" for i, (x, y, z) in enumerate(self.nodes)) + self.text)


def hinge(name, a, b, x):
    return advised.hinge(name, a, b, [x, 0.025, 0.025])


def scene(more, end=0.1, step=1e-3):
    return f'gravity = [0, 0, -9.81]\n[time]\nend = {end}\nstep = {step}\n[region."*"]\ndamping = 1e-4\n' + peak("pin", "pin") + hinge("pin", "ground", "a0", 0) + more


def advise(text, *options):
    """Levels of the base, the largest that was judged by, and what was chosen."""
    write(text)
    advice = told("mesh.h5", "--tol", "3%", *options)
    return {r["region"]: (r["reference"], r["level"], r["why"]) for r in advice["regions"]}, advice


def refused(text, code, *what):
    write(text)
    advised.refused([code], what, "mesh.h5", "--tol", "3%")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    bar, bars = (0.6, 0.05, 0.05), Deck()
    bars.block("a", (0, 0, 0), bar, (4, 1, 1)).block("b", (0.6, 0, 0), bar, (4, 2, 2)).block("c", (1.2, 0, 0), bar, (4, 1, 1)).write()
    tip = hinge("tip", "b1", "c0", 1.2)

    # a tie takes linear regions, and one of its sides may be rigid, not both
    levels, advice = advise(scene(tip + '[[tie]]\nname = "weld"\na = "a"\nb = "b"\n'))
    assert [levels[r][0] for r in "abc"] == ["linear", "linear", "linear"], levels
    assert {levels["a"][1], levels["b"][1]} != {"rigid"}, levels

    # a support of one component is none of a linear or rigid region: that of the set, no other
    joints = hinge("knee", "a1", "b0", 0.6) + tip
    levels, advice = advise(scene(joints + '[[motion]]\nkind = "fixed"\nname = "shelf"\non = "bm"\ncomponents = "z"\n', step=4e-4))
    assert [levels[r][0] for r in "abc"] == ["linear", "nonlinear", "linear"] and levels["b"][1] == "nonlinear", levels

    # a contact that gives its stiffness wants its region rigid; without, it may not be
    floor = '[[obstacle]]\nkind = "plane"\nname = "floor"\nat = [0, 0, -0.02]\naxis = [0, 0, 1]\n[[contact]]\nname = "stop"\na = "floor"\nb = "c"\nrestitution = 0.5\n'
    levels, advice = advise(scene(joints + floor + "modulus = 1e7\nlayer = 0.05\n", 0.04, 5e-4))
    assert levels["c"][:2] == ("rigid", "rigid") and "as that of a rigid part" in levels["c"][2], levels
    levels, advice = advise(scene(joints + floor, 0.04, 5e-4))
    assert levels["c"][1] != "rigid" and levels["a"][0] == "linear", levels
    assert len([m for m in advice["models"] if m["s"] is None]) <= 4, advice["models"]
    with_both = ("--set", "contact.stop.modulus=1e7", "--set", "contact.stop.layer=0.05", "--keep", "c=linear")
    advised.refused([1], ["leave out modulus and layer"], "mesh.h5", *with_both)

    # what no model takes is refused as the solver refuses it
    refused(scene(joints + floor.replace("0.05", "0.05\nfriction = 1").replace('kind = "plane"', 'kind = "height-field"\nfile = "none.csv"')
                  .replace("axis = [0, 0, 1]\n", "")), 2, "no file none.csv")
    refused(scene(joints.replace('"b0"', '"b7"')), 2, "no model to judge by runs", "b7")
    refused(scene(joints).replace("shapes", "") + '[region.a]\nshapes = "none.csv"\n', 2, "no file none.csv")  # cells would not read it

    # metal that would yield is none of a linear region, however small its strains
    metal = Deck()
    metal.block("a", (0, 0, 0), (0.1, 0.05, 0.05), (3, 1, 1)).write()
    pulled = ('[time]\nend = 0.02\nstep = 5e-4\n[region.a]\nmaterial = "m"\n[material.m]\nkind = "j2"\nE = 2e11\nnu = 0.3\ndensity = 7800\nyield = 250e6\nhardening = 2e9\n'
              '[[motion]]\nkind = "fixed"\nname = "wall"\non = "a0"\n[[probe]]\nname = "tip"\non = "a1"\n'
              '[[quantity]]\nname = "sag"\nkind = "peak"\nformula = "x [m] = probe.tip.x - 0.1"\n'
              '[[load]]\nkind = "force"\nname = "pull"\non = "a1"\nforce = [{}, 0, 0]\nhistory = {{t = [0, 0.02], value = [0, 1], interpolation = "smooth"}}\n')
    for force, level in ((4e5, "linear"), (6.9e5, "nonlinear")):
        levels, advice = advise(pulled.format(force))
        assert levels["a"][1] == level, (force, levels)

    # shells have no strains of the second degree in modes: nonlinear, by their names
    plates = Deck()
    plates.block("a", (0, 0, 0), (0.4, 0.05, 0.004), (4, 1, 1)).block("b", (0.4, 0, 0), (0.4, 0.05, 0.004), (4, 1, 1)).write()
    levels, advice = advise(scene(hinge("knee", "a1", "b0", 0.4) + '[region.a]\nshell = true\nstiffening = true\n[region.b]\nshell = true\n', 0.05, 2.5e-4))
    assert levels["a"][0] == "nonlinear" and levels["b"][0] == "linear", levels

    # two surfaces that meet by a stiffness of the scene are rigid, both
    pair = Deck()
    pair.block("a", (0, 0, 0), bar, (4, 1, 1)).block("b", (0.6, 0, 0), bar, (4, 2, 2)).block("d", (0.6, 0, -0.055), bar, (4, 1, 1)).write()
    block = '[[contact]]\nname = "stop"\na = "d"\nb = "b"\nmodulus = 1e7\nlayer = 0.05\n[[motion]]\nkind = "fixed"\nname = "base"\non = "d0"\n'
    levels, advice = advise(scene(hinge("knee", "a1", "b0", 0.6) + block, 0.02, 5e-4))
    assert levels["b"][:2] == levels["d"][:2] == ("rigid", "rigid") and levels["a"][0] == "linear", levels
print("advise_kinds: well")
