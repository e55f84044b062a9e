// SPDX-License-Identifier: GPL-3.0-or-later
// Metal: J2 plasticity at finite strain, F = Fe Fp, Hencky's elasticity [weber-anand-1990, eterovic-bathe-1990].
//
//   h = ln(Fe^T Fe)/2,   W = lambda/2 (tr h)^2 + mu h:h + (H_k/3) a:a,   T = dW/dh,   X = (2/3) H_k a
//   q = sqrt(3/2) |dev T - X| <= s(p) (1 + (dp/dt / rate)^(1/exponent))
//   d_p = (3/2) (dev T - X)/q dp/dt,   da/dt = d_p
//   s(p) = yield + hardening p + (saturation - yield)(1 - exp(-saturation_rate p)), or a table
//
// A step from E0 to E1 works in the axes of the plastic deformation at its start, G = Fp^-1:  E~ = (G^T (I + 2E) G - I)/2, trial
// h1 = ln(I + 2 E~1)/2, and flows by the return map  Dp: q_trial - (3 mu + H_k) Dp = s(...), Dh = (3/2) N Dp [simo-hughes-1998].  The
// elastic strain is h1 - Dh, and G1 = G exp(-h1) exp(h1 - Dh) has exactly it, coaxial (isotropic hardening, the exponential map) or not.
//
// Energy over a step [meng-laursen-2002, noels-stainier-2006]: with G~ the exact difference quotient of the elastic energy from E~0 to the
// trial E~1 (LogStep, log_strain.hpp), D = (q_start + q_end)/2 Dp >= 0, q_start = max(q0, s(p0)),
//
//   S~ = G~ - mu Dh : Q1 + k (E~1 - E~0),   Q1 = dh/dE~ at E~1,      S = G S~ G^T
//   k |E~1 - E~0|^2 = mu Dh : Q1 : (E~1 - E~0) - R,                  R = (q_trial - q_start)/2 Dp
//
// so S.(E1 - E0) = W1 - W0 + D whatever the step: the elastic part of W1 - W0 is G~:(E~1 - E~0), and flow takes R + D of it.
#pragma once
#include <cmath>
#include <vector>

#include "physics/material/dilatation.hpp"
#include "physics/material/material.hpp"
#include "physics/material/point_step.hpp"

namespace hilo {

struct J2 {
  static constexpr std::string_view name = "j2";
  static constexpr std::string_view meaning = "metal: von Mises plasticity at finite strain, isotropic and kinematic hardening, rates";
  static std::vector<Param> keys() {
    return {young,
            poisson,
            {"yield", Type::number, "Pa", "!", "yield stress in tension, Kirchhoff: Cauchy times det F", above(0)},
            {"hardening", Type::number, "Pa", "0", "linear isotropic hardening modulus", at_least(0)},
            {"saturation", Type::number, "Pa", "", "stress that isotropic hardening tends to besides (Voce); absent: none", above(0)},
            {"saturation_rate", Type::number, "1", "0", "how fast it does, by plastic strain", at_least(0)},
            {"hardening_strain", Type::numbers, "1", "", "a table instead: equivalent plastic strains, from 0 on", at_least(0)},
            {"hardening_stress", Type::numbers, "Pa", "", "and the yield stress there; the last one holds beyond", above(0)},
            {"kinematic", Type::number, "Pa", "0", "linear kinematic hardening modulus", at_least(0)},
            {"reference_rate", Type::number, "1/s", "",
             "plastic strain rate that doubles the yield stress (Cowper and Symonds); absent: none", above(0)},
            {"rate_exponent", Type::number, "1", "1", "q = s(p) (1 + (rate of plastic strain over `reference_rate`)^(1/exponent))",
             at_least(1)}};
  }
  static J2 make(const MaterialValues& v);

  using Bulk = LogOfDet;
  static constexpr double soft_below = 0;
  static constexpr std::string_view soft_because = "";
  static constexpr int n_state = 16;  // Fp^-1 - I by rows, a, p
  static constexpr int plastic_strain = 15;

  Lame c;
  double yield, hardening = 0, saturation = 0, saturation_rate = 0, kinematic = 0;
  double rate = INFINITY, exponent = 1;
  std::vector<double> strain{}, stress{};  // the table

  Lame linear() const { return c; }
  void respond(PointStep& step) const;
  /// s and ds/dp.
  double hardened(double p, double& slope) const;
};

inline J2 J2::make(const MaterialValues& v) {
  J2 out{lame(v.number("E"), v.number("nu")), v.number("yield"), v.number("hardening")};
  out.saturation = v.has("saturation") ? v.number("saturation") : out.yield, out.saturation_rate = v.number("saturation_rate");
  out.kinematic = v.number("kinematic");
  if (v.has("reference_rate")) out.rate = v.number("reference_rate"), out.exponent = v.number("rate_exponent");
  if (v.has("hardening_strain") || v.has("hardening_stress")) {
    out.strain = v.numbers("hardening_strain"), out.stress = v.numbers("hardening_stress");
    bool rises = out.strain.size() == out.stress.size() && !out.strain.empty() && out.strain.front() == 0;
    for (size_t i = 1; i < out.strain.size() && rises; ++i) rises = out.strain[i] > out.strain[i - 1] && out.stress[i] >= out.stress[i - 1];
    if (!rises)
      v.refuse("hardening_strain",
               "hardening_strain begins at 0 and rises, and hardening_stress has as many values, none below the one before");
    if (v.has("saturation") || out.hardening > 0)
      v.refuse("hardening_strain", "a table of hardening stands beside hardening or saturation: give one of them");
    out.yield = out.stress.front();
  }
  if (v.has("saturation") && !(out.saturation >= out.yield))
    v.refuse("saturation", "saturation lies below the yield stress: softening has no answer that the mesh does not choose");
  if (v.has("saturation") && out.saturation_rate == 0) v.refuse("saturation", "saturation needs saturation_rate");
  return out;
}

}  // namespace hilo
