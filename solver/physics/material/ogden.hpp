// SPDX-License-Identifier: GPL-3.0-or-later
// Ogden's rubber [ogden-1972], compressible, of any number of terms:
//
//   W = sum_p 2 mu_p/alpha_p^2 (J^(-alpha_p/3) (l1^alpha_p + l2^alpha_p + l3^alpha_p) - 3) + K/2 (J - 1)^2,
//
// l the principal stretches; at small strain mu = sum mu_p and bulk modulus K.  One term of alpha = 2 is the neo-Hookean solid of decks,
// two of 2 and -2 are Mooney and Rivlin's.
//
// Over a step tr f(C) has an exact difference quotient.  With C1 = sum a_i n_i n_i^T, C0 = sum b_j m_j m_j^T and divided differences f[.,
// .]
//
//   tr f(C1) - tr f(C0) = G:(C1 - C0),   G = sym sum_ij f[a_i, b_j] (n_i.m_j) n_i m_j^T
//
// because n_i.(C1 - C0) m_j = (a_i - b_j) n_i.m_j and sum_j (n_i.m_j)^2 = 1.  Its derivative by C1 along x is sym sum_ijk f[a_i, a_k, b_j]
// (n_i.x n_k) (n_k.m_j) n_i m_j^T.  Powers of D = J^2 have quotients D[., .] likewise, products those of the rule of products.
#pragma once
#include <vector>

#include "physics/lane_functions.hpp"
#include "physics/material/dilatation.hpp"
#include "physics/material/material.hpp"

namespace hilo {

struct Ogden {
  static constexpr std::string_view name = "ogden", meaning = "rubber: Ogden, compressible, any number of terms";
  static std::vector<Param> keys() {
    return {{"mu", Type::numbers, "Pa", "!", "mu of each term; the shear modulus is their sum"},
            {"alpha", Type::numbers, "1", "!", "exponent of each term, not 0"},
            {"bulk", Type::number, "Pa", "!", "bulk modulus K (2/D1 of decks)", above(0)}};
  }
  static Ogden make(const MaterialValues& v);
  using Bulk = SquareOfDet;
  static constexpr double soft_below = 0;
  static constexpr std::string_view soft_because = "";

  struct Term {
    double mu, alpha;  // [Pa], [1]
  };
  std::vector<Term> terms;
  double K = 0;  // [Pa]

  double shear() const {
    double sum = 0;
    for (const Term& t : terms) sum += t.mu;
    return sum;
  }
  Lame linear() const { return {K - 2. / 3 * shear(), shear()}; }
  Ogden with_lambda(double lambda) const { return {terms, lambda + 2. / 3 * shear()}; }

  /// Of one cell; the vectors of cells go through these lane by lane.
  double energy_at(const double e[6]) const;
  void step(const double e0[6], const double e1[6], double s[6], double* D) const;  // D: by rows, set; or null

  template <class T>
  T energy(const T e[6]) const {
    T out = 0 * e[0];
    for (unsigned l = 0; l < sizeof(T) / sizeof(double); ++l) {
      double at[6];
      for (int i = 0; i < 6; ++i) at[i] = lane(e[i], l);
      lane(out, l) = energy_at(at);
    }
    return out;
  }
  template <class T>
  void stress(const T e0[6], const T e1[6], T s[6], T (*D)[6]) const {
    for (unsigned l = 0; l < sizeof(T) / sizeof(double); ++l) {
      double from[6], to[6], stress[6], slope[36];
      for (int i = 0; i < 6; ++i) from[i] = lane(e0[i], l), to[i] = lane(e1[i], l);
      step(from, to, stress, D ? slope : nullptr);
      for (int i = 0; i < 6; ++i) {
        lane(s[i], l) = stress[i];
        for (int j = 0; j < 6 && D; ++j) lane(D[i][j], l) += slope[6 * i + j];
      }
    }
  }
};

inline Ogden Ogden::make(const MaterialValues& v) {
  const std::vector<double> mu = v.numbers("mu"), alpha = v.numbers("alpha");
  if (mu.empty() || mu.size() != alpha.size()) v.refuse("mu", "mu and alpha have as many values, one of each for a term");
  Ogden out{{}, v.number("bulk")};
  for (size_t p = 0; p < mu.size(); ++p) {
    if (alpha[p] == 0) v.refuse("alpha", "an exponent of 0 makes no term");
    out.terms.push_back({mu[p], alpha[p]});
  }
  if (!(out.shear() > 0)) v.refuse("mu", "the sum of mu is the shear modulus and must be above 0");
  return out;
}

}  // namespace hilo
