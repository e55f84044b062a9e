// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/joint.hpp"

#include <algorithm>

#include "physics/rolling.hpp"

namespace hilo {

Joint::Joint() = default;
Joint::Joint(Joint&&) noexcept = default;
Joint& Joint::operator=(Joint&&) noexcept = default;
Joint::~Joint() = default;

int Joint::n_rows() const { return n_position_rows() + (velocity_rows ? velocity_rows->n_rows() : 0); }

void Joint::row_values(const std::array<double, max_measures>& e, double* g) const {
  const int n = n_position_rows();
  if (rows)
    rows->values(e, g);
  else
    std::copy(e.begin(), e.begin() + n, g);
  std::fill(g + n, g + n_rows(), 0.0);
}

bool JointKind::frees(Freedom f) const { return std::find(freedoms.begin(), freedoms.end(), f) != freedoms.end(); }

Joint make_joint(const JointPlace& place, const Config& q) {
  const JointKind& kind = joint_kinds().at(place.kind);
  Joint joint = kind.make(place, q);
  joint.kind = &kind;
  return joint;
}

}  // namespace hilo
