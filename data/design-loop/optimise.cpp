// SPDX-License-Identifier: GPL-3.0-or-later
// The lightest mounting whose cheeks stay below a stress and whose driver below a DRI, by NLopt's COBYLA (linear models of objective and
// constraints, no derivatives).  A design is rounded to what a workshop can make and evaluated by `make out/DESIGN/row.csv`: known
// designs cost nothing, and a second run repeats the first from its files.
//
//   optimise STRESS [MPa] DRI [1]        the makes' talk goes to stderr, one line per design to stdout
#include <nlopt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace {

struct Variable {
  char letter;  // in the design's name
  double least, most, start, step, grain;
};
constexpr Variable variables[] = {{'t', 5, 14, 8, 1, 0.1},       // thickness [mm]
                                  {'k', 40, 160, 80, 20, 2},     // stiffness [kN/m]
                                  {'c', 4, 10, 6.5, 0.5, 0.1}};  // damping [kN s/m]

struct Design {
  std::string name;
  std::array<double, 3> x{};  // its values
  bool converged = false;
  double mass = 0, stress = 0, dri = 0;  // [kg], [MPa], [1]
};

std::string name_of(const double* x) {
  std::ostringstream name;
  for (int i = 0; i < 3; ++i) {
    const auto& v = variables[i];
    name << (i ? "_" : "") << v.letter << std::round(x[i] / v.grain) * v.grain;
  }
  return name.str();
}

std::map<std::string, Design> known;

/// The design nearest to x, made unless it is there.
const Design& design(const double* x) {
  const std::string name = name_of(x);
  const auto [at, is_new] = known.try_emplace(name);
  Design& d = at->second;
  if (!is_new) return d;
  d.name = name;
  for (size_t i = 0; i < 3; ++i) d.x[i] = x[i];
  const std::string row = "out/" + name + "/row.csv";
  if (std::system(("make --silent --no-print-directory BUILT=1 " + row + " >&2").c_str()) != 0) std::exit(1);
  std::ifstream file(row);
  std::vector<std::string> cells;
  for (std::string cell; std::getline(file, cell, ',');) cells.push_back(cell);
  d.converged = cells.at(4) == "converged";
  if (d.converged) d.mass = std::stod(cells.at(5)), d.stress = std::stod(cells.at(6)), d.dri = std::stod(cells.at(7));
  std::printf("%s,%g,%g,%g\n", name.c_str(), d.mass, d.stress, d.dri);
  std::fflush(stdout);
  return d;
}

struct Limit {
  double Design::*value;
  double most;
};

double mass(unsigned, const double* x, double*, void*) { return design(x).mass; }
/// Not positive where the limit is kept; a design that failed breaks it.
double excess(unsigned, const double* x, double*, void* limit) {
  const auto& [value, most] = *static_cast<Limit*>(limit);
  const Design& d = design(x);
  return d.converged ? d.*value / most - 1 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::cerr << "usage: optimise STRESS DRI\n", 1;
  Limit limits[] = {{&Design::stress, std::atof(argv[1])}, {&Design::dri, std::atof(argv[2])}};
  nlopt_opt o = nlopt_create(NLOPT_LN_COBYLA, 3);
  double x[3], least[3], most[3], step[3], grain[3], found;
  for (int i = 0; i < 3; ++i) {
    const auto& v = variables[i];
    least[i] = v.least, most[i] = v.most, x[i] = v.start, step[i] = v.step, grain[i] = v.grain;
  }
  nlopt_set_lower_bounds(o, least), nlopt_set_upper_bounds(o, most), nlopt_set_initial_step(o, step);
  nlopt_set_min_objective(o, mass, nullptr);
  for (Limit& limit : limits) nlopt_add_inequality_constraint(o, excess, &limit, 1e-3);
  nlopt_set_xtol_abs(o, grain);
  nlopt_set_maxeval(o, 50);
  std::printf("design,mass [kg],stress [MPa],DRI [1]\n");
  // The best is of all designs seen, and the search starts again from it until that finds no better: impacts make it stop early.
  const Design* best = nullptr;
  int result = 0;
  for (bool better = true; better;) {
    const Design* const before = best;
    result = nlopt_optimize(o, x, &found);
    for (const auto& [name, d] : known)
      if (d.converged && d.stress <= limits[0].most && d.dri <= limits[1].most && (!best || d.mass < best->mass)) best = &d;
    better = best != before;
    if (best) std::copy(best->x.begin(), best->x.end(), x);
  }
  nlopt_destroy(o);
  std::cerr << known.size() << " designs, NLopt ended with " << result << ": ";
  if (!best) return std::cerr << "none keeps the limits\n", 3;
  std::cerr << best->name << ", " << best->mass << " kg, " << best->stress << " MPa, DRI " << best->dri << '\n';
  return result > 0 ? 0 : 3;
}
