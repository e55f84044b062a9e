#include "physics/connector.hpp"

#include <algorithm>

#include "physics/rolling.hpp"

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
      use(t.i, -t.coef * t.unit);
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
      return t.coef * t.unit.dot(y[t.j] - y[t.i]);
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

Connector::Connector() = default;
Connector::Connector(Connector&&) noexcept = default;
Connector& Connector::operator=(Connector&&) noexcept = default;
Connector::~Connector() = default;

int Connector::n_rows() const { return n_position_rows() + (velocity_rows ? velocity_rows->n_rows() : 0); }

void Connector::row_values(const std::array<double, max_measures>& e, double* g) const {
  const int n = n_position_rows();
  if (rows)
    rows->values(e, g);
  else
    std::copy(e.begin(), e.begin() + n, g);
  std::fill(g + n, g + n_rows(), 0.0);
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
      derivatives(t, g.y, [&](int e, const Vec3& d) { g.dy[m][e] += d; });
    }
    for (size_t e = 0; e < c.entities.size(); ++e) {
      const int base = 6 * c.entities[e].end;
      const Vec3& d = g.dy[m][e];
      if (c.entities[e].point) g.G.block<1, 3>(m, base) += d.transpose();
      g.G.block<1, 3>(m, base + 3) += g.arm[e].cross(d).transpose();
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
