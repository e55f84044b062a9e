// SPDX-License-Identifier: GPL-3.0-or-later
// GMRES preconditioned from the right, that keeps the preconditioned directions [saad-1993]: the residual it watches is that of the system
// itself, and the solution costs no further application.
#pragma once
#include <functional>
#include <span>
#include <vector>

namespace hilo {

class Gmres {
 public:
  using Map = std::function<void(const double* x, double* y)>;
  struct Report {
    int iterations = 0;
    double residual = 1;  // |W (b - A x)| / |W b| in the Euclidean norm, as the recurrence has it
  };
  /// x := about A^-1 b, started from zero.  `weight`: W, of each row, so that rows of different units count alike.
  Report solve(const Map& multiply, const Map& precondition, std::span<const double> weight, std::span<const double> b, std::span<double> x,
               double tolerance, int most_iterations);

 private:
  std::vector<std::vector<double>> basis_, directions_;
  std::vector<double> w_;
};

}  // namespace hilo
