// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/build/mortar.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "system/facet.hpp"

namespace hilo {
namespace {

using Vec2 = Eigen::Vector2d;
using Polygon = std::vector<Vec2>;

constexpr double share_tied = 1e-3;  // of what a node's own shape function covers; below it the node has no row
constexpr double least_dual = 0.05;  // share of a facet that must be covered for a dual basis
constexpr double facing = -0.5;      // cosine between outward normals of facets that meet

int corners(int n) { return n == 3 || n == 6 ? 3 : 4; }

struct Rule {
  std::vector<double> x, w;  // on [0, 1]
};

/// Gauss points, roots of Legendre's polynomial by Newton's method.
Rule gauss(int n) {
  Rule rule;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int it = 0; it < 50; ++it) {
      double p = 1, before = 0;
      for (int k = 1; k <= n; ++k) {
        const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
        before = p, p = next;
      }
      slope = n * (x * p - before) / (x * x - 1);
      const double step = p / slope;
      x -= step;
      if (std::abs(step) < 1e-16) break;
    }
    rule.x.push_back((1 - x) / 2), rule.w.push_back(1 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

/// A facet's nodes on a plane.
struct Projected {
  int n;
  Vec2 p[8];
  /// Where it is over a point of the plane.
  FacetShape at(const Vec2& x) const {
    double r = corners(n) == 3 ? 1. / 3 : 0, s = r;
    for (int it = 0; it < 30; ++it) {
      const FacetShape shape = facet_shape(n, r, s);
      Vec2 gap = -x;
      Eigen::Matrix2d J = Eigen::Matrix2d::Zero();
      for (int a = 0; a < n; ++a) gap += shape.N[a] * p[a], J.col(0) += shape.dr[a] * p[a], J.col(1) += shape.ds[a] * p[a];
      const Vec2 step = J.inverse() * gap;
      if (!step.allFinite()) break;
      r -= step[0], s -= step[1];
      if (step.squaredNorm() < 1e-30) break;
    }
    return facet_shape(n, r, s);
  }
  Polygon polygon() const {
    Polygon out(p, p + corners(n));
    double area = 0;
    for (size_t i = 0; i < out.size(); ++i) {
      const Vec2 &a = out[i], &b = out[(i + 1) % out.size()];
      area += a[0] * b[1] - a[1] * b[0];
    }
    if (area < 0) std::ranges::reverse(out);
    return out;
  }
};

double area_of(const Polygon& p) {
  double twice = 0;
  for (size_t i = 1; i + 1 < p.size(); ++i) {
    const Vec2 a = p[i] - p[0], b = p[i + 1] - p[0];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return twice / 2;
}

/// What a convex polygon has inside another, both counter-clockwise (Sutherland and Hodgman).
Polygon clip(Polygon out, const Polygon& by) {
  for (size_t e = 0; e < by.size() && !out.empty(); ++e) {
    const Vec2 &a = by[e], t = by[(e + 1) % by.size()] - a;
    const auto inside = [&](const Vec2& x) { return t[0] * (x[1] - a[1]) - t[1] * (x[0] - a[0]); };
    Polygon next;
    for (size_t i = 0; i < out.size(); ++i) {
      const Vec2 &p = out[i], &q = out[(i + 1) % out.size()];
      const double fp = inside(p), fq = inside(q);
      if (fp >= 0) next.push_back(p);
      if ((fp > 0 && fq < 0) || (fp < 0 && fq > 0)) next.push_back(p + fp / (fp - fq) * (q - p));
    }
    out = std::move(next);
  }
  return out;
}

/// A point of the surfaces that is integrated over.
struct Point {
  double w;
  FacetShape slave, master;
};

/// Rows times the motions of the slave nodes that have one, factored.
class TiedNodes {
 public:
  explicit TiedNodes(std::span<const MortarRow> rows) {
    for (const MortarRow& row : rows) column_.emplace(row.node, static_cast<int>(column_.size()));
    const auto n = static_cast<Eigen::Index>(rows.size());
    Eigen::SparseMatrix<double> N(n, n);
    std::vector<Eigen::Triplet<double>> entries;
    for (size_t k = 0; k < rows.size(); ++k)
      for (int t = 0; t < rows[k].n_slave; ++t)
        if (const auto at = column_.find(rows[k].term[t].first); at != column_.end())
          entries.emplace_back(static_cast<int>(k), at->second, rows[k].term[t].second);
    N.setFromTriplets(entries.begin(), entries.end());
    factors_.compute(N);
  }
  bool ok() const { return factors_.info() == Eigen::Success; }
  /// By row of the node of the row of this number.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const { return factors_.solve(right); }

 private:
  std::map<int, int> column_;
  Eigen::SparseLU<Eigen::SparseMatrix<double>> factors_;
};

struct Box {
  Vec3 low, high;
  bool meets(const Box& other, double by) const {
    return ((low.array() - by) <= other.high.array()).all() && ((high.array() + by) >= other.low.array()).all();
  }
};

Box box_of(const MortarFacet& f, std::span<const Vec3> X) {
  Box b{X[f.node[0]], X[f.node[0]]};
  for (int a = 1; a < f.n; ++a) b.low = b.low.cwiseMin(X[f.node[a]]), b.high = b.high.cwiseMax(X[f.node[a]]);
  return b;
}

/// Outward area vector of the corners' polygon.
Vec3 normal_of(const MortarFacet& f, std::span<const Vec3> X) {
  const Vec3& o = X[f.node[0]];
  Vec3 out = Vec3::Zero();
  for (int i = 1; i + 1 < corners(f.n); ++i) out += (X[f.node[i]] - o).cross(X[f.node[i + 1]] - o) / 2;
  return out;
}

/// Points of a polygon of the plane through `o` with axes t1, t2, and the gap between the facets there.
struct Plane {
  Vec3 o, t1, t2, n;
  Projected project(const MortarFacet& f, std::span<const Vec3> X) const {
    Projected out{f.n, {}};
    for (int a = 0; a < f.n; ++a) out.p[a] = {t1.dot(X[f.node[a]] - o), t2.dot(X[f.node[a]] - o)};
    return out;
  }
};

}  // namespace

Mortar mortar(std::span<const Vec3> X, std::span<const MortarFacet> slave, std::span<const MortarFacet> master, double gap) {
  static const Rule coarse = gauss(3), fine = gauss(5);
  Mortar out;
  std::vector<Box> box;
  std::vector<Vec3> normal;
  for (const MortarFacet& f : master) box.push_back(box_of(f, X)), normal.push_back(normal_of(f, X).normalized());
  struct Sum {
    std::map<int, double> slave, master;
    double tied = 0, whole = 0;  // int N^2, of what is covered and of all
    double open = 1e300, limit = 0;
  };
  std::map<int, Sum> sums;
  double area = 0, covered = 0;
  Eigen::Matrix4d moments = Eigen::Matrix4d::Zero();  // of 1 and x from here, over what is covered
  const Vec3 here = slave.empty() ? Vec3::Zero() : X[slave.front().node[0]];
  for (const MortarFacet& f : slave) {
    const Vec3 whole = normal_of(f, X);
    const double size = std::sqrt(whole.norm()), limit = gap < 0 ? size / 20 : gap, reach = std::max(limit, size / 2);
    Plane plane{Vec3::Zero(), {}, {}, whole.normalized()};
    for (int a = 0; a < corners(f.n); ++a) plane.o += X[f.node[a]] / corners(f.n);
    plane.t1 = (X[f.node[1]] - X[f.node[0]]).normalized();
    plane.t1 = (plane.t1 - plane.n * plane.n.dot(plane.t1)).normalized();
    plane.t2 = plane.n.cross(plane.t1);
    const Projected mine = plane.project(f, X);
    const Polygon own = mine.polygon();
    const double own_area = area_of(own);
    double farthest = 0;  // from the origin, whose round-off lets facets overlap that share an edge
    for (int a = 0; a < f.n; ++a) farthest = std::max(farthest, X[f.node[a]].cwiseAbs().maxCoeff());
    const double least = 1e-14 * own_area + 1e-14 * farthest * size;
    area += own_area;
    const auto over = [&](const Polygon& polygon, const Rule& rule, auto&& use) {  // triangles, squares with one side shrunk to a point
      for (size_t k = 1; k + 1 < polygon.size(); ++k) {
        const Vec2 a = polygon[k] - polygon[0], b = polygon[k + 1] - polygon[0];
        const double twice = a[0] * b[1] - a[1] * b[0];
        for (size_t i = 0; i < rule.x.size(); ++i)
          for (size_t j = 0; j < rule.x.size(); ++j) {
            const double u = rule.x[i];
            const Vec2 p = polygon[0] + u * (a + rule.x[j] * (b - a));
            use(p, rule.w[i] * rule.w[j] * u * twice);
          }
      }
    };
    over(own, fine, [&](const Vec2& p, double w) {
      const FacetShape shape = mine.at(p);
      for (int a = 0; a < f.n; ++a) sums[f.node[a]].whole += w * shape.N[a] * shape.N[a];
    });
    const Box mine_box = box_of(f, X);
    std::vector<std::pair<size_t, std::vector<Point>>> pieces;
    double facet_covered = 0;
    for (size_t m = 0; m < master.size(); ++m) {
      if (!mine_box.meets(box[m], reach) || normal[m].dot(plane.n) > facing) continue;
      const Projected theirs = plane.project(master[m], X);
      const Polygon piece = clip(own, theirs.polygon());
      if (piece.size() < 3 || area_of(piece) < least) continue;
      std::vector<Point> points;
      double widest = 0, ahead = 0;
      over(piece, f.n == 3 && master[m].n == 3 ? coarse : fine, [&](const Vec2& p, double w) {
        const Point& at = points.emplace_back(Point{w, mine.at(p), theirs.at(p)});
        double g = 0;
        for (int a = 0; a < f.n; ++a) g -= at.slave.N[a] * plane.n.dot(X[f.node[a]] - plane.o);
        for (int b = 0; b < master[m].n; ++b) g += at.master.N[b] * plane.n.dot(X[master[m].node[b]] - plane.o);
        widest = std::max(widest, std::abs(g)), ahead = std::max(ahead, g);
      });
      if (widest > limit) {
        if (area_of(piece) < share_tied * own_area) continue;                              // side by side but for the digits of a file
        const double off = ahead > limit ? ahead : widest < size / 2 ? widest : HUGE_VAL;  // a deeper one is another layer
        for (int a = 0; a < f.n; ++a)
          if (Sum& s = sums[f.node[a]]; off < s.open) s.open = off, s.limit = limit;
        continue;
      }
      out.widest = std::max(out.widest, widest), out.facet = std::max(out.facet, size), facet_covered += area_of(piece);
      pieces.emplace_back(m, std::move(points));
    }
    if (pieces.empty()) continue;
    covered += facet_covered;
    if (facet_covered > 1.05 * own_area) out.twice_node = f.node[0];
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(f.n, f.n), psi = Eigen::MatrixXd::Identity(f.n, f.n);
    Eigen::VectorXd D = Eigen::VectorXd::Zero(f.n);
    for (const auto& [m, points] : pieces)
      for (const Point& at : points) {
        const Eigen::Map<const Eigen::VectorXd> N(at.slave.N, f.n);
        D += at.w * N, M += at.w * N * N.transpose();
        Eigen::Vector4d x(1, 0, 0, 0);
        for (int a = 0; a < f.n; ++a) x.tail<3>() += at.slave.N[a] * (X[f.node[a]] - here);
        moments += at.w * x * x.transpose();
      }
    if (f.n <= 4 && facet_covered > least_dual * own_area) psi = D.asDiagonal() * M.inverse();
    const Eigen::MatrixXd n = psi * M;
    const bool dual = f.n <= 4 && facet_covered > least_dual * own_area;
    for (int i = 0; i < f.n; ++i) {
      Sum& row = sums[f.node[i]];
      row.tied += M(i, i);
      for (int s = 0; s < f.n; ++s)
        if (!dual || i == s) row.slave[f.node[s]] += n(i, s);
      for (const auto& [m, points] : pieces)
        for (const Point& at : points) {
          const double weight = at.w * psi.row(i).dot(Eigen::Map<const Eigen::VectorXd>(at.slave.N, f.n));
          for (int b = 0; b < master[m].n; ++b) row.master[master[m].node[b]] -= weight * at.master.N[b];
        }
    }
  }
  const Vec3 middle = moments.block<3, 1>(1, 0) / moments(0, 0);
  out.spread = moments.block<3, 3>(1, 1) / moments(0, 0) - middle * middle.transpose();
  out.n_nodes = static_cast<int>(sums.size()), out.covered = area > 0 ? covered / area : 0;
  for (const auto& [node, sum] : sums) {
    if (!(sum.tied > share_tied * sum.whole)) {
      if (sum.open < 1e299 && sum.open > out.open) out.open = sum.open, out.open_node = node, out.open_limit = sum.limit;
      continue;
    }
    const double own = sum.slave.at(node);
    MortarRow row{node, {}, 0, own};
    double total = 0;
    for (const auto& [s, w] : sum.slave) row.term.emplace_back(s, w / own), total += w / own;
    row.n_slave = static_cast<int>(row.term.size());
    double size = 0;
    for (const auto& [m, w] : sum.master) size = std::max(size, std::abs(w / own)), total += w / own;
    for (const auto& [m, w] : sum.master)
      if (std::abs(w / own) > 1e-13 * size) row.term.emplace_back(m, w / own);
    row.term.back().second -= std::accumulate(row.term.begin(), row.term.end(), 0.0, [](double a, const auto& t) { return a + t.second; });
    out.rows.push_back(std::move(row));
  }
  return out;
}

void close_gaps(std::span<const MortarRow> rows, std::span<Vec3> X) {
  Eigen::MatrixXd gap = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()), 3);
  for (size_t k = 0; k < rows.size(); ++k)
    for (const auto& [node, w] : rows[k].term) gap.row(static_cast<Eigen::Index>(k)) -= w * X[node].transpose();
  const TiedNodes nodes(rows);
  if (!nodes.ok()) return;  // what stays open is refused
  const Eigen::MatrixXd move = nodes.solve(gap);
  for (size_t k = 0; k < rows.size(); ++k) X[rows[k].node] += move.row(static_cast<Eigen::Index>(k)).transpose();
}

TurnHeld least_held_turn(const Mortar& mortar, std::span<const Vec3> X) {
  const TiedNodes nodes(mortar.rows);
  if (!nodes.ok()) return {1, Vec3::Zero()};
  const Vec3 o = X[mortar.rows.front().node];
  Eigen::MatrixXd other = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(mortar.rows.size()), 4);
  for (size_t k = 0; k < mortar.rows.size(); ++k)
    for (size_t t = mortar.rows[k].n_slave; t < mortar.rows[k].term.size(); ++t) {
      const auto& [node, w] = mortar.rows[k].term[t];
      other.row(static_cast<Eigen::Index>(k)) -= w * Eigen::RowVector4d(1, X[node][0] - o[0], X[node][1] - o[1], X[node][2] - o[2]);
    }
  // a shift v and a turn w about o move the node of row i by a_i v + w x p_i, with a_i and p_i in row i of this
  const Eigen::MatrixXd moved = nodes.solve(other);
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  for (Eigen::Index k = 0; k < moved.rows(); ++k) sum += mortar.rows[k].own * moved.row(k).transpose() * moved.row(k);
  const Vec3 first = sum.block<3, 1>(1, 0);
  const Mat3 spread = (sum.block<3, 3>(1, 1) - first * first.transpose() / sum(0, 0)) / sum(0, 0);
  const auto turned = [](const Mat3& s) { return Mat3(s.trace() * Mat3::Identity() - s); };
  const Eigen::GeneralizedSelfAdjointEigenSolver<Mat3> least(turned(spread), turned(mortar.spread));
  return {least.eigenvalues()[0], least.eigenvectors().col(0).normalized()};
}

}  // namespace hilo
