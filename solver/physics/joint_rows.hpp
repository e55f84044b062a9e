// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of joints beyond plain measures: sums of measures and of angles.
#pragma once
#include <vector>

#include "physics/attitude.hpp"
#include "physics/curve.hpp"
#include "physics/row_law.hpp"
#include "physics/turn.hpp"

namespace hilo {

/// The first `n_plain` rows are the first measures themselves; each further row is a weighted sum of measures and of angles, which measures
/// that follow each other give.
class SumRows final : public RowLaw {
 public:
  enum Of {
    itself,
    angle,     // of a sine and a cosine, unwrapped
    arcsine,   // of a sine
    tilt,      // about x and y (`axis` 0, 1), of an axis with these three components, from z [rad]
    rotation,  // component `axis` of the rotation vector of R, its nine entries by columns, unwrapped below a whole turn [rad]
  };
  struct Part {
    double weight;
    int measure;  // the first of those it is made of
    Of of = itself;
    int axis = 0;
  };
  SumRows(int n_plain, std::vector<std::vector<Part>> sums);
  int n_rows() const override { return n_plain_ + static_cast<int>(sums_.size()); }
  void values(const Values& e, double* g) const override;
  void gradient(const Values& e0, const Values& e1, Gradient& out) const override;
  void commit(const Values& e) override;
  void archive(Archive& a) override { a("angles", turn_, attitude_); }
  std::string beyond(const Values& e) const override;

 private:
  double value(const Part& p, const Values& e) const;
  int n_plain_;
  std::vector<std::vector<Part>> sums_;
  std::array<Turn, max_measures> turn_;  // of the angle whose sine is measure i
  Attitude attitude_;                    // of the rotation: there is one
};

/// Two rows that hold a point, three measures e in the frame of the curve, on the curve.  With the tangent t and two normals b_r of the
/// point accepted last, s(e) solves t.(C(s) - e) = 0 and g_r = b_r.(e - C(s)): no parameter is left as an unknown.  The discrete gradient
/// is Gonzalez's, grad g(e_mid) + (g1 - g0 - grad g(e_mid).de)/|de|^2 de: on the curve it is normal to the chord [gonzalez-1996].
class CurveRows final : public RowLaw {
 public:
  explicit CurveRows(Curve curve);
  int n_rows() const override { return 2; }
  void values(const Values& e, double* g) const override;
  void gradient(const Values& e0, const Values& e1, Gradient& out) const override;
  void commit(const Values& e) override;
  void archive(Archive& a) override { a("curve", s_, t_, b_[0], b_[1]); }
  std::string fault(const Values& e) const override;

 private:
  double parameter(const Vec3& e) const;
  struct Local {
    double g[2];
    Vec3 d[2];
    Mat3 H[2];
  };
  Local local(const Vec3& e) const;
  Curve curve_;
  double s_;       // of the point accepted last
  Vec3 t_, b_[2];  // tangent and normals there
};

}  // namespace hilo
