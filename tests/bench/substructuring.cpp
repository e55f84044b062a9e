// Iterations of BDDC and FETI-DP on a bar between two bodies, one subdomain per rank, in irregular parts:
//   mpirun -n 16 substructuring-bench NX NY NZ CFL KIND [JUMP]
// JUMP: every other part is so much stiffer.  Prints ranks, unknowns, iterations, primal constraints' part of memory and seconds.
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>

#include "../linear/problem.hpp"
#include "base/error.hpp"

using namespace hilo;
using namespace hilo::test;

int main(int argc, char** argv) {
  if (argc < 6) {
    fmt::print(stderr, "usage: mpirun -n N substructuring-bench NX NY NZ CFL KIND [JUMP]\n");
    return 1;
  }
  Comm& comm = Comm::world();
  const int code = guarded("substructuring-bench", [&] {
    Problem p = elastic_bar(std::atoi(argv[1]), std::atoi(argv[2]), std::atoi(argv[3]), std::atof(argv[4]));
    const double jump = argc > 6 ? std::atof(argv[6]) : 1;
    scattered(p, comm.size);
    if (jump != 1) {
      const auto matrix = p.matrix;
      const auto rank = p.rank;
      p.matrix = [=](int e) { return Matrix((matrix(e).rows() >= 12 && rank[e] % 2 ? jump : 1) * matrix(e)); };
    }
    const auto solver = make_petsc_solver(argv[5], 1e-8);
    const Share share(p, comm.rank, comm.size);
    const auto start = std::chrono::steady_clock::now();
    solver->structure(share.cliques, share.map);
    share.fill(p, *solver, comm.rank, comm.size);
    std::vector<double> x(3 * share.map.global.size());
    const auto report = solver->solve(share.of(random_vector(p.size(), 3)), x);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    if (comm.rank == 0)
      fmt::print("{:4} ranks {:7} unknowns CFL {:6} jump {:6}: {} {} iterations{}, {:.1f} s\n", comm.size, p.size(), argv[4], jump,
                 solver->name(), report.iterations, report.ok ? "" : " FAILED", seconds.count());
  });
  comm.finish();
  return code;
}
