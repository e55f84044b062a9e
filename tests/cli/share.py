# SPDX-License-Identifier: GPL-3.0-or-later
"""Long drills run a share of their cases in the suite, another one each day, and all of them by their target of tests/Makefile."""
import datetime
import os

DAY = int(os.environ.get("HILO_DAY", datetime.date.today().toordinal()))

print(f"HILO_DAY={DAY}: a share of the cases, unless all were asked for", flush=True)


def today(number, parts):
    """Is the case of this number run today, where one of so many parts is?  HILO_DAY=N repeats another day."""
    return number % parts == DAY % parts
