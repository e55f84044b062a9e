// SPDX-License-Identifier: GPL-3.0-or-later
// Contact pressure of nodes: of each facet that is pressed a plane through the pressures of its points, by least squares, the sum of those
// of all contacts that press it; where facets meet, their mean.
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <map>

#include "dynamics/record/fields.hpp"
#include "system/touching.hpp"

namespace hilo {
namespace {

class ContactFields final : public FieldSource {
 public:
  ContactFields(const System& system, const std::vector<std::int64_t>& node_row) : system_(system), node_row_(node_row) {}
  std::vector<Field> fields() const override { return {{.name = "contact_pressure", .label = "contact pressure [Pa]"}}; }

  void write(const Snapshot& at, FieldWriter& to) override {
    const Touching* contacts = touching(system_);
    if (!contacts || !contacts->has_facets()) return;
    const Slabs& rows = to.node_rows();
    std::vector<std::vector<double>> send(system_.comm->size);  // row, the facet by three other rows, area, pressure
    contacts->each_facet(at.q, [&](const Touching::Pressed& facet) {
      if (facet.pressure.maxCoeff() <= 0) return;  // around a corner, or beyond the border
      const Eigen::VectorXd pressure = of_nodes(facet);
      std::vector<std::int64_t> its;
      for (const int node : facet.nodes) its.push_back(node_row_[node]);
      std::array<std::int64_t, 3> key{};
      std::ranges::partial_sort_copy(its, key, std::greater());
      for (size_t a = 0; a < its.size(); ++a) {
        if (its[a] < 0) continue;
        auto& list = send[rows.rank_of(its[a])];
        for (const std::int64_t row : {its[a], key[0], key[1], key[2]}) list.push_back(static_cast<double>(row));
        list.insert(list.end(), {facet.area.sum(), pressure[static_cast<Eigen::Index>(a)]});
      }
    });
    struct Sum {
      double area = 0, pressure = 0;
    };
    std::map<std::array<double, 4>, Sum> of_facet;  // at a node
    for (const auto& list : system_.comm->exchange(send))
      for (size_t k = 0; k < list.size(); k += 6) {
        Sum& sum = of_facet[{list[k], list[k + 1], list[k + 2], list[k + 3]}];
        sum.area = list[k + 4], sum.pressure += list[k + 5];
      }
    const auto n = static_cast<size_t>(rows.count());
    std::vector<double> pressure(n, 0.0), area(n, 0.0);
    for (const auto& [key, sum] : of_facet) {
      const auto i = static_cast<size_t>(static_cast<std::int64_t>(key[0]) - rows.first());
      pressure[i] += sum.area * std::max(sum.pressure, 0.), area[i] += sum.area;
    }
    for (size_t i = 0; i < n; ++i)
      if (area[i] > 0) pressure[i] /= area[i];
    to.piece("contact_pressure", pressure);
  }

 private:
  /// Of a plane in the reference, exact for pressures that are linear there.
  Eigen::VectorXd of_nodes(const Touching::Pressed& facet) const {
    const auto n = static_cast<Eigen::Index>(facet.nodes.size());
    Eigen::MatrixX3d X(n, 3);
    for (Eigen::Index a = 0; a < n; ++a) X.row(a) = system_.X[facet.nodes[static_cast<size_t>(a)]].transpose();
    Eigen::MatrixX3d of_points = facet.share * X;
    const double area = facet.area.sum(), mean = facet.area.dot(facet.pressure) / area;
    const Eigen::RowVector3d middle = facet.area.transpose() * of_points / area;
    of_points.rowwise() -= middle, X.rowwise() -= middle;
    const Eigen::MatrixX3d weighted = facet.area.asDiagonal() * of_points;
    const Eigen::Vector3d slope = Eigen::Matrix3d(weighted.transpose() * of_points)
                                      .completeOrthogonalDecomposition()  // none out of its plane
                                      .solve(weighted.transpose() * (facet.pressure.array() - mean).matrix());
    return ((X * slope).array() + mean).matrix();
  }
  const System& system_;
  const std::vector<std::int64_t>& node_row_;
};

}  // namespace

std::unique_ptr<FieldSource> contact_fields(const System& system, const std::vector<std::int64_t>& node_row) {
  return std::make_unique<ContactFields>(system, node_row);
}

}  // namespace hilo
