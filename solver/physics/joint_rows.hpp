// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of joints beyond plain measures: sums of measures and angles.
#pragma once
#include <vector>

#include "physics/curve.hpp"
#include "physics/row_law.hpp"
#include "physics/turn.hpp"

namespace hilo {

/// The first `n_plain` rows are the first measures themselves; each further row is a weighted sum of measures and of angles, an angle
/// being given by two measures that follow each other, its sine and its cosine.
class SumRows final : public RowLaw {
 public:
  struct Part {
    double weight;
    int measure;  // or of the sine
    bool angle = false;
  };
  SumRows(int n_plain, std::vector<std::vector<Part>> sums);
  int n_rows() const override { return n_plain_ + static_cast<int>(sums_.size()); }
  void values(const Values& e, double* g) const override;
  void gradient(const Values& e0, const Values& e1, Gradient& out) const override;
  void commit(const Values& e) override;
  void archive(Archive& a) override { a("angles", turn_); }

 private:
  int n_plain_;
  std::vector<std::vector<Part>> sums_;
  std::array<Turn, max_measures> turn_;  // of the angle whose sine is measure i
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
