// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/beam_line.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace hilo {
namespace {

/// Directors of a section: 3 along, 2 as near to `up` as it gets.
Mat3 frame_along(const Entry& e, const Vec3& along) {
  Vec3 up = std::abs(along.z()) > 0.999 ? Vec3::UnitY() : Vec3::UnitZ();
  if (e.given("orientation")) {
    up = e.vector3("orientation");
    if (up.cross(along).norm() < 1e-6 * up.norm() || up.norm() == 0)
      e.refuse("orientation", fmt::format("it is along the beam, ({:.3g}, {:.3g}, {:.3g})", along.x(), along.y(), along.z()));
  }
  Mat3 out;
  out.col(2) = along;
  out.col(0) = up.cross(along).normalized();
  out.col(1) = along.cross(out.col(0));
  return out;
}

void add_straight(const Entry& e, const Vec3& to, int n, BeamLine& line) {
  const Vec3 from = line.at.back(), way = to - from;
  const Mat3 frame = frame_along(e, way.normalized());
  for (int k = 1; k <= n; ++k) {
    line.at.push_back(k == n ? to : Vec3(from + way * k / n));
    line.cells.push_back({frame, frame, way.norm() / n});
  }
}

/// Along the circle through three points.
void add_arc(const Entry& e, const Vec3& through, const Vec3& to, int n, BeamLine& line) {
  const Vec3 from = line.at.back(), u = through - from, v = to - from, normal = u.cross(v);
  if (normal.norm() < 1e-9 * u.norm() * v.norm())
    e.refuse("points", "three points of an arc lie on a line", "path = \"line\" joins them, or two arcs make a whole circle");
  const Vec3 centre = from + (u.squaredNorm() * v - v.squaredNorm() * u).cross(normal) / (2 * normal.squaredNorm());
  const Vec3 axis = normal.normalized(), r = from - centre, s = to - centre;
  double angle = std::atan2(r.cross(s).dot(axis), r.dot(s));
  if (angle <= 0) angle += 2 * std::numbers::pi;
  const Mat3 first = frame_along(e, axis.cross(r).normalized());
  const auto turn = [&](int k) { return Eigen::AngleAxisd(angle * k / n, axis).toRotationMatrix(); };
  for (int k = 1; k <= n; ++k) {
    line.at.push_back(k == n ? to : Vec3(centre + turn(k) * r));
    line.cells.push_back({turn(k - 1) * first, turn(k) * first, 2 * r.norm() * std::sin(angle / n / 2)});
  }
}

}  // namespace

BeamLine beam_line(const Entry& e) {
  const std::vector<double>&numbers = e.numbers("points"), &given = e.numbers("cells");
  if (numbers.size() % 3 != 0 || numbers.size() < 6) e.refuse("points", "two or more points of three numbers are needed");
  std::vector<Vec3> points;
  for (size_t i = 0; i < numbers.size(); i += 3) points.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  const bool arcs = e.text("path") == "arc";
  if (arcs && points.size() % 2 == 0)
    e.refuse("points", fmt::format("{} points; an arc has a first, a middle and a last one, and the next begins there", points.size()));
  const size_t n_legs = arcs ? (points.size() - 1) / 2 : points.size() - 1;
  if (given.size() != 1 && given.size() != n_legs)
    e.refuse("cells", fmt::format("{} numbers for {} legs", given.size(), n_legs), "one for all of them, or one for each");
  for (const double n : given)
    if (n != std::floor(n) || n < 1 || n > 1e6) e.refuse("cells", fmt::format("{} is no number of cells", n));
  double size = 0;
  for (const Vec3& x : points) size = std::max(size, (x - points.front()).norm());
  for (size_t i = 1; i < points.size(); ++i)
    if (!((points[i] - points[i - 1]).norm() > 1e-9 * size)) e.refuse("points", fmt::format("points {} and {} coincide", i, i + 1));
  BeamLine line;
  line.at.push_back(points.front());
  for (size_t leg = 0; leg < n_legs; ++leg) {
    const int n = static_cast<int>(given[given.size() == 1 ? 0 : leg]);
    arcs ? add_arc(e, points[2 * leg + 1], points[2 * leg + 2], n, line) : add_straight(e, points[leg + 1], n, line);
  }
  line.closed = (points.back() - points.front()).norm() <= 1e-9 * size;
  line.s.push_back(0);
  for (size_t k = 0; k < line.cells.size(); ++k) {
    const double turn = Eigen::AngleAxisd(line.cells[k].frame_a.transpose() * line.cells[k].frame_b).angle(), half = turn / 2;
    if (turn > 1.6) e.refuse("cells", fmt::format("cell {} turns by {:.3g} rad before it is loaded", k, turn), "more cells");
    line.s.push_back(line.s.back() + line.cells[k].length * (half > 1e-6 ? half / std::sin(half) : 1));
  }
  return line;
}

std::vector<std::pair<std::string, size_t>> section_names(const Entry& e, const BeamLine& line) {
  std::vector<std::pair<std::string, size_t>> out;
  const size_t last = line.at.size() - 1;
  for (size_t k = e.given("a") ? 1 : 0; k <= last - (e.given("b") ? 1 : 0); ++k)
    if (!line.closed || k < last) out.emplace_back(fmt::format("{}.{}", e.name, k), k);
  if (!e.given("b")) out.emplace_back(e.name + ".end", line.closed ? 0 : last);
  return out;
}

}  // namespace hilo
