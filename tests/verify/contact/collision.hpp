// SPDX-License-Identifier: GPL-3.0-or-later
// How a collision is judged, and what makes many of them.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "verify/block_mesh.hpp"
#include "verify/verify.hpp"

namespace hilo::test {

/// All meshes as one; sets with the name of the region before theirs.
template <class... More>
Mesh together(const Mesh& a, const More&... more) {
  Mesh out;
  for (const Mesh* m : {&a, &more...}) {
    const auto node = out.n_nodes(), cell = out.n_cells();
    const auto region = static_cast<std::int32_t>(out.region_name.size());
    for (const Vec3& x : m->X) out.X.push_back(x), out.node_id.push_back(out.n_nodes());
    for (std::int64_t c = 0; c < m->n_cells(); ++c) {
      std::vector<std::int64_t> nodes;
      for (const std::int64_t i : m->cell(c)) nodes.push_back(node + i);
      out.add_cell(static_cast<Shape>(m->shape[c]), nodes, region, out.n_cells() + 1);
    }
    out.region_name.push_back(m->region_name[0]), out.region_data.push_back(m->region_data[0]);
    for (const auto& [name, facets] : m->facet_sets)
      for (const Facet& f : facets) out.facet_sets[m->region_name[0] + name].push_back({cell + f.cell, f.facet});
  }
  return out;
}

struct Worst {
  double energy = 0, momentum = 0, angular = 0, given_back = 0, top = 0;
  long met = 0;
};

/// Largest changes in a step: of the balance of energy over the largest kinetic energy, of the momenta over the largest part of each that a
/// body has, `momentum` and `angular`; how much friction gave back.
inline Worst worst_of(const Results& r, double momentum, double angular) {
  Worst out;
  const auto e = r.history("energy"), p = r.history("momentum"), c = r.history("contact/c");
  out.top = e.col(0).maxCoeff();
  for (Eigen::Index k = 1; k < e.rows(); ++k) {
    out.energy = std::max(out.energy, std::abs(e(k, 5) - e(k - 1, 5)) / out.top);
    out.momentum = std::max(out.momentum, (p.row(k) - p.row(k - 1)).head<3>().norm() / momentum);
    out.angular = std::max(out.angular, (p.row(k) - p.row(k - 1)).tail<3>().norm() / angular);
    out.given_back = std::max(out.given_back, (c(k - 1, 6) - c(k, 6)) / out.top);
    out.met += c(k, 3) > 0;
  }
  return out;
}

inline const std::vector<double> shares{0.02, 0.1, 0.4, 1, 2};  // of the time of a contact

/// Numbers between 0 and 1 that look random.
class Dice {
 public:
  explicit Dice(int seed) : at_(1000 * seed) {}
  double operator()() { return (scatter(++at_) + 1) / 2; }
  double operator()(double low, double high) { return low + (high - low) * (*this)(); }
  std::string vector(double size) { return fmt::format("[{}, {}, {}]", (*this)(-size, size), (*this)(-size, size), (*this)(-size, size)); }

 private:
  int at_;
};

}  // namespace hilo::test
