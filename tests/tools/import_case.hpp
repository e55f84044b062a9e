// SPDX-License-Identifier: GPL-3.0-or-later
// What tests of hilo-import share: a folder, runs, and areas and volumes of what was read.
#pragma once
#include <Eigen/Geometry>
#include <sstream>

#include "model/mesh.hpp"
#include "model/store.hpp"
#include "succeeded.hpp"
#include "tool_case.hpp"

namespace hilo::test {

/// Total vector area of facets: outward normals times areas, over the corner nodes.
inline Vec3 vector_area(const Mesh& m, const std::vector<Facet>& facets) {
  Vec3 sum = Vec3::Zero();
  for (const auto& f : facets) {
    const auto n = m.facet_nodes(f);
    const auto corners = n.size() == 6 || n.size() == 3 ? 3 : 4;
    const Vec3 &a = m.X[n[0]], &b = m.X[n[1]], &c = m.X[n[2]];
    sum += corners == 3 ? Vec3((b - a).cross(c - a) / 2) : Vec3((c - a).cross(m.X[n[3]] - b) / 2);
  }
  return sum;
}

inline double volume(const Mesh& m) {
  double v = 0;
  for (std::int64_t c = 0; c < m.n_cells(); ++c) v += quality(m, c).volume;
  return v;
}

inline std::int64_t cells_of(const Mesh& m, const std::string& region) {
  const int r = m.find_region(region);
  return r < 0 ? -1 : std::count(m.region.begin(), m.region.end(), r);
}

class Import : public ToolCase {
 protected:
  /// Imports `file` with `options` and reads the mesh back.
  Mesh imported(const std::string& file, const std::string& options = "") {
    const auto ran = succeeded(place.run("hilo-import " + file + " -o out.h5 " + options), file + ' ' + options);
    out = ran.out, err = ran.err;
    return read_mesh_file(place / "out.h5").mesh;
  }
  /// The same of a file with this text.
  Mesh imported_deck(const std::string& file, const std::string& text, const std::string& options = "") {
    place.write(file, text);
    return imported(file, options);
  }
  void refused_deck(const std::string& file, const std::string& text, const std::string& arguments, int exit, const std::string& message) {
    place.write(file, text);
    refused(file + " " + arguments, exit, message);
  }
  /// Imports a deck with its scene, and runs the scene.
  void solve(const std::string& text, const std::string& file = "a.inp", const std::string& options = "", const std::string& to_run = "") {
    place.write(file, text);
    imported(file, "--scene-out s.toml " + options);
    succeeded(place.run("hilo-solve --quiet s.toml -o run.h5 " + to_run), text_of(place / "s.toml"));
  }
  /// The last row of a history of the run.
  std::vector<double> last(const std::string& history, std::ptrdiff_t width) const {
    const auto all = Store::open(place / "run.h5").read<double>("/history/" + history);
    return {all.end() - width, all.end()};
  }
  void refused(const std::string& arguments, int exit, const std::string& message) {
    expect_refused("hilo-import " + arguments, exit, message);
  }
  /// The import has these words among its messages.
  void expect_said(const std::string& words) const { EXPECT_NE(err.find(words), std::string::npos) << words << '\n' << err; }
  static std::string deck(const std::string& name) { return std::string(HILO_SOURCE) + "/tests/tools/decks/" + name; }

  std::string out, err;
};

/// An import whose scene runs, to run.h5.
class ImportAndRun : public Import {
 protected:
  /// Of columns of the histories, last row less first row.
  std::vector<double> change(const std::string& columns) {
    const auto ran = succeeded(place.run("hilo-post series run.h5 '" + columns + "' -o -"));
    std::vector<std::vector<double>> rows;
    std::istringstream lines(ran.out);
    std::string line, word;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
      std::istringstream words(line);
      rows.emplace_back();
      while (std::getline(words, word, ',')) rows.back().push_back(std::strtod(word.c_str(), nullptr));
    }
    std::vector<double> out;
    for (size_t i = 1; i < rows.back().size(); ++i) out.push_back(rows.back()[i] - rows.front()[i]);
    return out;
  }
  /// Of the table that hilo-solve printed  [Hz]
  double frequency(int mode) {
    std::istringstream lines(table);
    std::string line;
    while (std::getline(lines, line)) {
      std::istringstream words(line);
      int n = 0;
      double f = 0;
      if (words >> n >> f && n == mode) return f;
    }
    return 0;
  }
  std::string table;
};

}  // namespace hilo::test
