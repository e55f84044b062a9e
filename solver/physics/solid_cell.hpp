// All that a solid cell's strain does: its points, what they do not see (hourglass modes), and its mean dilatation.
#pragma once
#include "physics/hourglass.hpp"
#include "physics/hourglass20.hpp"
#include "physics/mean_dilatation.hpp"

namespace hilo {

/// Adds to f, K, energy, dissipated and lowers least_det; the caller clears them.  c are the moduli of the law.
template <class S, class Material, class T>
inline void evaluate_strain(const Lame& c, const SolidCall<T>& call) {
  const double mean = mean_lambda<S>(c);
  if (mean > 0) {
    SolidCall<T> points = call;
    points.linear.lambda -= mean;
    evaluate_solid<S>(Material{{c.lambda - mean, c.mu}}, points);
    add_mean_dilatation<S, Material>(mean, call);
  } else {
    evaluate_solid<S>(Material{c}, call);
  }
  if constexpr (std::is_same_v<S, Hex8>) add_hourglass(c, call);
  if constexpr (std::is_same_v<S, Hex20R>) add_hourglass20(c, call);
}

}  // namespace hilo
