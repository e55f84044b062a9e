// SPDX-License-Identifier: GPL-3.0-or-later
// One solver on one matrix, of hilo or of PETSc (peers.hpp):
//   mpirun -n N linear-bench scene SCENE MESH STEP LOAD_TIME KIND TOLERANCE [SUBDOMAINS]
//   mpirun -n N linear-bench block EDGE CFL JUMP REGIONS KIND TOLERANCE [SUBDOMAINS]
// SUBDOMAINS: of all ranks, for kinds of hilo that divide a rank's part; one a rank unless said.  The matrix is given twice: the second
// time what took too many iterations is strengthened.  One line of CSV:
//   kind,ranks,subdomains,unknowns,fill,set_up,solve,iterations,residual,megabytes,name
// Seconds: of the processor, of the rank with most; of assembly into the solver's matrix, of the last set-up (columns of bodies included),
// and of a solve alone.  The residual is |b - A x|/|b| (Euclidean) by multiplication with the matrix assembled anew.  Megabytes: by which
// the peak of the rank with most grew over what it had before the solver was made.
#include <fmt/format.h>

#include <ctime>
#include <fstream>
#include <span>
#include <string>

#include "base/error.hpp"
#include "cases.hpp"
#include "linear/petsc/solver.hpp"
#include "peers.hpp"

namespace hilo::bench {
namespace {

/// Of the processor, so that what else runs hardly matters; a rank that waits for another spins, and that counts.
double now() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// "VmRSS" or "VmHWM" of this process [MB].
double memory(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == key + ":") {
      double kilobytes = 0;
      status >> kilobytes;
      return kilobytes / 1e3;
    }
  return 0;
}

/// The whole matrix in double precision, to multiply with.
class Whole final : public KktSolver {
 public:
  void structure(const Cliques& cliques, const BlockMap& map) override {
    cliques_ = &cliques;
    shared_.emplace(map);
    A_.emplace(cliques, map, *shared_, map.n_global);
  }
  void zero() override { A_->zero(); }
  void add(int clique, const double* K) override { A_->add(clique, (*cliques_)[clique], K); }
  void add_diagonal(int block, const double d[3]) override { A_->add_diagonal(block, d); }
  void sum_shared(std::span<double> local) override { shared_->sum(local); }
  SolveReport solve(std::span<const double>, std::span<double>, double) override { return {}; }
  std::string name() const override { return "whole"; }
  double residual(std::span<const double> b, std::span<const double> x) {
    A_->assemble();
    const PetscInt n = 3 * A_->n_owned();
    petsc::Vector b_own(n), x_own(n), r(n);
    petsc::to_owned(*shared_, b, b_own), petsc::to_owned(*shared_, x, x_own);
    double left, size;
    petsc::check(MatMult(A_->mat(), x_own, r));
    petsc::check(VecAYPX(r, -1, b_own));
    petsc::check(VecNorm(r, NORM_2, &left)), petsc::check(VecNorm(b_own, NORM_2, &size));
    return left / size;
  }

 private:
  const Cliques* cliques_ = nullptr;
  std::optional<petsc::SharedBlocks> shared_;
  std::optional<petsc::BlockMatrix> A_;
};

std::unique_ptr<KktSolver> make(const std::string& kind, double tolerance, int subdomains) {
  if (kind == "light" || kind == "cholesky") return make_light_solver(kind);
  if (kind == "direct") return petsc::make_direct(tolerance);
  const petsc::PetscKind* found = petsc::solver_kinds().find(kind);
  if (!found) found = find_peer(kind);
  if (!found) throw Error(kind, "no such kind", "", Exit::usage);
  return petsc::make_iterative(*found, tolerance, subdomains);
}

void run(std::span<const std::string> args, const Comm& comm) {
  const bool is_scene = args[0] == "scene";
  if ((!is_scene && args[0] != "block") || args.size() < (is_scene ? 7u : 7u)) throw Error(args[0], "scene or block", "", Exit::usage);
  Case c = is_scene ? scene_case(args[1], args[2], std::stod(args[3]), std::stod(args[4]), comm)
                    : block_case(std::stoi(args[1]), std::stod(args[2]), std::stod(args[3]), std::stoi(args[4]), comm);
  const std::string& kind = args[5];
  const double tolerance = std::stod(args[6]);
  const int subdomains = args.size() > 7 ? std::stoi(args[7]) : comm.size;
  petsc::start();
  const double before = memory("VmRSS");
  const auto solver = make(kind, tolerance, std::max(1, subdomains / comm.size));
  solver->structure(*c.cliques, *c.map);
  if (is_scene) solver->sum_shared(c.b);
  std::vector<double> x(c.b.size());
  double fill = 0, set_up = 0, solve = 0;
  SolveReport report;
  for (int k = 0; k < 2 && (k == 0 || report.ok); ++k) {
    const double set_up_before = solver->set_up_seconds(), start = now();
    c.fill(*solver);
    const double filled = now();
    report = solver->solve(c.b, x, tolerance);
    const double first = now();
    if (report.ok) report = solver->solve(c.b, x, tolerance);
    fill = filled - start, solve = now() - first;
    if (comm.max(solver->set_up_seconds() - set_up_before) > 0) set_up = std::max(0.0, first - filled - solve);
  }
  const double megabytes = comm.max(memory("VmHWM") - before);
  Whole whole;
  whole.structure(*c.cliques, *c.map);
  c.fill(whole);
  const double residual = whole.residual(c.b, x);
  const double seconds[] = {comm.max(fill), comm.max(set_up), comm.max(solve)};
  if (comm.rank == 0)
    fmt::print("{},{},{},{},{:.3f},{:.3f},{:.3f},{},{:.1e},{:.0f},{}{}\n", kind, comm.size, subdomains, 3 * c.map->n_global, seconds[0],
               seconds[1], seconds[2], report.most_within > 0 ? report.most_within : report.iterations, residual, megabytes, solver->name(),
               report.ok ? "" : " FAILED: " + report.message);
}

}  // namespace
}  // namespace hilo::bench

int main(int argc, char** argv) {
  hilo::Comm& comm = hilo::Comm::world();
  const std::vector<std::string> args(argv + 1, argv + argc);
  const int code = hilo::guarded("linear-bench", [&] {
    if (args.size() < 7) throw hilo::Error("", "see tests/bench/linear/main.cpp", "", hilo::Exit::usage);
    hilo::bench::run(args, comm);
  });
  if (comm.size > 1 && code != 0) comm.abort(code);
  comm.finish();
  return code;
}
