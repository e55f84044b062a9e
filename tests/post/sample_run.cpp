// SPDX-License-Identifier: GPL-3.0-or-later
#include "sample_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "model/schema.hpp"
#include "model/store.hpp"

namespace hilo::sample {
namespace {

namespace fs = std::filesystem;

std::int32_t new_region(Mesh& mesh, const std::string& name) {
  mesh.region_name.push_back(name);
  mesh.region_data.push_back({});
  return static_cast<std::int32_t>(mesh.region_name.size()) - 1;
}

std::int64_t new_node(Mesh& mesh, const Vec3& x) {
  mesh.X.push_back(x);
  mesh.node_id.push_back(mesh.n_nodes());
  return mesh.n_nodes() - 1;
}

/// A mapped block of hexahedra; `closed` joins its second direction to a ring.
void add_block(Mesh& mesh, const std::string& region, std::array<int, 3> n, bool closed,
               const std::function<Vec3(double, double, double)>& map) {
  const auto r = new_region(mesh, region);
  const int rows = closed ? n[1] : n[1] + 1;
  std::vector<std::int64_t> node;
  for (int k = 0; k <= n[2]; ++k)
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i <= n[0]; ++i) node.push_back(new_node(mesh, map(double(i) / n[0], double(j) / n[1], double(k) / n[2])));
  const auto at = [&](int i, int j, int k) { return node[static_cast<size_t>((k * rows + j % rows) * (n[0] + 1) + i)]; };
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        const std::array cell{at(i, j, k),     at(i + 1, j, k),     at(i + 1, j + 1, k),     at(i, j + 1, k),
                              at(i, j, k + 1), at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)};
        mesh.add_cell(Shape::hex8, cell, r, mesh.n_cells() + 1);
      }
}

/// Mid-side nodes of cells, shared between neighbours, moved by `bend` from the middle of their ends.
struct MidNodes {
  Mesh& mesh;
  std::function<Vec3(const Vec3&)> bend;
  std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t> known;
  std::int64_t operator()(std::int64_t a, std::int64_t b) {
    const auto key = std::minmax(a, b);
    if (const auto found = known.find(key); found != known.end()) return found->second;
    const Vec3 middle = 0.5 * (mesh.X[static_cast<size_t>(a)] + mesh.X[static_cast<size_t>(b)]);
    return known[key] = new_node(mesh, bend ? bend(middle) : middle);
  }
};

void add_curved_hex20(Mesh& mesh, const std::string& region) {
  // A quarter of a thick ring of two cells: mid-side nodes on the circle.
  const auto r = new_region(mesh, region);
  const Vec3 centre(0.6, 0, 0.55);
  const auto on = [&](double radius, double angle, double y) {
    return Vec3(centre + Vec3(radius * std::cos(angle), y, radius * std::sin(angle)));
  };
  constexpr std::array edges{std::pair{0, 1}, std::pair{1, 2}, std::pair{2, 3}, std::pair{3, 0}, std::pair{4, 5}, std::pair{5, 6},
                             std::pair{6, 7}, std::pair{7, 4}, std::pair{0, 4}, std::pair{1, 5}, std::pair{2, 6}, std::pair{3, 7}};
  const auto round = [&](const Vec3& x) {
    const Vec3 d = x - centre;
    const double flat = std::hypot(d.x(), d.z()), radius = flat < 0.16 ? 0.15 : 0.3;
    if (std::abs(flat - 0.225) < 0.005) return x;
    return Vec3(centre + Vec3(d.x() * radius / flat, d.y(), d.z() * radius / flat));
  };
  MidNodes mid{mesh, round, {}};
  std::array<std::array<std::int64_t, 4>, 3> ring{};
  for (size_t k = 0; k < 3; ++k) {
    const double a = M_PI / 2 * static_cast<double>(k);
    ring[k] = {new_node(mesh, on(0.15, a, -0.2)), new_node(mesh, on(0.3, a, -0.2)), new_node(mesh, on(0.3, a, 0.2)),
               new_node(mesh, on(0.15, a, 0.2))};
  }
  for (size_t k = 0; k < 2; ++k) {
    std::vector<std::int64_t> cell{ring[k].begin(), ring[k].end()};
    cell.insert(cell.end(), ring[k + 1].begin(), ring[k + 1].end());
    for (const auto& [a, b] : edges) cell.push_back(mid(cell[static_cast<size_t>(a)], cell[static_cast<size_t>(b)]));
    mesh.add_cell(Shape::hex20, cell, r, mesh.n_cells() + 1);
  }
}

void add_tet10(Mesh& mesh, const std::string& region) {
  const auto r = new_region(mesh, region);
  MidNodes mid{mesh, nullptr, {}};
  std::array<std::int64_t, 8> box{};
  for (int i = 0; i < 8; ++i)
    box[static_cast<size_t>(i)] = new_node(mesh, Vec3(-1.5 + 0.5 * (i & 1), -0.25 + 0.5 * ((i >> 1) & 1), -0.9 + 0.4 * (i >> 2)));
  constexpr int tets[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
  constexpr int edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
  for (const auto& t : tets) {
    std::vector<std::int64_t> cell;
    for (const int i : t) cell.push_back(box[static_cast<size_t>(i)]);
    for (const auto& e : edges) cell.push_back(mid(cell[static_cast<size_t>(e[0])], cell[static_cast<size_t>(e[1])]));
    mesh.add_cell(Shape::tet10, cell, r, mesh.n_cells() + 1);
  }
}

}  // namespace

Mesh cube(int n) {
  Mesh mesh;
  add_block(mesh, "cube", {n, n, n}, false, [](double u, double v, double w) { return Vec3(u, v, w); });
  return mesh;
}

Mesh machine() {
  Mesh mesh;
  add_block(mesh, "hull", {10, 6, 4}, false,
            [](double u, double v, double w) { return Vec3(-2 + 3 * u - 0.3 * w, -0.8 + 1.6 * v, -0.5 + 0.8 * w); });
  add_block(mesh, "barrel", {40, 24, 2}, true, [](double u, double v, double w) {
    const double radius = 0.11 + (0.07 - 0.03 * u) * w, a = -2 * M_PI * v;
    return Vec3(0.8 + 2.4 * u, radius * std::cos(a), 0.6 + radius * std::sin(a));
  });
  add_curved_hex20(mesh, "support");
  add_tet10(mesh, "foot");
  const auto strut = new_region(mesh, "strut");
  const std::array bar{new_node(mesh, {-1.6, -0.6, 0.3}), new_node(mesh, {-1.6, -0.6, 1.1}), new_node(mesh, {-1.6, 0.6, 1.1}),
                       new_node(mesh, {-1.6, 0.6, 0.3})};
  for (size_t k = 0; k < 3; ++k) mesh.add_cell(Shape::bar2, std::array{bar[k], bar[k + 1]}, strut, mesh.n_cells() + 1);
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
    const auto& shape = info(mesh.shape[static_cast<size_t>(c)]);
    for (std::int64_t f = 0; f < static_cast<std::int64_t>(shape.facets.size()); ++f) {
      const auto nodes = mesh.facet_nodes({c, f});
      const auto all = [&](auto&& test) {
        return std::all_of(nodes.begin(), nodes.end(), [&](auto n) { return test(mesh.X[static_cast<size_t>(n)]); });
      };
      if (all([](const Vec3& x) { return x.x() > 3.19; })) mesh.facet_sets["muzzle"].push_back({c, f});
      if (all([](const Vec3& x) { return x.z() < -0.89; })) mesh.facet_sets["ground_side"].push_back({c, f});
    }
  }
  for (std::int64_t n = 0; n < mesh.n_nodes(); ++n)
    if (mesh.X[static_cast<size_t>(n)].x() < 0.801 && mesh.X[static_cast<size_t>(n)].x() > 0.799) mesh.node_sets["breech"].push_back(n);
  return mesh;
}

double front(const Mesh& mesh) {
  double most = 0;
  for (const Vec3& x : mesh.X) most = std::max(most, x.x());
  return most;
}

double stress(const Vec3& X, double front, double rise) { return 200e6 * rise * std::max(0.0, X.x() / front); }

Vec3 seat(double t) {
  const double pulse = t > 0.01 && t < 0.03 ? 100 * std::sin(M_PI * (t - 0.01) / 0.02) : 0;
  return {pulse, 5 * std::sin(2 * M_PI * 400 * t), 1};
}

std::string write_run(const fs::path& folder, const Mesh& mesh, int steps, bool complete, const Histories& histories) {
  write_mesh((folder / "mesh.h5").string(), mesh, {"sample"});
  const std::string path = (folder / "run.h5").string();
  Store run = Store::create_growing(path);
  run.set("/", "format", "hilo run");
  run.set("/", "version", schema_version);
  run.set("/", "complete", std::int64_t{0});
  run.set("/", "title", std::string("Concept vehicle, one shot"));
  run.write_strings("/provenance", std::vector<std::string>{"sample"});
  run.link("/mesh", (folder / "mesh.h5").string(), "/mesh");
  run.write_text("/scene", "title = \"Concept vehicle, one shot\"\nunits = \"m-kg-s\"\n");
  std::vector<std::string> words;
  std::vector<bool> stressed(static_cast<size_t>(mesh.n_nodes()), false);
  for (const auto& name : mesh.region_name) words.push_back(name == "hull" ? "rigid" : "nonlinear");
  run.write_strings("/tags/fidelity", words);
  std::vector<std::int32_t> rank;
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
    rank.push_back(static_cast<std::int32_t>(3 * c / mesh.n_cells()));
    for (const auto n : mesh.cell(c))
      if (words[static_cast<size_t>(mesh.region[static_cast<size_t>(c)])] != "rigid") stressed[static_cast<size_t>(n)] = true;
  }
  run.write<std::int32_t>("/parts/rank", rank, {mesh.n_cells()});
  run.set("/parts/rank", "n_parts", std::int64_t{3});

  run.start_rows<double>("/history/t", {}, "s");
  run.start_rows<double>("/history/energy", {6}, "J");
  run.start_rows<double>("/history/sensor/seat", {3}, "1");
  run.start_rows<double>("/history/joint/trunnion", {6}, "N, N m");
  run.start_rows<double>("/history/probe/muzzle", {9}, "m, m/s, m/s^2");
  for (int i = 0; i < histories.rows; ++i) {
    const double t = i * histories.h;
    run.append<double>("/history/t", std::array{t});
    run.append<double>("/history/energy", std::array{10 * t, 5 * t * t, -t, 12 * t, 0.1 * t, 1e-9 * std::sin(100 * t)});
    const Vec3 a = seat(t);
    run.append<double>("/history/sensor/seat", std::array{a.x(), a.y(), a.z()});
    run.append<double>("/history/joint/trunnion",
                       std::array{4e4 * std::sin(40 * t), 200.0 / 3, -1e3 * t, 12.5, 900 * std::cos(20 * t), 0.0});
    run.append<double>("/history/probe/muzzle", std::array{3 + t, 0., 0.6, 1., 0., 0., 0., 0., -9.81});
  }
  const double end = histories.h * (histories.rows - 1);
  const double most = front(mesh);
  for (int k = 0; k <= steps; ++k) {
    const std::string group = "/field/" + std::string(6 - std::to_string(k).size(), '0') + std::to_string(k);
    const double t = end * k / steps;
    std::vector<double> u, v, a, von_mises;
    for (std::int64_t n = 0; n < mesh.n_nodes(); ++n) {
      const Vec3& X = mesh.X[static_cast<size_t>(n)];
      const double bend = X.x() > 0.8 ? 0.04 * (X.x() - 0.8) * (X.x() - 0.8) * std::sin(3.0 * k / steps) : 0;
      u.insert(u.end(), {-0.05 * k / steps, 0, bend});
      v.insert(v.end(), {-0.5, 0, 20 * bend});
      a.insert(a.end(), {20 + 10 * X.z(), 0, 3000 * bend});
      von_mises.push_back(stressed[static_cast<size_t>(n)] ? stress(X, most, double(k) / steps) : 0);
    }
    const auto rows = mesh.n_nodes();
    run.write<double>(group + "/displacement", u, {rows, 3}, "m");
    run.write<double>(group + "/velocity", v, {rows, 3}, "m/s");
    run.write<double>(group + "/acceleration", a, {rows, 3}, "m/s^2");
    run.write<double>(group + "/von_mises", von_mises, {rows}, "Pa");
    run.write<double>(group + "/cell_von_mises", std::vector<double>(static_cast<size_t>(mesh.n_cells()), 1e6 * k), {mesh.n_cells()}, "Pa");
    run.set(group, "t", t);
  }
  if (complete) run.set("/", "complete", std::int64_t{1});
  run.flush();
  return path;
}

}  // namespace hilo::sample
