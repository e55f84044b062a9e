// SPDX-License-Identifier: GPL-3.0-or-later
// What cells cost, and a partition made on the spot: recursive coordinate bisection, on cells spread over the ranks.
#pragma once
#include <span>
#include <vector>

#include "base/comm.hpp"
#include "base/math.hpp"
#include "base/shape.hpp"

namespace hilo {

/// Work of a flexible cell in a Newton iteration by shape (a column of mesh_shape.cpp), hundredths of a linear hexahedron's: tangent,
/// force, insertion and its share of a factorisation and a solve, as `costs-bench` (tests/bench/costs.cpp) measures them.  The law of the
/// material changes it by less than that bench can tell: unknowns are what costs.
int work_of_cell(Shape shape);

/// Points to divide: this rank's share of them.
struct Cloud {
  std::vector<Vec3> x;       // centres of the cells
  std::vector<double> work;  // weight of each
  std::vector<int> kind;     // 0, 1, ...: each kind is divided for itself, so all of them are balanced
};

/// Part (0 .. n_parts - 1) of each point of this rank.  Cuts each box across its longest side at the weighted median.
std::vector<int> bisect(const Cloud& cloud, int n_parts, const Comm& comm);

}  // namespace hilo
