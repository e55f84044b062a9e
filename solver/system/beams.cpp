// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/beams.hpp"

#include <fmt/format.h>

#include <cmath>

#include "system/collocation.hpp"
#include "system/connector_clique.hpp"

namespace hilo {
namespace {

using Rows = Eigen::Matrix<double, 8, 3>;  // a row for each of the points of M

/// Centre and directors of the bodies at both ends.
Rows rows_of(const Config& q, const Connector& c) {
  Rows out;
  out << q.c[c.end[0].body].transpose(), q.R[c.end[0].body].transpose(), q.c[c.end[1].body].transpose(), q.R[c.end[1].body].transpose();
  return out;
}
Vec3 row(const Rows& rows, int i) { return rows.row(i).transpose(); }

/// Rows of an acceleration that is the same everywhere.
Rows everywhere(const Vec3& g) {
  Rows out = Rows::Zero();
  out.row(0) = out.row(4) = g.transpose();
  return out;
}

/// Shares of c, d1, d2, d3 of both ends in points of the axis of an element of a section by itself: use(t, shares, ds).
template <class Use>
void each_share(const BeamSection& s, double L, const Use& use) {
  constexpr double x[] = {0.8611363115940526, 0.3399810435848563}, w[] = {0.3478548451374538, 0.6521451548625461};  // Gauss, 4 points
  const double phi = 12 / (L * L) * std::max(s.C(3, 3) / s.C(1, 1), s.C(4, 4) / s.C(0, 0));
  for (int k = 0; k < 4; ++k) {
    const double t = (1 + (k % 2 ? -1 : 1) * x[k / 2]) / 2, g = (2 * t * t * t - 3 * t * t + t) / (1 + phi), bow = (t - t * t) / 2;
    Eigen::Matrix<double, 8, 1> u = Eigen::Matrix<double, 8, 1>::Zero();
    u[0] = 1 - t + g, u[4] = t - g, u[3] = L * (g / 2 + bow), u[7] = L * (g / 2 - bow);
    use(t, u, w[k / 2] * L / 2);
  }
}

/// Linked mass of an element of a section by itself, on c, d1, d2, d3 of both ends.
BeamCell::Mass linked_mass(const BeamSection& s, double L) {
  BeamCell::Mass M = BeamCell::Mass::Zero();
  each_share(s, L, [&](double, const Eigen::Matrix<double, 8, 1>& u, double ds) { M += ds * s.mass * u * u.transpose(); });
  for (const int a : {0, 4})
    for (const int b : {0, 4}) {
      const double share = L * (a == b ? 5.0 : 1.0) / 12;
      M(a + 1, b + 1) += s.J11 * share, M(a + 2, b + 2) += s.J22 * share;
      M(a + 1, b + 2) += s.J12 * share, M(a + 2, b + 1) += s.J12 * share;
    }
  return M;
}

/// int u (1 - t)^2 ds, int u t (1 - t) ds, int u t^2 ds of the shares u of an element of a section by itself.
std::array<Eigen::Matrix<double, 8, 1>, 3> line_shares(const BeamSection& s, double L) {
  std::array<Eigen::Matrix<double, 8, 1>, 3> out;
  for (auto& column : out) column.setZero();
  each_share(s, L, [&](double t, const Eigen::Matrix<double, 8, 1>& u, double ds) {
    out[0] += ds * (1 - t) * (1 - t) * u, out[1] += ds * t * (1 - t) * u, out[2] += ds * t * t * u;
  });
  return out;
}

/// Changes of strain over the steps before that dissipation recalls.
ArcLaw::Strain recalled(const BeamCell& cell, const Dissipation& d, const Config& from, double last, double before) {
  if (last == 0 && before == 0) return ArcLaw::Strain::Zero();
  const auto at = [&](const Config& q) { return ArcLaw::strain(cell.ends.values(q)); };
  const ArcLaw::Strain one = at(*d.one);
  return last * (at(from) - one) + before * (one - at(*d.two));
}

/// Elastic response at a stage with what dissipation takes, D by the measures at e1; rate forces, D by those at w1, and `before` by those
/// at w0.
void respond(const BeamCell& cell, const Stage& s, Response& elastic, Response& viscous, Response& before) {
  const auto e0 = cell.ends.values(*s.e0), e1 = cell.ends.values(*s.e1);
  if (!s.rates_alone) {
    if (s.step) {
      elastic_along(*cell.law, MeasurePath(cell.ends, *s.step), *s.step, s.member, elastic);
    } else if (s.conserving()) {
      cell.law->elastic(e0, e1, elastic);
    } else {
      SpringLaw::Values mean{};
      for (int m = 0; m < ArcLaw::n_measures; ++m) mean[m] = (1 - s.weight) * e0[m] + s.weight * e1[m];
      cell.law->elastic(mean, mean, elastic);
      for (auto& of : elastic.D)  // so far the derivative by the second argument alone
        for (double& d : of) d *= 2 * s.weight;
    }
    if (const Dissipation* d = s.dissipation)
      cell.law->resist(e0, e1, d->kappa, recalled(cell, *d, *s.e0, d->last(), d->before()), elastic);
  }
  if (s.h > 0) {
    const auto w0 = cell.ends.values(*s.w0), w1 = cell.ends.values(*s.w1);
    cell.law->viscous(w0, w1, {s.h}, viscous);
    if (s.slope0() != 0) cell.law->viscous(w1, w0, {-s.h}, before);
  }
}

/// Inertia, weight and drag on the points.
Rows forces_of_mass(const BeamCell& cell, const Stage& s, const Vec3& gravity) {
  Rows a = rows_of(*s.a, cell.ends) - everywhere(gravity * s.load_factor);
  if (s.v && cell.alpha > 0) a += cell.alpha * rows_of(*s.v, cell.ends);
  return cell.M * a;
}

}  // namespace

void Beams::add_cell(const SectionPlace& a, const SectionPlace& b, const BeamSection& section, double beta, double alpha) {
  const Config& q = points_.start;
  BeamCell cell;
  cell.ends.join({a.body, -1}, {b.body, -1}, q, b.at, b.frame);
  add_arc_measures(cell.ends, q, a.at, a.frame, b.at, b.frame);
  cell.law = std::make_unique<ArcLaw>(cell.ends.values(q), section.C, beta);
  cell.alpha = alpha, cell.size = section.size;
  BeamCell::Mass T = BeamCell::Mass::Zero();  // points of the sections from those of the bodies
  for (int k = 0; k < 2; ++k) {
    const SectionPlace& place = k == 0 ? a : b;
    const Mat3 to_body = q.R[place.body].transpose();
    T(4 * k, 4 * k) = 1;
    T.block<1, 3>(4 * k, 4 * k + 1) = (to_body * (place.at - q.c[place.body])).transpose();
    T.block<3, 3>(4 * k + 1, 4 * k + 1) = (to_body * place.frame).transpose();
  }
  cell.M = T.transpose() * linked_mass(section, cell.law->length()) * T;
  cell.sections = T;
  cell.line = line_shares(section, cell.law->length());
  cells.push_back(std::move(cell));
}

std::string Beams::count() const {
  if (cells.empty()) return "";
  return fmt::format("{} beams of {} cells{}", beams.size(), cells.size(),
                     lines.empty() ? "" : fmt::format(" under {} loads by length", lines.size()));
}

void Beams::number(Layout& layout) {
  clique_.clear();
  for (const BeamCell& cell : cells) clique_.push_back(layout.cliques.add(blocks_of_ends(points_, cell.ends)));
}

std::vector<Beams::LineForces> Beams::line_forces(const Stage& s) const {
  if (lines.empty()) return {};
  std::vector<LineForces> out(cells.size());
  for (const LineLoad& l : lines) {
    const double factor = l.load.factor(s.t0, s.t1, s.load_factor);
    for (size_t k = 0; k < l.at.size(); ++k) {
      const BeamCell& cell = cells[l.first + k];
      const auto& [a, b] = l.at[k];
      if (!l.load.follower) {
        out[l.first + k].F += factor * cell.sections.transpose() *
                              ((cell.line[0] + cell.line[1]) * a.transpose() + (cell.line[1] + cell.line[2]) * b.transpose());
        continue;
      }
      BeamCell::Mass of_directors = BeamCell::Mass::Zero();  // (p_A (1 - t) + p_B t) along directors that are linear between the ends
      for (int i = 0; i < 3; ++i) {
        of_directors.col(1 + i) = a[i] * cell.line[0] + b[i] * cell.line[1];
        of_directors.col(5 + i) = a[i] * cell.line[1] + b[i] * cell.line[2];
      }
      out[l.first + k].K += factor * cell.sections.transpose() * of_directors * cell.sections;
    }
  }
  return out;
}

void Beams::evaluate(Pass& p) const {
  thread_local ConnectorGradient left, right;
  const Stage& s = p.s;
  const std::vector<LineForces> line = p.loads ? line_forces(s) : std::vector<LineForces>{};
  for (size_t k = 0; k < cells.size(); ++k) {
    if (!points_.counts(static_cast<int>(k))) continue;
    const BeamCell& cell = cells[k];
    const Connector& c = cell.ends;
    gradient(c, *s.left, left);
    Response elastic, viscous, before;
    respond(cell, s, elastic, viscous, before);
    double force[max_measures];
    for (int m = 0; m < max_measures; ++m) force[m] = elastic.s[m] + viscous.s[m];
    add_force(p, c, left, force);

    Rows F = forces_of_mass(cell, s, points_.gravity);
    const Rows at_left = rows_of(*s.left, c);
    if (!line.empty()) F -= line[k].F + line[k].K * at_left;
    for (int e = 0; e < 2; ++e) {
      Vec6& body = p.body[c.end[e].body];
      body.head<3>() += row(F, 4 * e);
      for (int i = 4 * e + 1; i < 4 * e + 4; ++i) body.tail<3>() += row(at_left, i).cross(row(F, i));
      p.scale(row(F, 4 * e).norm());
    }
    if (!p.K) continue;
    ConnectorMatrix K = ConnectorMatrix::Zero(12, 12);
    const auto add_slope = [&](const Config& at, double f, const Response& response) {
      if (f == 0) return;
      gradient(c, at, *s.end, right);
      const Eigen::Matrix<double, 7, 7> D =
          Eigen::Map<const Eigen::Matrix<double, max_measures, max_measures, Eigen::RowMajor>>(response.D.front().data())
              .topLeftCorner<7, 7>();
      K += f * left.G.topLeftCorner<7, 12>().transpose() * D * right.G.topLeftCorner<7, 12>();
    };
    if (s.h > 0) add_slope(*s.w0, s.slope0(), before), add_slope(*s.w1, s.slope1(), viscous);
    add_slope(*s.e1, s.chain, elastic);
    add_geometric(c, left, right, force, s.slope, K);

    BeamCell::Mass slope = (s.mass_slope + (s.v ? cell.alpha * s.alpha_slope : 0)) * cell.M;
    if (!line.empty()) slope -= s.slope * line[k].K;
    const Rows at_end = rows_of(*s.end, c);
    for (int a = 0; a < 8; ++a) {
      const bool turns_a = a % 4 > 0;
      const Mat3 lever = turns_a ? skew(row(at_left, a)) : Mat3::Identity();
      const int row_a = 6 * (a / 4) + (turns_a ? 3 : 0);
      for (int b = 0; b < 8; ++b) {
        const bool turns_b = b % 4 > 0;
        const int column = 6 * (b / 4) + (turns_b ? 3 : 0);
        if (slope(a, b) == 0) continue;
        if (turns_b)
          K.block<3, 3>(row_a, column) -= slope(a, b) * lever * skew(row(at_end, b));
        else
          K.block<3, 3>(row_a, column) += slope(a, b) * lever;
      }
      if (turns_a) K.block<3, 3>(row_a, row_a) += s.slope * skew(row(F, a)) * skew(row(at_end, a));
    }
    add_clique(p, points_, c, clique_[k], K, {});
  }
}

void Beams::add_energy(const Config& q, const Config& v, Energy& sum) const {
  for (size_t k = 0; k < cells.size(); ++k) {
    if (!points_.counts(static_cast<int>(k))) continue;
    const BeamCell& cell = cells[k];
    const auto e = cell.ends.values(q);
    Response r;
    cell.law->elastic(e, e, r);
    sum.elastic += r.energy;
    const Rows x = rows_of(q, cell.ends), V = rows_of(v, cell.ends), momenta = cell.M * V;
    sum.kinetic += momenta.cwiseProduct(V).sum() / 2;
    sum.momentum += row(momenta, 0) + row(momenta, 4);
    for (int i = 0; i < 8; ++i) sum.angular += row(x, i).cross(row(momenta, i));
    sum.gravity -= (cell.M * everywhere(points_.gravity)).cwiseProduct(x).sum();
  }
}

void Beams::add_work(const Moment& m, Work& sum) const {
  const Stage& s = m.s;
  const std::vector<LineForces> line = line_forces(s);
  for (size_t k = 0; k < cells.size(); ++k) {
    if (!points_.counts(static_cast<int>(k))) continue;
    const BeamCell& cell = cells[k];
    if (!line.empty())
      sum.external += (line[k].F + line[k].K * rows_of(*s.left, cell.ends))
                          .cwiseProduct(rows_of(*s.end, cell.ends) - rows_of(s.from(), cell.ends))
                          .sum();
    sum.add(s, [&](const Config& from, const Config& to, double last, double before) {
      Response taken;
      cell.law->resist(cell.ends.values(from), cell.ends.values(to), 1, recalled(cell, *s.dissipation, from, last, before), taken);
      return taken.dissipated;
    });
    if (s.h > 0) {
      Response rate;
      cell.law->viscous(cell.ends.values(*s.w0), cell.ends.values(*s.w1), {s.h}, rate);
      sum.dissipated += s.share() * rate.dissipated;
    }
    if (s.v && cell.alpha > 0)
      sum.dissipated +=
          cell.alpha * (cell.M * rows_of(*s.v, cell.ends)).cwiseProduct(rows_of(*s.end, cell.ends) - rows_of(s.from(), cell.ends)).sum();
  }
}

double Beams::inertia(int body, const Config& v, const Vec3& w, const Mat3& W) const {
  double sum = 0;
  for (const BeamCell& cell : cells)
    for (int e = 0; e < 2; ++e)
      if (cell.ends.end[e].body == body) {
        const Rows F = cell.M * rows_of(v, cell.ends);
        sum += row(F, 4 * e).dot(w);
        for (int i = 0; i < 3; ++i) sum += row(F, 4 * e + 1 + i).dot(W.col(i));
      }
  return sum;
}

std::string Beams::fault(const Config& q) const {
  for (const Beam& beam : beams)
    for (int k = 0; k < beam.n_cells; ++k)
      if (const double turn = ArcLaw::turn(cells[beam.first + k].ends.values(q)); !(turn < ArcLaw::largest_turn))
        return fmt::format("beam \"{}\" turns by {:.3g} rad in its cell {}, more than {}: give it more cells", beam.name, turn, k,
                           ArcLaw::largest_turn);
  return "";
}

std::vector<Output> Beams::outputs() const {
  std::vector<Output> out;
  for (const Beam& beam : beams) out.push_back({.group = "beam", .name = beam.name, .n_mid = 12 * beam.n_cells});
  return out;
}

/// Forces and moments that a cell exerts on its sections, weight, inertia and loads of its own with them: where nothing is loaded they go
/// on from cell to cell.
void Beams::observe(const Sight& sight) {
  if (!sight.step) return;
  ConnectorGradient g;
  const Stage& s = sight.step->s;
  std::vector<double>& out = sight.mid;
  const std::vector<LineForces> line = line_forces(s);
  for (size_t k = 0; k < cells.size(); ++k) {
    const BeamCell& cell = cells[k];
    gradient(cell.ends, *s.left, g);
    Response elastic, viscous, before;
    respond(cell, s, elastic, viscous, before);
    Rows F = forces_of_mass(cell, s, points_.gravity);
    const Rows at = rows_of(*s.left, cell.ends);
    if (!line.empty()) F -= line[k].F + line[k].K * at;
    for (int end = 0; end < 2; ++end) {
      Vec6 f = Vec6::Zero();
      for (int m = 0; m < ArcLaw::n_measures; ++m) f += (elastic.s[m] + viscous.s[m]) * g.G.block<1, 6>(m, 6 * end).transpose();
      f.head<3>() += row(F, 4 * end);
      for (int i = 4 * end + 1; i < 4 * end + 4; ++i) f.tail<3>() += row(at, i).cross(row(F, i));
      f.tail<3>() -= g.arm[end].cross(f.head<3>().eval());
      const double side = end == 0 ? -1 : 1;
      for (const bool moment : {false, true})
        for (int i = 1; i < 4; ++i) out.push_back(side * g.y[end + 2 * i].dot(moment ? f.tail<3>() : f.head<3>()));  // d1, d2, d3
    }
  }
}

void Beams::tie(Ties& ties) const {
  for (const BeamCell& cell : cells)
    if (const int body = tie_ends(points_, cell.ends, ties); body >= 0) ties.exclude(body);
}

}  // namespace hilo
