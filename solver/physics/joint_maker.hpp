// SPDX-License-Identifier: GPL-3.0-or-later
// What kinds of joints are made with: measures between points and directions carried by the ends, taken as rows.
#pragma once
#include <algorithm>

#include "physics/joint.hpp"
#include "physics/joint_rows.hpp"

namespace hilo {

/// A joint under construction.
class JointMaker {
 public:
  using Sum = std::vector<SumRows::Part>;  // a row that is a sum of measures
  JointMaker(const JointPlace& place, const Config& q)
      : j(place), q(q), axis(place.frame.col(2)), axis_b(place.axis_b.isZero() ? axis : place.axis_b) {
    c.join(j.a, j.b, q, j.at_b, j.frame);
  }
  const JointPlace& j;
  const Config& q;
  const Vec3 axis, axis_b;
  Joint c;

  int zero(std::vector<Term> terms) { return c.add_zero_measure(std::move(terms), q); }
  /// Directions at right angles, or with the angle by which they miss it.
  void dot(int i, int k) {
    const int m = zero({{Term::dot, i, k}});
    soften(m, {{{1, m, SumRows::arcsine}}});
  }
  /// Sine and cosine of the angle that x, carried by `turning`, has turned from where it is now about `axis`, carried by `base`. Returns
  /// the measure of the sine.
  int angle(int base, int turning, const Vec3& about, const Vec3& x) {
    const int u_ = c.add_direction(base, q, x), v_ = c.add_direction(base, q, about.cross(x)), w = c.add_direction(turning, q, x);
    const int sine = c.add_measure({{Term::dot, v_, w}});
    c.add_measure({{Term::dot, u_, w}});
    return sine;
  }
  int pa() { return pa_ < 0 ? points(), pa_ : pa_; }
  int pb() { return pb_ < 0 ? points(), pb_ : pb_; }
  /// Columns of the frame carried by a and by b.
  int u(int i) { return ua_[i] < 0 ? ua_[i] = c.add_direction(0, q, j.frame.col(i)) : ua_[i]; }
  int v(int i) {
    const Mat3 frame_b = Eigen::Quaterniond::FromTwoVectors(axis, axis_b).toRotationMatrix() * j.frame;
    return vb_[i] < 0 ? vb_[i] = c.add_direction(1, q, frame_b.col(i)) : vb_[i];
  }
  void same_point() {
    for (int i = 0; i < 3; ++i)
      if (j.gives_way && j.a.body >= 0)
        slide(i);
      else
        zero({{Term::coordinate, pa(), pb(), 0, 1, Vec3::Unit(i)}});
  }
  int slide(int i) {
    points();
    return zero({{Term::slide, u(i), pa_, pb_}});
  }
  /// The third axes stay parallel: rows B, A.
  void parallel() {
    if (!j.gives_way) return dot(u(0), v(2)), dot(u(1), v(2));
    const int m = c.add_measure({{Term::dot, u(0), v(2)}});
    c.add_measure({{Term::dot, u(1), v(2)}}), c.add_measure({{Term::dot, u(2), v(2)}});
    soften(m, {{{1, m, SumRows::tilt, 1}}, {{1, m, SumRows::tilt, 0}}});
  }
  /// The frames stay parallel: rows A, B, C.
  void aligned() {
    if (!j.gives_way) return dot(u(1), v(2)), dot(u(2), v(0)), dot(u(0), v(1));
    const int m = c.add_rotation({u(0), u(1), u(2)}, {v(0), v(1), v(2)});
    soften(m, {{{1, m, SumRows::rotation, 0}}, {{1, m, SumRows::rotation, 1}}, {{1, m, SumRows::rotation, 2}}});
  }
  /// Where the joint gives way, the measures from `first` on give these rows.
  void soften(int first, std::vector<Sum> sums) {
    if (j.gives_way) soft_.push_back({first, static_cast<int>(c.measures.size()), std::move(sums)});
  }
  int slid() { return along_ < 0 ? along_ = slide(2) : along_; }
  int turned() { return turned_ < 0 ? turned_ = angle(0, 1, axis, j.frame.col(0)) : turned_; }

  /// The measures so far are rows, then these sums, then what drives the joint.
  Joint with(std::vector<Sum> sums = {}, int n_plain = -1) {
    if (n_plain < 0) n_plain = static_cast<int>(c.measures.size());
    if (!soft_.empty()) {
      std::vector<Sum> rows;
      for (int m = 0; m < n_plain;) {
        const auto softer = std::find_if(soft_.begin(), soft_.end(), [m](const Softer& s) { return s.first == m; });
        if (softer == soft_.end()) {
          rows.push_back({{1, m++}});
        } else {
          rows.insert(rows.end(), softer->rows.begin(), softer->rows.end());
          m = softer->end;
        }
      }
      sums.insert(sums.begin(), rows.begin(), rows.end()), n_plain = 0;
    }
    if (j.driven == JointPlace::Driven::slide) sums.push_back({{1, slid()}});
    if (j.driven == JointPlace::Driven::angle) sums.push_back({{1, turned(), SumRows::angle}});
    if (!sums.empty()) c.rows = std::make_unique<SumRows>(n_plain, std::move(sums));
    if (j.driven != JointPlace::Driven::none) c.drive.row = c.n_rows() - 1;
    return std::move(c);
  }

 private:
  struct Softer {
    int first, end;  // measures
    std::vector<Sum> rows;
  };
  std::vector<Softer> soft_;
  void points() {
    if (pa_ < 0) pa_ = c.add_point(0, q, j.at), pb_ = c.add_point(1, q, j.at_b);
  }
  int pa_ = -1, pb_ = -1, along_ = -1, turned_ = -1, ua_[3] = {-1, -1, -1}, vb_[3] = {-1, -1, -1};
};

}  // namespace hilo
