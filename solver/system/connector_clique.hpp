// SPDX-License-Identifier: GPL-3.0-or-later
// A connector among the unknowns: what joints and springs share within an evaluation.
#pragma once
#include "physics/connector.hpp"
#include "system/contribution.hpp"

namespace hilo {

/// Rows over the directions of a connector.
using DirectionRows = decltype(ConnectorGradient::G);

/// Blocks of the ends that are free, in the order of the clique; multipliers follow them there.
std::vector<int> blocks_of_ends(const Points& points, const Connector& c);
/// Whether this rank evaluates connector `index`.
bool is_owned(const Points& points, const Connector& c, size_t index);
/// `force` (conjugate to the measures) on the ends.
void add_force(Pass& p, const Connector& c, const ConnectorGradient& left, const double* force);

/// Multiplier rows in the clique of a connector.
struct CliqueRows {
  int blocks = 0;
  const DirectionRows *left = nullptr, *right = nullptr;  // gradients of the rows in the equations and in the increments
  const bool* is_on = nullptr;  // rows of the connector's own; null: those of another, whose columns alone are here
  int n = 0;                    // of is_on
};
/// The tangent of a connector, K over its directions, with the multiplier rows.
void add_clique(Pass& p, const Points& points, const Connector& c, int clique, const ConnectorMatrix& K, const CliqueRows& rows);
/// Force and moment f, inertial axes, in the frame that end a carries.
void append_in_frame(const Connector& c, const Vec6& f, const Config& q, std::vector<double>& out);
/// How a connector ties bodies together; one of the bodies it connects, or -1.
int tie_ends(const Points& points, const Connector& c, Ties& ties);

}  // namespace hilo
