// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/connector_clique.hpp"

#include <algorithm>

namespace hilo {
namespace {

/// Unknown blocks of the ends within a connector's clique: how many, and the first direction each of them stands for.
struct Ends {
  int n = 0;
  int row[2 * max_ends];  // in clique order
};

Ends ends_of(const Connector& c, const Points& points) {
  Ends e;
  for (int k = 0; k < c.n_ends; ++k) {
    const Carrier& carrier = c.end[k];
    if (carrier.body >= 0) {
      if (points.body_block[carrier.body] < 0) continue;
      for (int i = 0; i < 2; ++i) e.row[e.n] = 6 * k + 3 * i, ++e.n;
    } else if (points.node_block[carrier.node] >= 0) {
      e.row[e.n] = 6 * k, ++e.n;
    }
  }
  return e;
}

}  // namespace

std::vector<int> blocks_of_ends(const Points& points, const Connector& c) {
  std::vector<int> list;
  for (const Carrier& end : c.ends()) {
    if (end.body >= 0 && points.body_block[end.body] >= 0)
      list.push_back(points.body_block[end.body]), list.push_back(points.body_block[end.body] + 1);
    if (end.body < 0 && end.node >= 0) list.push_back(points.node_block[end.node]);
  }
  return list;
}

bool is_owned(const Points& points, const Connector& c, size_t index) {
  for (const Carrier& end : c.ends())
    if (end.body < 0) return end.node >= 0 && points.node_owned[end.node] != 0;
  return points.counts(static_cast<int>(index));
}

void add_force(Pass& p, const Connector& c, const ConnectorGradient& left, const double* force) {
  for (int k = 0; k < c.n_ends; ++k) {
    Vec6 f = Vec6::Zero();
    for (size_t m = 0; m < c.measures.size(); ++m) f += force[m] * left.G.block<1, 6>(m, 6 * k).transpose();
    if (c.end[k].body >= 0)
      p.body[c.end[k].body] += f;
    else
      p.node[c.end[k].node] += f.head<3>();
    p.scale(f.head<3>().norm());
  }
}

void add_clique(Pass& p, const Points& points, const Connector& c, int clique, const ConnectorMatrix& K, const CliqueRows& rows) {
  const Ends e = ends_of(c, points);
  const int m = e.n + rows.blocks, width = 3 * m;
  constexpr int most = 3 * (2 * max_ends + (max_rows + 2) / 3);
  double dense[most * most];
  std::fill(dense, dense + width * width, 0.0);
  for (int i = 0; i < e.n; ++i)
    for (int j = 0; j < e.n; ++j)
      for (int r = 0; r < 3; ++r)
        for (int q = 0; q < 3; ++q) dense[(3 * i + r) * width + 3 * j + q] = K(e.row[i] + r, e.row[j] + q);
  for (int row = 0; row < 3 * rows.blocks; ++row) {
    if (rows.is_on && (row >= rows.n || !rows.is_on[row])) {
      dense[(3 * e.n + row) * width + 3 * e.n + row] = p.sigma;
      continue;
    }
    for (int i = 0; i < e.n; ++i)
      for (int r = 0; r < 3; ++r) {
        dense[(3 * i + r) * width + 3 * e.n + row] = p.sigma * (*rows.left)(row, e.row[i] + r);
        dense[(3 * e.n + row) * width + 3 * i + r] = p.sigma * (*rows.right)(row, e.row[i] + r);
      }
  }
  for (int i = 0; i < e.n; ++i) {  // prescribed components of a node that carries an end
    const Carrier& carrier = c.end[e.row[i] / 6];
    for (int r = 0; r < 3 && carrier.body < 0; ++r)
      if (points.fixed[carrier.node][r])
        for (int j = 0; j < width; ++j) dense[(3 * i + r) * width + j] = dense[j * width + 3 * i + r] = 0;
  }
  p.K->add(clique, dense);
}

void append_in_frame(const Connector& c, const Vec6& f, const Config& q, std::vector<double>& out) {
  const Mat3 frame = c.end[0].body >= 0 ? Mat3(q.R[c.end[0].body] * c.frame_a) : Mat3::Identity();
  const Vec3 force = frame.transpose() * f.head<3>(), moment = frame.transpose() * f.tail<3>();
  out.insert(out.end(), force.data(), force.data() + 3);
  out.insert(out.end(), moment.data(), moment.data() + 3);
}

/// What holds on to a node hangs on something flexible.  A body that moves by a law is tied to the rest by Motions.
int tie_ends(const Points& points, const Connector& c, Ties& ties) {
  int first = -1;
  const auto free = [&](const Carrier& end) { return end.body >= 0 && points.body_block[end.body] >= 0; };
  for (const Carrier& end : c.ends())
    if (free(end)) {
      if (first < 0) first = end.body;
      ties.connect(end.body, first);
    }
  for (const Carrier& end : c.ends())
    if (first >= 0 && ((end.body < 0 && end.node >= 0) || (end.body > 0 && !free(end) && points.bodies[end.body].moving)))
      ties.exclude(first);
  return first;
}

}  // namespace hilo
