// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/smooth_faces.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/joined.hpp"

namespace hilo {
namespace {

/// Nearest point of a triangle to x.
Vec3 nearest(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& x) {
  const Vec3 ab = b - a, ac = c - a, ax = x - a, bx = x - b, cx = x - c;
  const double d1 = ab.dot(ax), d2 = ac.dot(ax), d3 = ab.dot(bx), d4 = ac.dot(bx), d5 = ab.dot(cx), d6 = ac.dot(cx);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  if (d6 >= 0 && d5 <= d6) return c;
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const double sum = va + vb + vc;
  return sum == 0 ? a : Vec3(a + vb / sum * ab + vc / sum * ac);
}

/// The circle nearest to points of a plane in algebraic distance: centre and radius.
Eigen::Vector3d circle(const std::vector<Eigen::Vector2d>& points) {
  Eigen::MatrixXd A(points.size(), 3);
  Eigen::VectorXd b(points.size());
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    const Eigen::Vector2d& x = points[static_cast<size_t>(i)];
    A.row(i) << x[0], x[1], 1;
    b[i] = x.squaredNorm();
  }
  const Eigen::Vector3d s = A.colPivHouseholderQr().solve(b);
  return {s[0] / 2, s[1] / 2, std::sqrt(std::max(0.0, s[2] + (s[0] * s[0] + s[1] * s[1]) / 4))};
}

/// Whether a face lies on the cylinder of another: its corners do, and its facets go no deeper below than `deepest`.
class Cylinder {
 public:
  Cylinder(const FaceShape& s, std::span<const SurfaceFacet> facets, const std::vector<size_t>& seed)
      : middle_(s.middle), axis_(s.axis), radius_(s.radius), sign_(s.kind == "shaft" ? 1 : -1) {
    for (const size_t i : seed) deepest_ = std::max(deepest_, depth(facets[i]));
  }
  bool has(const SurfaceFacet& f) const {
    for (size_t k = 0; k < static_cast<size_t>(f.n_corners); ++k)
      if (std::abs(across(f.at(k)).norm() - radius_) > 2e-3 * radius_) return false;
    const Vec3 normal = f.area().normalized();
    return sign_ * normal.dot(across(f.centre()).normalized()) > 0.5 && depth(f) < 3.5 * deepest_;
  }

 private:
  Vec3 across(const Vec3& x) const { return x - middle_ - (x - middle_).dot(axis_) * axis_; }
  double depth(const SurfaceFacet& f) const {
    double deep = 0;
    const auto n = static_cast<size_t>(f.n_corners);
    for (size_t k = 0; k < n; ++k) deep = std::max(deep, radius_ - across((f.at(k) + f.at((k + 1) % n)) / 2).norm());
    return deep;
  }
  Vec3 middle_, axis_;
  double radius_, sign_, deepest_ = 0;
};

using Edges = std::map<std::pair<std::int64_t, std::int64_t>, std::vector<size_t>>;

/// Faces of coarse cells on one cylinder, whose facets turn by more than the angle, become one.
void join_cylinders(std::span<const SurfaceFacet> facets, const Edges& edges, Joined<size_t>& joined) {
  constexpr size_t most = 5000;  // a cylinder of more facets is not coarse
  std::map<size_t, std::vector<size_t>> face;
  for (size_t i = 0; i < facets.size(); ++i) face[joined.root(i)].push_back(i);
  std::map<size_t, std::set<size_t>> beside;
  for (const auto& [edge, of] : edges)
    if (of.size() == 2)
      if (const size_t a = joined.root(of[0]), b = joined.root(of[1]); a != b) beside[a].insert(b), beside[b].insert(a);
  std::vector<std::pair<double, size_t>> seeds;
  std::map<size_t, FaceShape> shape;
  for (const auto& [id, its] : face) {
    if (its.size() < 3 || its.size() > most || !beside.contains(id)) continue;
    std::vector<SurfaceFacet> own;
    for (const size_t i : its) own.push_back(facets[i]);
    if (auto s = shape_of_face(own); s.radius > 0) seeds.emplace_back(-s.area, id), shape[id] = std::move(s);
  }
  std::ranges::sort(seeds);
  std::set<size_t> taken;
  for (const auto& [area, seed] : seeds) {
    if (!taken.insert(seed).second) continue;
    const Cylinder cylinder(shape[seed], facets, face[seed]);
    std::vector<size_t> open{seed};
    for (size_t k = 0; k < open.size(); ++k)
      for (const size_t other : beside[open[k]]) {
        if (taken.contains(other) || face[other].size() > most) continue;
        if (!std::ranges::all_of(face[other], [&](size_t i) { return cylinder.has(facets[i]); })) continue;
        taken.insert(other), open.push_back(other);
        joined.join(seed, other);
      }
  }
}

}  // namespace

Vec3 SurfaceFacet::centre() const {
  Vec3 sum = Vec3::Zero();
  for (size_t i = 0; i < static_cast<size_t>(n_corners); ++i) sum += at(i);
  return sum / static_cast<double>(n_corners);
}

Vec3 SurfaceFacet::area() const {
  return n_corners == 3 ? Vec3((at(1) - at(0)).cross(at(2) - at(0)) / 2) : Vec3((at(2) - at(0)).cross(at(3) - at(1)) / 2);
}

std::vector<int> smooth_faces(std::span<const SurfaceFacet> facets, double angle) {
  Joined<size_t> joined(facets.size());
  Edges edges;
  std::vector<Vec3> normal;
  for (size_t i = 0; i < facets.size(); ++i) {
    normal.push_back(facets[i].area().normalized());
    const auto n = static_cast<size_t>(facets[i].n_corners);
    for (size_t k = 0; k < n; ++k) edges[std::minmax(facets[i].node[k], facets[i].node[(k + 1) % n])].push_back(i);
  }
  const double least = std::cos(angle);
  for (const auto& [edge, of] : edges)
    if (of.size() == 2 && normal[of[0]].dot(normal[of[1]]) > least) joined.join(of[0], of[1]);
  join_cylinders(facets, edges, joined);
  std::vector<int> face(facets.size(), -1);
  int n_faces = 0;
  for (size_t i = 0; i < facets.size(); ++i) face[i] = joined.root(i) == i ? n_faces++ : face[joined.root(i)];
  return face;
}

double distance(const SurfaceFacet& f, const Vec3& x) {
  double d = (nearest(f.at(0), f.at(1), f.at(2), x) - x).norm();
  if (f.n_corners == 4) d = std::min(d, (nearest(f.at(0), f.at(2), f.at(3), x) - x).norm());
  return d;
}

FaceShape shape_of_face(std::span<const SurfaceFacet> facets) {
  FaceShape s;
  s.kind = "free";
  Vec3 total = Vec3::Zero(), centroid = Vec3::Zero();
  Mat3 normals = Mat3::Zero();
  for (const SurfaceFacet& f : facets) {
    const Vec3 a = f.area();
    const double size = a.norm();
    s.area += size, total += a, centroid += size * f.centre();
    if (size > 0) normals += a * a.transpose() / size;
  }
  if (!(s.area > 0)) return s;
  centroid /= s.area;
  double nearest = 1e300;
  for (const SurfaceFacet& f : facets)
    if (const double d = (f.centre() - centroid).norm(); d < nearest) nearest = d, s.point = f.centre();
  s.middle = centroid;
  if (total.norm() > (1 - 1e-9) * s.area) {
    s.kind = "plane", s.axis = total.normalized();
    return s;
  }
  // the axis along which the normals have least, then Gauss-Newton for the corners: chords tilt the normals, the corners are on it
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(normals / s.area);
  if (eigen.eigenvalues()[0] > 0.05 || eigen.eigenvalues()[1] < 1e-3) return s;
  std::vector<Vec3> points;
  std::set<std::int64_t> corners;
  for (const SurfaceFacet& f : facets)
    for (size_t i = 0; i < static_cast<size_t>(f.n_corners); ++i) points.push_back(f.at(i) - centroid), corners.insert(f.node[i]);
  if (corners.size() < 6) return s;  // a cylinder passes through any five points
  Vec3 axis = eigen.eigenvectors().col(0), at = Vec3::Zero();
  double radius = 0, off = 0;
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
    if (iteration == 0) {
      std::vector<Eigen::Vector2d> flat;
      for (const Vec3& x : points) flat.emplace_back(x.dot(u), x.dot(v));
      const Eigen::Vector3d c = circle(flat);
      at = c[0] * u + c[1] * v, radius = c[2];
    }
    Eigen::MatrixXd A(points.size(), 5);
    Eigen::VectorXd r(points.size());
    off = 0;
    for (size_t i = 0; i < points.size(); ++i) {
      const Vec3 d = points[i] - at, across = d - d.dot(axis) * axis;
      const double length = std::max(across.norm(), 1e-300), along = d.dot(axis);
      const Vec3 n = across / length;
      const auto k = static_cast<Eigen::Index>(i);
      A.row(k) << -n.dot(u), -n.dot(v), -along * n.dot(u), -along * n.dot(v), -1;
      r[k] = length - radius, off = std::max(off, std::abs(r[k]));
    }
    const Eigen::VectorXd step = A.colPivHouseholderQr().solve(-r);
    at += step[0] * u + step[1] * v, axis = (axis + step[2] * u + step[3] * v).normalized(), radius += step[4];
    if (!(step.norm() < 1e3 * (1 + radius))) return s;
  }
  double reach = 0;  // of the face across the axis
  for (const Vec3& x : points) reach = std::max(reach, (x - x.dot(axis) * axis).norm());
  if (!(off < 2e-3 * std::min(radius, reach)) || radius > 100 * reach) return s;
  double low = 1e300, high = -1e300, outward = 0;
  for (const Vec3& x : points) low = std::min(low, (x - at).dot(axis)), high = std::max(high, (x - at).dot(axis));
  s.middle = centroid + at + (low + high) / 2 * axis;
  for (const SurfaceFacet& f : facets) outward += f.area().dot(f.centre() - s.middle);
  s.kind = outward > 0 ? "shaft" : "bore";
  int largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  s.axis = axis[largest] < 0 ? Vec3(-axis) : axis;
  s.radius = radius, s.length = high - low;
  return s;
}

}  // namespace hilo
