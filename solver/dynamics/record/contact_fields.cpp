// SPDX-License-Identifier: GPL-3.0-or-later
// Contact pressure of nodes: of each facet that is pressed a plane through the pressures of its points, by
// least squares; where facets meet, their mean.
#include <Eigen/QR>

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
    std::vector<std::vector<double>> send(system_.comm->size);  // row, area times pressure, area
    contacts->each_facet(at.q, [&](const Touching::Pressed& facet) {
      if (facet.pressure.maxCoeff() <= 0) return;  // around a corner, or beyond the border
      const Eigen::VectorXd pressure = of_nodes(facet);
      const double area = facet.area.sum();
      for (Eigen::Index a = 0; a < pressure.size(); ++a) {
        const std::int64_t row = node_row_[facet.nodes[static_cast<size_t>(a)]];
        if (row < 0) continue;
        auto& list = send[rows.rank_of(row)];
        list.insert(list.end(), {static_cast<double>(row), area * std::max(pressure[a], 0.), area});
      }
    });
    const auto n = static_cast<size_t>(rows.count());
    std::vector<double> pressure(n, 0.0), area(n, 0.0);
    for (const auto& list : system_.comm->exchange(send))
      for (size_t k = 0; k < list.size(); k += 3) {
        const auto i = static_cast<size_t>(static_cast<std::int64_t>(list[k]) - rows.first());
        pressure[i] += list[k + 1], area[i] += list[k + 2];
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
