// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/connector.hpp"

#include <utility>

namespace hilo {
namespace {

/// Calls use(entity, dy) for every entity a term depends on.
template <class Use>
void derivatives(const Term& t, const Vec3* y, Use use) {
  switch (t.kind) {
    case Term::dot:
      use(t.i, t.coef * y[t.j]);
      use(t.j, t.coef * y[t.i]);
      break;
    case Term::slide:
      use(t.i, t.coef * (y[t.k] - y[t.j]));
      use(t.j, -t.coef * y[t.i]);
      use(t.k, t.coef * y[t.i]);
      break;
    case Term::distance2:
      use(t.i, -2 * t.coef * (y[t.j] - y[t.i]));
      use(t.j, 2 * t.coef * (y[t.j] - y[t.i]));
      break;
    case Term::coordinate:
      if (t.i >= 0) use(t.i, -t.coef * t.unit);  // else it is taken from the origin
      use(t.j, t.coef * t.unit);
      break;
  }
}

/// Calls use(e, f, h) for every pair whose second derivative is h I.
template <class Use>
void second_derivatives(const Term& t, Use use) {
  switch (t.kind) {
    case Term::dot:
      use(t.i, t.j, t.coef), use(t.j, t.i, t.coef);
      break;
    case Term::slide:
      use(t.i, t.k, t.coef), use(t.k, t.i, t.coef);
      use(t.i, t.j, -t.coef), use(t.j, t.i, -t.coef);
      break;
    case Term::distance2:
      use(t.i, t.i, 2 * t.coef), use(t.j, t.j, 2 * t.coef);
      use(t.i, t.j, -2 * t.coef), use(t.j, t.i, -2 * t.coef);
      break;
    case Term::coordinate:
      break;
  }
}

double term_value(const Term& t, const Vec3* y) {
  switch (t.kind) {
    case Term::dot:
      return t.coef * y[t.i].dot(y[t.j]);
    case Term::slide:
      return t.coef * y[t.i].dot(y[t.k] - y[t.j]);
    case Term::distance2:
      return t.coef * (y[t.j] - y[t.i]).squaredNorm();
    case Term::coordinate:
      return t.coef * t.unit.dot(t.i >= 0 ? Vec3(y[t.j] - y[t.i]) : y[t.j]);
  }
  return 0;
}

void place(const Connector& c, const Config& q, Vec3* y, Vec3* arm) {
  for (size_t e = 0; e < c.entities.size(); ++e) {
    const auto& [end, r, point] = c.entities[e];
    const Carrier& carrier = c.end[end];
    if (carrier.body < 0) {
      y[e] = q.x[carrier.node], arm[e].setZero();
    } else {
      arm[e].noalias() = q.R[carrier.body] * r;
      y[e] = point ? Vec3(q.c[carrier.body] + arm[e]) : arm[e];
    }
  }
}

}  // namespace

double Connector::value(int measure, const Config& q) const {
  Vec3 y[max_entities], arm[max_entities];
  place(*this, q, y, arm);
  double e = -measures[measure].offset;
  for (const Term& t : measures[measure].terms) e += term_value(t, y);
  return e;
}

std::array<double, max_measures> Connector::values(const Config& q) const {
  Vec3 y[max_entities], arm[max_entities];
  place(*this, q, y, arm);
  std::array<double, max_measures> e{};
  for (size_t m = 0; m < measures.size(); ++m) {
    e[m] = -measures[m].offset;
    for (const Term& t : measures[m].terms) e[m] += term_value(t, y);
  }
  return e;
}

int Connector::add_point(int of_end, const Config& q, const Vec3& at) {
  const int b = end[of_end].body;
  entities.push_back({of_end, b < 0 ? Vec3::Zero() : Vec3(q.R[b].transpose() * (at - q.c[b])), true});
  return static_cast<int>(entities.size()) - 1;
}

int Connector::add_direction(int of_end, const Config& q, const Vec3& d) {
  entities.push_back({of_end, q.R[end[of_end].body].transpose() * d, false});
  return static_cast<int>(entities.size()) - 1;
}

int Connector::add_measure(std::vector<Term> terms) {
  measures.push_back({std::move(terms), 0});
  return static_cast<int>(measures.size()) - 1;
}

int Connector::add_zero_measure(std::vector<Term> terms, const Config& q) {
  const int m = add_measure(std::move(terms));
  measures[m].offset = value(m, q);
  return m;
}

int Connector::add_rotation(const std::array<int, 3>& u, const std::array<int, 3>& v) {
  const int first = static_cast<int>(measures.size());
  for (const int column : v)
    for (const int row : u) add_measure({{Term::dot, row, column}});
  return first;
}

void Connector::join(const Carrier& a, const Carrier& b, const Config& q, const Vec3& at_b, const Mat3& frame) {
  end[0] = a, end[1] = b;
  if (a.body >= 0) frame_a = q.R[a.body].transpose() * frame;
  if (b.body >= 0) point_b = q.R[b.body].transpose() * (at_b - q.c[b.body]);
}

void gradient(const Connector& c, const Config& q, const Config& turned, ConnectorGradient& g) {
  place(c, q, g.y, g.arm);
  if (&turned != &q) {
    Vec3 y[max_entities];
    place(c, turned, y, g.arm);
  }
  g.G.topRows(c.measures.size()).setZero();
  for (size_t m = 0; m < c.measures.size(); ++m) {
    g.e[m] = -c.measures[m].offset;
    for (size_t e = 0; e < c.entities.size(); ++e) g.dy[m][e].setZero();
    for (const Term& t : c.measures[m].terms) {
      g.e[m] += term_value(t, g.y);
      derivatives(t, g.y, [&](int e, const Vec3& d) {
        const int base = 6 * c.entities[e].end;
        g.dy[m][e] += d;
        if (c.entities[e].point) g.G.block<1, 3>(m, base) += d.transpose();
        g.G.block<1, 3>(m, base + 3) += g.arm[e].cross(d).transpose();
      });
    }
  }
}

void add_geometric(const Connector& c, const ConnectorGradient& left, const ConnectorGradient& right, const double* s, double slope,
                   ConnectorMatrix& K) {
  for (size_t m = 0; m < c.measures.size(); ++m) {
    const double f = slope * s[m];
    if (f == 0) continue;
    for (const Term& t : c.measures[m].terms)
      second_derivatives(t, [&](int e, int g, double h) {
        const int row = 6 * c.entities[e].end, col = 6 * c.entities[g].end;
        const Mat3 Se = skew(left.arm[e]), Sg = skew(right.arm[g]);
        const double fh = f * h;
        if (c.entities[e].point && c.entities[g].point) K.block<3, 3>(row, col).diagonal().array() += fh;
        if (c.entities[e].point) K.block<3, 3>(row, col + 3) -= fh * Sg;
        if (c.entities[g].point) K.block<3, 3>(row + 3, col) += fh * Se;
        K.block<3, 3>(row + 3, col + 3) -= fh * Se * Sg;
      });
    for (size_t e = 0; e < c.entities.size(); ++e) {
      if (left.dy[m][e] == Vec3::Zero()) continue;  // of most measures
      const int base = 6 * c.entities[e].end + 3;
      K.block<3, 3>(base, base) += f * skew(left.dy[m][e]) * skew(right.arm[e]);
    }
  }
}

Vec6 force_on_b(const Connector& c, const ConnectorGradient& left, const double* s, const Config& q) {
  Vec6 f = Vec6::Zero();
  for (size_t m = 0; m < c.measures.size(); ++m) f -= s[m] * left.G.block<1, 6>(m, 6).transpose();
  const int b = c.end[1].body;
  if (b >= 0) f.tail<3>() -= (q.R[b] * c.point_b).cross(f.head<3>());
  return f;
}

}  // namespace hilo
