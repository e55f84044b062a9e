// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/scene/numbered_faces.hpp"

#include <fmt/format.h>
#include <vtkCamera.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

namespace hilo {
namespace {

/// Whether the half line x + s d, s > 0, goes through a triangle: barycentric coordinates of its plane's point.
bool hits(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& x, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, p = d.cross(v);
  const double det = u.dot(p);
  if (std::abs(det) < 1e-12 * u.norm() * v.norm() * d.norm()) return false;
  const Vec3 s = x - a, q = s.cross(u);
  const double r = s.dot(p) / det, t = d.dot(q) / det;
  return r >= 0 && t >= 0 && r + t <= 1 && v.dot(q) / det > 1e-9;
}

bool hits(const SurfaceFacet& f, const Vec3& x, const Vec3& d) {
  return hits(f.at(0), f.at(1), f.at(2), x, d) || (f.n_corners == 4 && hits(f.at(0), f.at(2), f.at(3), x, d));
}

}  // namespace

std::vector<NumberedFace> numbered_faces(const Mesh& mesh, const std::vector<Facet>& outside, double angle) {
  std::map<std::int32_t, std::vector<SurfaceFacet>> of_region;
  for (const Facet& f : outside)
    of_region[mesh.region[static_cast<size_t>(f.cell)]].push_back(surface_facet(mesh, f, [](std::int64_t n) { return n; }));
  std::vector<NumberedFace> faces;
  for (const auto& [region, facets] : of_region) {
    const size_t first = faces.size();
    const auto face = smooth_faces(facets, angle);
    for (size_t i = 0; i < facets.size(); ++i) {
      const size_t k = first + static_cast<size_t>(face[i]);
      if (k == faces.size()) faces.push_back({region, {}, {}});
      faces[k].facets.push_back(facets[i]);
    }
  }
  for (NumberedFace& f : faces) f.shape = shape_of_face(f.facets);
  return faces;
}

Table table_of_faces(const Mesh& mesh, const std::vector<NumberedFace>& faces) {
  double size = 0;
  for (const NumberedFace& f : faces) size = std::max({size, f.shape.middle.norm(), f.shape.length});
  const auto vector = [](const Vec3& v, double scale) {
    const auto g = [&](double x) { return std::abs(x) < 1e-9 * scale ? 0.0 : x; };
    return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", g(v[0]), g(v[1]), g(v[2]));
  };
  Table table{{"face", "region", "shape", "area [m^2]", "near [m]", "middle [m]", "axis", "radius [m]", "length [m]"}, {}, 3};
  for (size_t i = 0; i < faces.size(); ++i) {
    const FaceShape& s = faces[i].shape;
    const bool round = s.radius > 0;
    table.rows.push_back({fmt::format("{}", i + 1), mesh.region_name[static_cast<size_t>(faces[i].region)], s.kind,
                          fmt::format("{:.4g}", s.area), vector(s.point, size), vector(s.middle, size),
                          s.axis.norm() > 0 ? vector(s.axis, 1e3) : "-", round ? fmt::format("{:.5g}", s.radius) : "-",
                          round ? fmt::format("{:.5g}", s.length) : "-"});
  }
  return table;
}

std::vector<std::optional<Vec3>> places_of_numbers(const std::vector<NumberedFace>& faces, vtkCamera* camera) {
  const Vec3 eye(camera->GetPosition()), along(camera->GetDirectionOfProjection());
  size_t n_facets = 0;
  for (const NumberedFace& f : faces) n_facets += f.facets.size();
  const bool look_behind = static_cast<double>(n_facets) * static_cast<double>(faces.size()) < 1e8;  // else what hides is not looked for
  std::vector<std::optional<Vec3>> places;
  for (const NumberedFace& face : faces) {
    std::vector<std::pair<double, Vec3>> candidates;
    for (const SurfaceFacet& f : face.facets) {
      const Vec3 x = f.centre(), to_eye = camera->GetParallelProjection() ? Vec3(-along) : Vec3(eye - x);
      if (f.area().dot(to_eye) > 0) candidates.emplace_back((x - face.shape.point).norm(), x);
    }
    std::sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    places.emplace_back();
    const size_t step = std::max<size_t>(1, candidates.size() / 12);
    for (size_t i = 0; i < candidates.size() && !places.back(); i += step) {
      const Vec3& x = candidates[i].second;
      const Vec3 to_eye = camera->GetParallelProjection() ? Vec3(-along) : Vec3(eye - x);
      const auto hides = [&](const SurfaceFacet& f) { return (f.centre() - x).norm() > 0 && hits(f, x, to_eye); };
      if (!look_behind || std::ranges::none_of(faces, [&](const NumberedFace& other) { return std::ranges::any_of(other.facets, hides); }))
        places.back() = x;
    }
  }
  return places;
}

std::vector<Vec2> spread_labels(std::vector<Vec2> at, double apart, const Box& within) {
  const double wanted = 1.02 * apart, share = 0.15;  // small pushes, that come to an end: large ones throw labels farther than they need
  for (int round = 0; round < 500; ++round) {
    bool moved = false;
    for (size_t i = 0; i < at.size(); ++i)
      for (size_t j = 0; j < i; ++j) {
        Vec2 from = at[i] - at[j];
        const double d = from.norm();
        if (d >= apart) continue;
        if (d < 1e-6 * apart) from = Vec2(std::cos(2.4 * static_cast<double>(i)), std::sin(2.4 * static_cast<double>(i)));  // any way
        const Vec2 push = share * (wanted - d) / 2 * from.normalized();
        at[i] += push, at[j] -= push;
        moved = true;
      }
    if (!moved) break;
    for (Vec2& x : at) {
      x.x() = std::clamp(x.x(), within.x, within.x + within.w);
      x.y() = std::clamp(x.y(), within.y, within.y + within.h);
    }
  }
  return at;
}

}  // namespace hilo
