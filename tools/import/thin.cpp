// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/thin.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "import/imported.hpp"
#include "model/facet_rule.hpp"

namespace hilo {

Mat3 second_of_section(const Vec3& along, const Vec3& v, double I1, double I2, double I12) {
  const Vec3 x = along.normalized(), z = x.cross(v).normalized(), y = z.cross(x);
  return I1 * y * y.transpose() + I2 * z * z.transpose() + I12 * (y * z.transpose() + z * y.transpose());
}

void add_thin_moments(Imported& in, double factor) {
  const Mesh& m = in.mesh;
  in.thin_regions.assign(in.thin.empty() ? 0 : m.region_name.size(), {});
  for (const auto& of : in.thin) {
    const std::int64_t cell = of.first;
    const ThinSection& section = of.second;
    ThinRegion& data = in.thin_regions[static_cast<size_t>(m.region[static_cast<size_t>(cell)])];
    const auto nodes = m.cell(cell);
    const auto add = [&](double V, const Vec3& first, const Mat3& S) {
      const double values[10] = {V, first[0], first[1], first[2], S(0, 0), S(1, 1), S(2, 2), S(1, 2), S(0, 2), S(0, 1)};
      for (size_t k = 0; k < 10; ++k) data.moments[k] += values[k];
    };
    if (info(m.shape[static_cast<size_t>(cell)]).dimension == 2) {
      data.thickness = section.thickness * factor;
      // thickness at the points of the rule: x of the same facet whose nodes have theirs for x
      const size_t corners = static_cast<size_t>(info(m.shape[static_cast<size_t>(cell)]).n_corners);
      Mesh alike;
      std::vector<std::int64_t> numbers(nodes.size());
      for (size_t k = 0; k < nodes.size(); ++k) {
        numbers[k] = static_cast<std::int64_t>(k);
        alike.X.emplace_back(section.thickness_at(k, corners) * factor, 0, 0);
      }
      alike.add_cell(static_cast<Shape>(m.shape[static_cast<size_t>(cell)]), numbers, 0, 0);
      std::vector<double> thickness;
      over_facet(alike, {0, 0}, [&](const Vec3& at, const Vec3&) { thickness.push_back(at.x()); });
      size_t point = 0;
      over_facet(m, {cell, 0}, [&](const Vec3& at, const Vec3& dA) {
        const double area = dA.norm(), t = thickness[point++];
        const Vec3 n = dA / area, x = at + section.offset * factor * n;
        add(t * area, t * area * x, area * (t * x * x.transpose() + t * t * t / 12 * n * n.transpose()));
      });
    } else {
      const double A = section.area * factor * factor;
      data.area = A;
      const Vec3 a = m.X[static_cast<size_t>(nodes[0])] + factor * section.start,
                 b = m.X[static_cast<size_t>(nodes[1])] + factor * section.end;
      const Vec3 c = (a + b) / 2, d = b - a;
      const double l = d.norm();
      add(A * l, A * l * c, A * l * (c * c.transpose() + d * d.transpose() / 12) + l * std::pow(factor, 4) * section.second);
    }
  }
}

}  // namespace hilo
