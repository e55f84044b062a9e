// SPDX-License-Identifier: GPL-3.0-or-later
// All that a solid cell's strain does: its points, what they do not see (hourglass modes), and its mean dilatation.
#pragma once
#include "physics/hourglass.hpp"
#include "physics/hourglass20.hpp"
#include "physics/mean_dilatation.hpp"
#include "physics/shell.hpp"

namespace hilo {

/// Of a cell with the strains of its shape functions.
template <class S, class M, class T>
inline void evaluate_continuum(const M& law, const SolidCall<T>& call) {
  const Lame c = law.linear();
  using Bulk = typename M::Bulk;
  const double mean = mean_lambda<S, Bulk, Remembers<M>>(c);
  if (mean == 0) {
    evaluate_solid<S>(law, call);
  } else if constexpr (!std::is_same_v<Bulk, NoBulk>) {
    SolidCall<T> points = call;
    points.linear.lambda -= mean;
    points.mean = mean;
    if constexpr (Remembers<M>)
      evaluate_solid<S>(law, points);
    else
      evaluate_solid<S>(without_mean(law, mean), points);
    add_mean_dilatation<S, Bulk>(mean, call);
  }
  if constexpr (std::is_same_v<S, Hex8>) add_hourglass(moduli_of(law), call);
  if constexpr (std::is_same_v<S, Hex20R>) add_hourglass20(c, call);
}

/// Adds to f, K, energy, dissipated and lowers least_det; the caller clears them.
template <class S, class M, class T>
inline void evaluate_strain(const M& law, const SolidCall<T>& call) {
  if constexpr (is_shell<S>)
    add_shell<S>(law, call);
  else
    evaluate_continuum<S>(law, call);
}

}  // namespace hilo
