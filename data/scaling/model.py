#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Efficiency E(P) = T(1) / (P T(P)) from runs.csv:  model.py RUNS.csv > MODEL.csv.  T(1): the run of one subdomain.

"modelled: vehicle M":   T(P) = imbalance (W(P) - undivided(P))/P + undivided(P) + exchange(P)
W(P): work of P subdomains, measured in one process; undivided: the coarse problem, which every rank solves whole; exchange: messages at
2 us and sums at 2 us log2(P) each, bytes at 5 GB/s: the counts of the largest measured run, messages by as many neighbours as 4 ranks have.

"modelled: vehicle L": one million hexahedra, E = (W/P)/T, against the same work on one rank; work per unknown of the measured subdomains
of that size (102, 51 and 25 thousand unknowns), iterations of P subdomains."""
import csv
import os
import sys
from math import log2

LATENCY, BANDWIDTH, IMBALANCE = 2e-6, 5e9, 1.04  # [s], [bytes/s]
UNKNOWNS_M, UNKNOWNS_L = 85152, 3256659


def efficiencies(rows):
    """(ranks, case, efficiency)."""
    one, serial, measured = None, {}, {}
    for r in rows:
        r = {k: float(v) for k, v in r.items()}
        ranks, parts = int(r["ranks"]), int(r["subdomains"])
        r["work"] = sum(r[k] for k in ("assembly", "set_up", "solve", "output", "rest"))
        if ranks == 1:
            serial[parts] = r
            if parts == 1:
                one = r["work"]
        else:
            measured[ranks] = r["work"]
            per_iteration = [r[k] / r["iterations"] for k in ("messages", "sums", "bytes")]
    messages, sums, sent = per_iteration

    def exchange(P):
        return serial[P]["iterations"] * (messages * LATENCY + sent / BANDWIDTH + sums * LATENCY * log2(P))

    for P, r in serial.items():
        T = r["work"] if P == 1 else IMBALANCE * (r["work"] - r["undivided"]) / P + r["undivided"] + exchange(P)
        yield P, "modelled: vehicle M", one / (P * T)
    for P in (32, 64, 128):
        r = serial[P // 32]  # subdomains as large as those of vehicle L
        work = r["work"] - r["solve"] + r["solve"] * serial[P]["iterations"] / r["iterations"]
        share = UNKNOWNS_L / UNKNOWNS_M * work / P
        yield P, "modelled: vehicle L", share / (IMBALANCE * share + serial[P]["undivided"] + exchange(P))
    yield 1, "measured", 1
    for P, work in measured.items():
        yield P, "measured" if P <= os.cpu_count() else "measured: more ranks than cores", one / (P * work)


def main():
    (runs,) = sys.argv[1:]
    with open(runs) as f:
        rows = list(csv.DictReader(f))
    print("ranks,case,efficiency")
    for ranks, case, efficiency in efficiencies(rows):
        print(f"{ranks},{case},{efficiency:.3f}")


if __name__ == "__main__":
    main()
