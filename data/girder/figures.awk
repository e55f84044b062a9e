# SPDX-License-Identifier: GPL-3.0-or-later
# Two lines: the buckling load, and the stiffness beyond it over that at first, beside what is known.
function at(load,   i) {  # abscissa of the path at a load
  for (i = 2; y[i] < load && i < n; ++i);
  return x[i - 1] + (x[i] - x[i - 1])*(load - y[i - 1])/(y[i] - y[i - 1])
}
FNR == NR && FNR == 3 { factor = $2 }
FNR < NR && FNR > 1 { x[++n] = $1; y[n] = $2 }
END {
  bends = case == "bend"
  strips = bends ? 37.14 : 280.64
  load = factor*(bends ? 60 : 450)
  printf "%-6s buckles at %7.2f %-5s  finite strips %7.2f (%+.1f %%)  long plate on hinges, k = 4: %7.2f\n", case, load, bends ? "kN m" : "kN",
    strips, 100*(load/strips - 1), bends ? 27.32 : 273.27
  printf "%-6s stiffness beyond %.3f of that before  by hand %.3f\n", case,
    0.3*strips/(at(1.45*strips) - at(1.15*strips))/(y[3]/x[3]), bends ? 0.739 : 0.408
}
