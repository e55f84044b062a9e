// SPDX-License-Identifier: GPL-3.0-or-later
// An analysis of buckling: the drawn state, and then a row of the results for every shape in which it gives way, at a factor l of its
// loads:
//
//   (K + l K') x + G^T mu = 0,   G x = 0,   x_i^T K x_j = delta_ij
//
// with K the stiffness of the drawn state, and K' what stresses, forces of joints and loads that follow add to it there as the loads grow:
// a difference between the stresses at two states along the first displacement under the loads.
#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/table.hpp"
#include "dynamics/modes/linearized.hpp"
#include "dynamics/modes/natural_modes.hpp"
#include "dynamics/run_parts.hpp"
#include "dynamics/start/held.hpp"
#include "dynamics/start/start.hpp"
#include "linear/block_csr.hpp"
#include "linear/block_krylov.hpp"
#include "physics/material/materials.hpp"
#include "system/buckling_modes.hpp"
#include "system/linear_regions.hpp"

namespace hilo {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

struct FoundShape {
  BucklingMode figures;
  Vector x;                // increments of the unknowns, of unit strain energy times two
  std::vector<double> mu;  // multipliers, laid out like State::lambda
};

/// A stiffness that is not solved with.
class Stiffness final : public KktSolver {
 public:
  Stiffness(const System& system, const Stage& s, const std::vector<double>& lambda) : system_(system) {
    structure(system.layout.cliques, system.layout.map);
    A_.zero();
    Residual r;
    system.evaluate(s, lambda, r, this);
  }
  /// Forces on what no law moves, by the matrix or by its transpose.
  Vector times(const Vector& x, bool transposed = false) const {
    std::vector<double> z(static_cast<size_t>(A_.n()), 0.0), y(z.size(), 0.0);
    std::ranges::copy(x, z.begin());
    const auto &start = A_.row_start(), &column = A_.column();
    for (size_t i = 0; i < y.size(); ++i)
      for (int k = start[i]; k < start[i + 1]; ++k) {
        const auto at = static_cast<size_t>(k), j = static_cast<size_t>(column[at]);
        y[transposed ? j : i] += A_.values()[at] * z[transposed ? i : j];
      }
    system_.mask_fixed(y);
    return Eigen::Map<const Vector>(y.data(), x.size());
  }

  void subtract(const Stiffness& other) { A_.subtract(other.A_); }

  void structure(const Cliques& cliques, const BlockMap& map) override { A_.structure(cliques, static_cast<int>(map.global.size())); }
  void zero() override { A_.zero(); }
  void add(int clique, const double* K) override { A_.add(clique, K); }
  void add_diagonal(int block, const double d[3]) override { A_.add_diagonal(block, d); }
  void sum_shared(std::span<double>) override {}
  SolveReport solve(std::span<const double>, std::span<double>, double) override { return {.ok = false, .message = "it has no factors"}; }
  std::string name() const override { return "a stiffness"; }

 private:
  const System& system_;
  BlockCsr A_;
};

/// What stresses of a share of the loads add to the stiffness of the drawn state, by two stiffnesses: K1 at the state d under that share,
/// and K2 with respect to the end of a step that begins at d/(1 - w) and ends as drawn, with strains and gradients at its part w, which is
/// d. With gradients G and moduli D,
///
///   K1 = K + S + d(G)^T D G + G^T D d(G),   K2 = w (K + S + d(G)^T D G),   S = (K2 + K2^T)/w - K1 - K
///
/// S has no displacements: to first order, stiff parts that turn would seem to lose the stiffness across that is small beside.  Strains
/// that are not of the second degree in the points (beams, springs) have their slopes from the right at the end: those at d would bring
/// displacements back.
class Stressed {
 public:
  Stressed(const System& system, const State& drawn, const State& far, double share)
      : near_(mixed({{1 - w, &far.q}, {w, &drawn.q}})), from_(far.q), to_(drawn.q), none_(mixed({{0, &drawn.q}})), lambda_(drawn.lambda) {
    from_.eta = to_.eta = near_.eta;  // modes turn with their region, so that all that they change is S
    for (size_t i = 0; i < lambda_.size(); ++i) lambda_[i] += (1 - w) * (far.lambda[i] - drawn.lambda[i]);
    Stage s = stage_at(near_, drawn.t);
    s.a = &none_, s.load_factor = (1 - w) * share;
    whole_.emplace(system, s, lambda_);
    s.end = &drawn.q, s.e0 = &from_, s.e1 = &to_, s.slope = s.weight = w, s.slopes_of_end = true;
    half_.emplace(system, s, lambda_);
  }
  static constexpr double w = 0.25;
  /// Entry by entry, before products round what is nearly alike.
  void subtract(const Stressed& other) { whole_->subtract(*other.whole_), half_->subtract(*other.half_); }
  /// K + S, of its symmetric part.
  Vector times(const Vector& x) const {
    return (half_->times(x) + half_->times(x, true)) / w - (whole_->times(x) + whole_->times(x, true)) / 2;
  }
  /// What is not symmetric.
  Vector skew(const Vector& x) const { return (whole_->times(x) - whole_->times(x, true)) / 2; }

 private:
  static Config mixed(std::initializer_list<std::pair<double, const Config*>> of) {
    Config out;
    combine(out, of);
    return out;
  }
  Config near_, from_, to_, none_;
  std::vector<double> lambda_;
  std::optional<Stiffness> whole_, half_;
};

/// The drawn state, and the way it first takes under all of the loads.
class Loaded {
 public:
  Loaded(const System& system, KktSolver& solver, const State& drawn, const std::string& where)
      : system_(system), drawn_(drawn), base_(system, solver, drawn, 0) {
    base_.factor(0);
    const Vector loads = base_.loads();
    if (loads.cwiseAbs().maxCoeff() == 0) throw Error(where, "no load grows: there is no buckling", "give a [[load]] or gravity");
    first_ = solved(loads, &mu_);
    way_ = way(first_);
    share_ = 1e-4 * system.length / std::max(1e-300, way_);
  }

  /// The `wanted` shapes whose factors are smallest in size, or all there are.
  std::vector<FoundShape> shapes(int wanted, const std::string& where, const std::function<void(int)>& tell) {
    Config none;
    combine(none, {{0, &drawn_.q}});
    Stage s0 = stage_at(drawn_.q, drawn_.t);
    s0.a = &none, s0.load_factor = 0;
    const Stiffness K(system_, s0, drawn_.lambda);
    Stressed stressed(system_, drawn_, along(share_), share_);
    stressed.subtract(Stressed(system_, drawn_, along(-share_), -share_));
    const double apart = 2 * (1 - Stressed::w) * share_;
    const auto change = [&](const Vector& x) { return Vector(stressed.times(x) / apart); };
    const auto by_columns = [](const Matrix& X, auto&& product) {
      Matrix out(X.rows(), X.cols());
      for (Eigen::Index j = 0; j < X.cols(); ++j) out.col(j) = product(Vector(X.col(j)));
      return out;
    };
    const auto stiffness = [&](const Vector& x) { return K.times(x); };
    const auto answer = [&](const Vector& force) { return Vector(-solved(change(solved(force)))); };
    const Pencil pencil{base_.n(), [&](const Matrix& X) { return by_columns(X, stiffness); },
                        [&](const Matrix& X) { return by_columns(X, answer); }, 0};
    const Eigenmodes found = lowest_modes(pencil, wanted, 1e-6, true, tell);
    if (!found.converged)
      throw Error(where, fmt::format("{} shapes were not found", wanted), "ask for fewer: time.modes", Exit::not_converged);
    std::vector<FoundShape> out;
    for (Eigen::Index j = 0; j < found.omega2.size(); ++j) {
      const double factor = found.omega2[j];
      if (!(std::abs(factor) * way_ < 10 * system_.length)) continue;  // of rounding
      const Vector x = found.shapes.col(j);
      FoundShape& s = out.emplace_back();
      const Vector again = solved(-factor * change(x), &s.mu), left = again - x;
      s.figures.factor = factor, s.x = x;
      s.figures.error = std::sqrt(std::abs(left.dot(K.times(left))));
    }
    // loads that follow are symmetric but for free rims and their cells: the other part changes factors by its square
    double skew = 0, all = 0;
    for (const FoundShape& a : out) {
      const Vector of_skew = stressed.skew(a.x) / apart, of_all = change(a.x);
      for (const FoundShape& b : out) skew = std::max(skew, std::abs(b.x.dot(of_skew))), all = std::max(all, std::abs(b.x.dot(of_all)));
    }
    if (skew > 0.05 * all)
      throw Error(where, "the change of the forces has no potential, as under a force that follows a free end: there are no such factors",
                  "a run in time shows whether it flutters");
    std::ranges::stable_sort(out, {}, [](const FoundShape& s) { return std::abs(s.figures.factor); });
    for (size_t k = 1; k < out.size(); ++k)  // of a factor of either sign, as in bending, the loads as given come first
      if (const double before = out[k - 1].figures.factor, after = out[k].figures.factor;
          before < 0 && after < -before * (1 + 1e-6) && after > 0)
        std::swap(out[k - 1], out[k]);
    return out;
  }

 private:
  Vector solved(const Vector& force, std::vector<double>* mu = nullptr) const {
    Vector x;
    base_.solve(force, x, mu);
    return x;
  }
  double way(const Vector& x) const { return system_.largest_rate(base_.rates_of(x)); }
  /// The state at this share of the loads, were all linear.
  State along(double share) const {
    State at = drawn_;
    std::vector<double> z(3 * static_cast<size_t>(system_.n_blocks()), 0.0);
    for (Eigen::Index i = 0; i < first_.size(); ++i) z[static_cast<size_t>(i)] = share * first_[i];
    system_.move(at.q, z);
    for (size_t i = 0; i < mu_.size(); ++i) at.lambda[i] += share * mu_[i];
    return at;
  }

  const System& system_;
  const State& drawn_;
  Linearized base_;
  Vector first_;  // displacement under all of the loads, by K
  std::vector<double> mu_;
  double way_ = 0, share_ = 1;  // of the first displacement [m]; of the loads, between states whose stiffness is compared
};

/// To rest without the loads: what is stressed as drawn, as preloaded springs, gives joints and cells the forces that balance it.
void put_to_rest(System& system, KktSolver& solver, State& drawn, const std::string& where) {
  constexpr int passes = 10;
  double last = 1e-4 * system.length;
  for (int pass = 0; pass < passes; ++pass) {
    Linearized base(system, solver, drawn, 0);
    base.factor(0);
    Vector x;
    std::vector<double> mu;
    base.solve(base.forces(), x, &mu);
    const double away = system.largest_rate(base.rates_of(x));
    if (!(away < last))
      throw Error(where, fmt::format("the drawn state is not at rest without the loads: it moves by about {:.2g} m", away),
                  "leave out what is stressed as drawn, or use analysis = \"path\"");
    std::vector<double> z(3 * static_cast<size_t>(system.n_blocks()), 0.0);
    std::ranges::copy(x, z.begin());
    system.move(drawn.q, z);
    for (size_t i = 0; i < mu.size(); ++i) drawn.lambda[i] += mu[i];
    if (away < 1e-10 * system.length) break;
    last = away;
  }
  system.commit(drawn.q);
}

Json as_json(const std::vector<FoundShape>& shapes) {
  return Json::list_of(
      shapes,
      [](const FoundShape& s) -> Json {
        return {{"factor", {s.figures.factor, 12}}, {"error", {s.figures.error, 3}}};
      },
      Json::In::lines);
}
std::string as_table(const std::vector<FoundShape>& shapes) {
  std::string out = "shape  factor of the loads\n";
  for (size_t k = 0; k < shapes.size(); ++k)
    out += fmt::format("{:5}  {:19.6g}{}\n", k + 1, shapes[k].figures.factor, shapes[k].figures.factor < 0 ? "  (loads reversed)" : "");
  return out;
}

class BucklingSteps final : public Steps {
 public:
  BucklingSteps(RunParts& run, Pause pause) : Steps(run, std::move(pause)), time_(run.scene.table("time")) {
    if (run.system.comm->size > 1) throw Error(time_.where("analysis"), "buckling is found on one rank", "run it without mpirun");
    if (time_.text("start") == "equilibrium")
      throw Error(time_.where("start"), "loads that buckle grow from the drawn state", "leave out time.start, or use analysis = \"path\"");
    for (const Entry& e : run.scene.entries("motion"))
      if (e.kind != "fixed")
        throw Error(e.place.text(), fmt::format("motion \"{}\": buckling knows loads alone", e.text("name")),
                    "give the load instead, or use analysis = \"path\"");
  }
  void archive(Archive&) override {}  // one step, so nothing is kept within it

  void take() override {
    System& system = run_.system;
    State& drawn = run_.state;
    const std::string where = time_.where("analysis");
    drawn.t = time_.has("end") ? time_.number("end") : 1;  // histories have their values at the end
    set_rows(system, run_.redundancy.at_pose);
    if (system.violation(drawn.q, drawn.t).worst() > 1e-6 * system.length)
      throw Error(where, "a drive moves its joint by the end: buckling knows loads alone",
                  "leave out the drive, or use analysis = \"path\"");
    for (const Entry& m : run_.scene.entries("material"))
      if (system.traits().remembers && material_kinds().at(m.kind).n_state > 0)
        throw Error(m.place.text(), fmt::format("material \"{}\" is plastic: buckling knows elastic laws", m.name),
                    "kind = \"stvk\", or analysis = \"path\"");
    require_held(system, drawn.q, drawn.t, 1, where);
    system.commit(drawn.q);
    for (const LinearRegion& r : system.part<LinearRegions>().regions) require_stiffening(system.modes[static_cast<size_t>(r.modes)]);
    put_to_rest(system, *run_.solver, drawn, where);
    run_.audit->start(drawn);
    record_rest(drawn, 0);
    Progress progress(run_.options.quiet, 0, time_.number("modes"));
    const std::vector<FoundShape> shapes =
        Loaded(system, *run_.solver, drawn, where).shapes(static_cast<int>(time_.number("modes")), where, [&](int found) {
          progress.show(found, 0, 0);
        });
    progress.done();
    if (shapes.empty())
      throw Error(where, "nothing buckles under these loads",
                  "linear regions stay straight without stiffening = true; tension alone buckles nothing");
    for (const FoundShape& s : shapes) record(s);
    run_.lists.emplace_back("load_factors", as_json(shapes));
    run_.report.table = as_table(shapes);
    run_.report.t = static_cast<double>(shapes.size());
    for (const FoundShape& s : shapes)
      if (!(s.figures.error < most_error))
        return run_.stop(fmt::format("the shape at {:.6g} of the loads leaves {:.2g} of the equations", s.figures.factor, s.figures.error));
    run_.report.complete = true;
  }

 private:
  /// Modes whose stresses change no stiffness make factors too large: the scene must say that it wants them.
  void require_stiffening(const Modes& m) const {
    if (m.n_modes == 0 || m.stiffens) return;
    const std::string& name = run_.system.bodies[m.body].name;
    const std::string what = fmt::format("linear region \"{}\": its stresses change no stiffness, so factors are too large", name);
    const auto says_so = [&](const Entry& e) { return e.given("stiffening") && fnmatch(e.name.c_str(), name.c_str(), 0) == 0; };
    if (m.of_beams || std::ranges::none_of(run_.scene.entries("region"), says_so))
      throw Error(time_.where("analysis"), what,
                  fmt::format("{}{}", m.better(), m.of_beams ? "" : "; stiffening = false takes it as it is"));
    warn(time_.where("analysis"), what);
  }

  /// The shape, of a hundred thousandth of the scene at most, on the drawn state, with the forces that it makes.
  void record(const FoundShape& s) {
    System& system = run_.system;
    const State& drawn = run_.state;
    State at = drawn;
    at.t = static_cast<double>(run_.report.steps + 1);
    Config zero, rate;
    combine(zero, {{0, &drawn.q}});
    rate = zero;
    std::vector<double> z(3 * static_cast<size_t>(system.n_blocks()), 0.0);
    std::ranges::copy(s.x, z.begin());
    system.add_rates(rate, drawn.q, z);
    const double amplitude = 1e-5 * system.length / std::max(1e-300, system.largest_rate(rate));
    for (double& value : z) value *= amplitude;
    system.move(at.q, z);
    for (size_t i = 0; i < s.mu.size(); ++i) at.lambda[i] += amplitude * s.mu[i];
    Taken taken{stage_at(at.q, drawn.t), at.lambda};
    taken.stage.a = &zero, taken.stage.load_factor = 0;
    system.part<BucklingModes>().now = s.figures;
    Ledger ledger = run_.audit->ledger();
    ledger.energy = system.energy(at.q, at.v);
    ledger.rows = system.violation(at.q, drawn.t);
    run_.recorder->step(at, ledger, taken, zero, 0);
    ++run_.report.steps;
  }

  const Entry& time_;
};

}  // namespace

std::unique_ptr<Steps> buckling_steps(RunParts& run, Pause pause) { return std::make_unique<BucklingSteps>(run, std::move(pause)); }

}  // namespace hilo
