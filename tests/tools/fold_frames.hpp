// SPDX-License-Identifier: GPL-3.0-or-later
// Frames of strips of shells as decks, for tests beside beam theory.
#pragma once
#include <fmt/format.h>

#include "import_case.hpp"

namespace hilo::test::fold_frames {

inline constexpr double E = 1e9, t = 0.1, EI = E * t * t * t / 12, EA = E * t, kGA = 5. / 6 * E / 2 * t;  // of strips 1 wide, nu = 0

/// Strips along polylines in the plane of x and z, one cell (or more) wide along y.
struct Frame {
  double step = 0.5;
  int across = 1;
  std::string nodes, cells;
  std::map<std::pair<long, long>, int> number;  // first node of a station
  std::map<std::string, std::string> of_set;
  int n_cells = 0;

  int station(double x, double z) {
    const auto [it, fresh] =
        number.try_emplace({std::lround(1e6 * x), std::lround(1e6 * z)}, static_cast<int>(number.size()) * (across + 1) + 1);
    if (fresh)
      for (int k = 0; k <= across; ++k) nodes += fmt::format("{},{},{},{}\n", it->second + k, x, static_cast<double>(k) / across, z);
    return it->second;
  }
  void strip(double x0, double z0, double x1, double z1, const std::string& set = "PLATE") {
    const int n = static_cast<int>(std::lround(std::hypot(x1 - x0, z1 - z0) / step));
    for (int i = 0; i < n; ++i) {
      const double a = static_cast<double>(i) / n, b = static_cast<double>(i + 1) / n;
      const int p = station(x0 + a * (x1 - x0), z0 + a * (z1 - z0)), q = station(x0 + b * (x1 - x0), z0 + b * (z1 - z0));
      for (int k = 0; k < across; ++k) of_set[set] += fmt::format("{},{},{},{},{}\n", ++n_cells, p + k, q + k, q + k + 1, p + k + 1);
    }
  }
  std::string nodes_at(double x, double z) {
    const int p = station(x, z);
    std::string s;
    for (int k = 0; k <= across; ++k) s += fmt::format("{}{}", k ? "," : "", p + k);
    return s + "\n";
  }
  /// Forces or moments on the nodes of a station, whose sum is `value`.
  std::string load(double x, double z, int component, double value) {
    const int p = station(x, z);
    std::string s;
    for (int k = 0; k <= across; ++k)
      s += fmt::format("{},{},{:.15g}\n", p + k, component, value / across * (k == 0 || k == across ? 0.5 : 1));
    return s;
  }
  std::string deck(const std::string& sets, const std::string& supports, const std::string& loads, const std::string& more = "",
                   const std::string& procedure = "*STATIC") const {
    std::string s = "*NODE\n" + nodes, sections;
    for (const auto& [set, cells_of] : of_set) {
      s += "*ELEMENT, TYPE=S4, ELSET=" + set + "\n" + cells_of;
      sections += fmt::format("*SHELL SECTION, ELSET={}, MATERIAL=M\n{}\n", set, set == "THICK" ? 2 * t : t);
    }
    return s + sets + fmt::format("*MATERIAL, NAME=M\n*ELASTIC\n{},0.\n*DENSITY\n1000\n", E) + sections + more + "*BOUNDARY\n" + supports +
           "*STEP\n" + procedure + "\n*CLOAD\n" + loads + "*END STEP\n";
  }
};

/// A strip between two blocks of solids, on their upper edges: a beam on two hinges, with 1e-3 down in the middle, TIP.
inline std::string strip_between_blocks() {
  std::string nodes = "*NODE\n", cells = "*ELEMENT, TYPE=S4, ELSET=PLATE\n";
  for (int i = 0; i <= 20; ++i) nodes += fmt::format("{},{},0,0\n{},{},1,0\n", 2 * i + 1, i / 2., 2 * i + 2, i / 2.);
  for (int i = 0; i < 20; ++i) cells += fmt::format("{},{},{},{},{}\n", i + 1, 2 * i + 1, 2 * i + 3, 2 * i + 4, 2 * i + 2);
  for (int end = 0; end < 2; ++end) {
    const double x0 = end ? 10 : 0, x1 = end ? 11 : -1;
    const int n = 100 + 10 * end;
    nodes += fmt::format("{},{},0,-1\n{},{},1,-1\n{},{},0,-1\n{},{},1,-1\n{},{},0,0\n{},{},1,0\n", n, x0, n + 1, x0, n + 2, x1, n + 3, x1,
                         n + 4, x1, n + 5, x1);
  }
  cells += "*ELEMENT, TYPE=C3D8, ELSET=BLOCK\n101,102,100,101,103,104,1,2,105\n102,110,112,113,111,41,114,115,42\n";
  return nodes + cells +
         "*NSET, NSET=ROOT\n100,101,102,103,110,111,112,113\n*NSET, NSET=TIP\n21,22\n*MATERIAL, NAME=M\n*ELASTIC\n1e9,0.\n*DENSITY\n1000\n"
         "*MATERIAL, NAME=HARD\n*ELASTIC\n1e12,0.\n*DENSITY\n1000\n"
         "*SHELL SECTION, ELSET=PLATE, MATERIAL=M\n.1\n*SOLID SECTION, ELSET=BLOCK, MATERIAL=HARD\n*BOUNDARY\nROOT,1,3\n"
         "*STEP\n*STATIC\n*CLOAD\n21,3,5e-4\n22,3,5e-4\n*END STEP\n";
}

class Folds : public test::Import {
 protected:
  std::string tags;  // options of hilo-tag, or none

  /// How far the set TIP goes; `more` scene lines, `ranks` of them.
  Vec3 tip(const std::string& deck, const std::string& more = "", int ranks = 1) {
    place.write("deck.inp", deck);
    imported("deck.inp", "--thicken --scene-out scene.toml");
    if (!tags.empty()) {
      EXPECT_EQ(place.run("hilo-tag --quiet out.h5 " + tags + " -o tags.h5").exit, 0) << tags;
    }
    place.write("run.toml", test::text_of(place / "scene.toml") + "\n[[probe]]\nname = \"TIP\"\non = \"TIP\"\n" + more);
    const auto ran =
        place.run(fmt::format("{}hilo-solve run.toml {} -o run.h5", ranks > 1 ? test::for_ranks + fmt::format(" mpirun -n {} ", ranks) : "",
                              tags.empty() ? "" : "tags.h5"));
    EXPECT_EQ(ran.exit, 0) << ran.err;
    err += ran.err;
    if (ran.exit != 0) return Vec3::Zero();
    const Store run = Store::open(place / "run.h5");
    const auto x = run.read<double>("/history/probe/TIP");
    const size_t n = x.size() / run.shape("/history/probe/TIP")[0];
    return Vec3(x[x.size() - n] - x[0], x[x.size() - n + 1] - x[1], x[x.size() - n + 2] - x[2]);
  }
};

}  // namespace hilo::test::fold_frames
