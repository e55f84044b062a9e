// SPDX-License-Identifier: GPL-3.0-or-later
// Iterations of BDDC and FETI-DP on a bar between two bodies, in irregular parts, several subdomains per rank:
//   mpirun -n 2 substructuring-bench NX NY NZ CFL KIND SUBDOMAINS [JUMP]
// SUBDOMAINS: of all ranks.  JUMP: in every other of as many regions, scattered without regard to the subdomains, the bar is so much
// stiffer.  Prints unknowns, iterations (of FETI-DP: of the solve with the flexible part that took most), megabytes of the solver on the
// first rank, and seconds.
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>

#include "../linear/problem.hpp"
#include "base/error.hpp"

using namespace hilo;
using namespace hilo::test;

int main(int argc, char** argv) {
  if (argc < 7) {
    fmt::print(stderr, "usage: mpirun -n N substructuring-bench NX NY NZ CFL KIND SUBDOMAINS [JUMP]\n");
    return 1;
  }
  Comm& comm = Comm::world();
  const int code = guarded("substructuring-bench", [&] {
    Problem p = elastic_bar(std::atoi(argv[1]), std::atoi(argv[2]), std::atoi(argv[3]), std::atof(argv[4]));
    const int subdomains = std::atoi(argv[6]);
    const double jump = argc > 7 ? std::atof(argv[7]) : 1;
    if (jump != 1) {
      scattered(p, subdomains);
      const auto matrix = p.matrix;
      const auto rank = p.rank;
      p.matrix = [=](int e) { return Matrix((matrix(e).rows() >= 12 && rank[e] % 2 ? jump : 1) * matrix(e)); };
    }
    scattered(p, comm.size);
    const auto solver = make_petsc_solver(argv[5], 1e-8, subdomains / comm.size);
    const Share share(p, comm.rank, comm.size);
    solver->structure(share.cliques, share.map);
    std::vector<double> x(3 * share.map.global.size());
    for (int k = 0; k < 2; ++k) {  // what took too many iterations is strengthened for the next matrix
      const auto start = std::chrono::steady_clock::now();
      share.fill(p, *solver, comm.rank, comm.size);
      const auto report = solver->solve(share.of(random_vector(p.size(), 3)), x);
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      const int iterations = report.most_within > 0 ? report.most_within : report.iterations;
      if (comm.rank == 0)
        fmt::print("{:4} subdomains {:3} ranks {:7} unknowns CFL {:6} jump {:6}: {} {:3} iterations{}, {:.0f} MB, {:.1f} s\n", subdomains,
                   comm.size, p.size(), argv[4], jump, solver->name(), iterations, report.ok ? "" : " FAILED", solver->bytes() / 1e6,
                   seconds.count());
      if (iterations <= 20) break;
    }
  });
  comm.finish();
  return code;
}
