// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/surface/pieces.hpp"

#include <fmt/format.h>
#include <vtkCell.h>
#include <vtkGenericCell.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "base/shell_shape.hpp"
#include "model/mesh.hpp"

namespace hilo {
namespace {

/// Builds the pieces of one shape from points in its parameters (VTK's, 0 to 1).
class Maker {
 public:
  explicit Maker(Shape shape) : shape_(shape), cell_(vtkSmartPointer<vtkGenericCell>::New()) { cell_->SetCellType(info(shape).vtk_type); }

  Pieces make() {
    const int n = info(shape_).n_nodes == info(shape_).n_corners ? 1 : 2;
    switch (shape_) {
      case Shape::hex8:
      case Shape::hex20:
      case Shape::hex20r:
        for (int i = 0; i < n; ++i)
          for (int j = 0; j < n; ++j)
            for (int k = 0; k < n; ++k) {
              const Vec3 low = Vec3(i, j, k) / n;
              std::array<Vec3, 8> c;
              constexpr int at[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
              for (size_t a = 0; a < 8; ++a) c[a] = low + Vec3(at[a][0], at[a][1], at[a][2]) / n;
              fan({c.begin(), c.end()}, {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}});
            }
        break;
      case Shape::wedge6:
      case Shape::wedge15:
        for (int k = 0; k < n; ++k)
          for (int j = 0; j < n; ++j)
            for (int i = 0; i + j < n; ++i) {
              const auto at = [&](int a, int b, int c) { return Vec3(Vec3(a, b, c) / n); };
              prism(at(i, j, k), at(i + 1, j, k), at(i, j + 1, k), 1.0 / n);
              if (i + j + 1 < n) prism(at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k), 1.0 / n);
            }
        break;
      default: {
        const std::array<Vec3, 4> c{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
        if (n == 1)
          add(c);
        else
          halved(c);
      }
    }
    return std::move(made_);
  }

 private:
  int point(const Vec3& p) {
    const std::array<long, 3> key{std::lround(p.x() * 5040), std::lround(p.y() * 5040), std::lround(p.z() * 5040)};
    const auto found = known_.find(key);
    if (found != known_.end()) return found->second;
    std::vector<double> weight(static_cast<size_t>(info(shape_).n_nodes));
    cell_->InterpolateFunctions(p.data(), weight.data());
    for (double& w : weight)
      if (std::abs(w) < 1e-12) w = 0;
    made_.point.push_back(weight);
    return known_[key] = static_cast<int>(made_.point.size()) - 1;
  }

  /// Are these points on one face of the cell?
  bool border(std::initializer_list<Vec3> points) const {
    const bool box = info(shape_).n_corners == 8, prism = shape_ == Shape::wedge6 || shape_ == Shape::wedge15;
    const auto all = [&](auto&& value) {
      return std::all_of(points.begin(), points.end(), [&](const Vec3& p) { return std::abs(value(p)) < 1e-9; });
    };
    for (int i = 0; i < 3; ++i) {
      if (all([i](const Vec3& p) { return p[i]; })) return true;
      if ((box || (prism && i == 2)) && all([i](const Vec3& p) { return p[i] - 1; })) return true;
    }
    if (prism && all([](const Vec3& p) { return p.x() + p.y() - 1; })) return true;
    return !box && !prism && all([](const Vec3& p) { return p.sum() - 1; });
  }

  void add(const std::array<Vec3, 4>& c) {
    made_.tet.push_back({point(c[0]), point(c[1]), point(c[2]), point(c[3])});
    made_.on_border.push_back(
        {border({c[1], c[2], c[3]}), border({c[0], c[2], c[3]}), border({c[0], c[1], c[3]}), border({c[0], c[1], c[2]})});
  }

  /// Tetrahedra from the centre to the faces, quadrangles from their own centres.
  void fan(const std::vector<Vec3>& corner, const std::vector<std::vector<size_t>>& faces) {
    Vec3 centre = Vec3::Zero();
    for (const Vec3& c : corner) centre += c / static_cast<double>(corner.size());
    for (const auto& f : faces) {
      if (f.size() == 3) {
        add({corner[f[0]], corner[f[1]], corner[f[2]], centre});
        continue;
      }
      Vec3 middle = Vec3::Zero();
      for (const size_t a : f) middle += corner[a] / 4;
      for (size_t a = 0; a < 4; ++a) add({corner[f[a]], corner[f[(a + 1) % 4]], middle, centre});
    }
  }

  void prism(const Vec3& a, const Vec3& b, const Vec3& c, double height) {
    const Vec3 up(0, 0, height);
    fan({a, b, c, a + up, b + up, c + up}, {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}});
  }

  /// Four tetrahedra at the corners and the octahedron between them in four.
  void halved(const std::array<Vec3, 4>& c) {
    const auto m = [&](size_t a, size_t b) { return Vec3(0.5 * (c[a] + c[b])); };
    add({c[0], m(0, 1), m(0, 2), m(0, 3)}), add({m(0, 1), c[1], m(1, 2), m(1, 3)});
    add({m(0, 2), m(1, 2), c[2], m(2, 3)}), add({m(0, 3), m(1, 3), m(2, 3), c[3]});
    const Vec3 p = m(0, 2), q = m(1, 3);
    const std::array<Vec3, 4> ring{m(0, 1), m(1, 2), m(2, 3), m(0, 3)};
    for (size_t k = 0; k < 4; ++k) add({p, q, ring[k], ring[(k + 1) % 4]});
  }

  Shape shape_;
  vtkSmartPointer<vtkGenericCell> cell_;
  std::map<std::array<long, 3>, int> known_;
  Pieces made_;
};

}  // namespace

const Pieces& pieces(Shape shape) {
  if (shape == shell8) shape = Shape::hex8;
  if (static_cast<int>(shape) >= n_shapes)
    throw Error("", fmt::format("{} is a shape from outside the tree: its cells are not cut", info(shape).name));
  static std::array<Pieces, n_shapes> made;
  Pieces& p = made[static_cast<size_t>(shape)];
  if (p.tet.empty() && info(shape).dimension == 3) p = Maker(shape).make();
  return p;
}

Crossing crossing(const std::array<double, 4>& value, const std::array<bool, 4>& on_border) {
  Crossing c;
  std::array<int, 4> below{}, above{};
  int n_below = 0, n_above = 0;
  for (int i = 0; i < 4; ++i)
    (value[static_cast<size_t>(i)] < 0 ? below[static_cast<size_t>(n_below++)] : above[static_cast<size_t>(n_above++)]) = i;
  if (n_below == 0 || n_above == 0) return c;
  if (n_below == 2) {
    c.n = 4;
    c.edge = {{{below[0], above[0]}, {below[0], above[1]}, {below[1], above[1]}, {below[1], above[0]}}};
  } else {
    c.n = 3;
    for (size_t k = 0; k < 3; ++k) c.edge[k] = n_below == 1 ? std::array{below[0], above[k]} : std::array{below[k], above[0]};
  }
  for (int k = 0; k < c.n; ++k) {  // two edges of a polygon's side lie in the face that misses one corner
    const auto &e = c.edge[static_cast<size_t>(k)], &f = c.edge[static_cast<size_t>((k + 1) % c.n)];
    for (int i = 0; i < 4; ++i)
      if (i != e[0] && i != e[1] && i != f[0] && i != f[1]) c.border[static_cast<size_t>(k)] = on_border[static_cast<size_t>(i)];
  }
  return c;
}

}  // namespace hilo
