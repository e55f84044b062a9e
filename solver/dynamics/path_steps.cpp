// SPDX-License-Identifier: GPL-3.0-or-later
// The path of equilibrium under loads that grow and shrink: displacements z and the share p of the loads are found together, so that limits
// of loads and of displacements are passed [crisfield-1981, leon-2011].
//
//     R(q, lambda, p) = 0      t_z.z/u^2 + t_p p = 0   of every correction (z, p): at right angles to the way t ahead
//
// u is the size of the displacements that the whole load would make of the first tangent, or three times that of those so far, so the
// length of a step counts shares of loads and of these alike.  A correction is z = z_R + p z_p, with K z_R = -R and K z_p = -dR/dp by one
// factorization.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ranges>

#include "dynamics/jump.hpp"
#include "dynamics/linear_step.hpp"
#include "dynamics/run_parts.hpp"
#include "dynamics/start/held.hpp"
#include "dynamics/start/soft_contacts.hpp"
#include "dynamics/start/start.hpp"
#include "system/load_path.hpp"
#include "system/revising.hpp"
#include "system/touching.hpp"

namespace hilo {
namespace {

using Numbers = std::vector<double>;

/// Where the loads, or the displacements, turn back on the path; or where its stability changes between two states without that.
struct Turn {
  double share = 0;
  int step = 0;
  std::string kind;
};

Json as_json(const std::vector<Turn>& turns) {
  return Json::list_of(
      turns,
      [](const Turn& t) -> Json {
        return {{"kind", t.kind}, {"load", {t.share, 12}}, {"step", t.step}};
      },
      Json::In::lines);
}

class PathSteps final : public Steps {
 public:
  PathSteps(RunParts& run, Pause pause) : Steps(run, std::move(pause)), time_(run.scene.table("time")) {
    n_ = time_.number("steps");
    end_ = time_.has("end") ? time_.number("end") : 1;
    reach_ = time_.has("reach") ? time_.number("reach") : 0;
    at_.radius = std::sqrt(2.0) / n_;
  }

  void archive(Archive& a) override { a("path", at_, soft_.begins_soft); }

  void take() override {
    System& system = run_.system;
    State& state = run_.state;
    combine(none_, {{0, &system.start}});
    if (run_.report.steps == 0) {
      require_held(system, state.q, end_ / n_, 1 / n_, time_.where("analysis"));
      run_.audit->start(state);
      put_out({0, 1, 0}, [&] { record_rest(state, 0); });
      at_.before = state.q;
    }
    system.commit(state.q), system.settle(false);  // where the first step begins, also of a run that goes on
    Progress progress(run_.options.quiet || system.comm->rank != 0, 0, reach_ > 0 ? reach_ : 1);
    while (!at_.done) {
      std::string why;
      if (Point to; (why = step(to)).empty()) {
        accept(to);
      } else {
        give_up();
        if (at_.radius <= std::ldexp(std::sqrt(2.0) / n_, -run_.max_cuts - 4)) return run_.stop(why + unheld(system, system.start));
        at_.radius /= 4, ++run_.report.cuts;
        continue;
      }
      progress.show(reach_ > 0 ? moved(state.q) : at_.share, run_.report.steps, iterations_);
      if (!at_.done && run_.report.steps >= most_steps())
        why = fmt::format("{} states of equilibrium have not come to the whole load (they are at {:.4g} of it)", run_.report.steps,
                          at_.share);
      if (!at_.done && std::abs(at_.share) > 10)
        why = fmt::format("the path has ten times the whole load at a displacement of {:.4g} m, short of reach", moved(state.q));
      if (why.empty() && !at_.done) why = pause_();
      if (!why.empty()) {
        progress.done();
        return run_.stop(why);
      }
    }
    progress.done();
    run_.report.t = run_.report.steps;
    run_.report.table = table();
    run_.lists.emplace_back("turns", as_json(at_.turns));
    run_.report.complete = true;
  }

 private:
  /// A direction of the path: increments, their multipliers behind them, and the share of the loads.
  struct Way {
    Numbers z;
    double p = 0;
  };
  /// A state reached: the share of the loads, the rise of the path there, eigenvalues of the tangent below zero.
  struct Point {
    State state;
    PathPoint on;
    double so_far = 0;  // along the way
  };

  double most_steps() const { return 1000 + 200 * n_; }
  double moved(const Config& q) const { return run_.system.largest_difference(q, run_.system.start); }

  /// Increments as lengths, z.y; each block is counted on one rank.
  double dot(const Numbers& z, const Numbers& y) const {
    const System& s = run_.system;
    double sum = 0;
    for (const UnknownField& f : s.unknowns)
      for (size_t k = 0; k < f.size(); ++k)
        for (int i = 3 * f.block(k); i < 3 * f.block(k) + 3 && s.owns(f.block(k)); ++i) sum += z[i] * y[i] * f.scale(k) * f.scale(k);
    return s.comm->sum(sum);
  }
  double length(const Way& w) const { return std::sqrt(dot(w.z, w.z) / (at_.unit * at_.unit) + w.p * w.p); }

  Stage stage(const Config& q, double p) const {
    Stage s = stage_at(q, p * end_);
    s.a = &none_, s.load_factor = p, s.elapsed = slow;
    return s;
  }
  /// The residual at q, with what a law moves where it is under the share p; with a tangent the solver has it.
  void evaluate(const Config& q, const Numbers& lambda, double p, Residual& r, bool tangent, const Correction* last = nullptr) {
    Stage s = stage(q, p);
    s.last = last;
    assemble(run_.system, *run_.solver, s, lambda, r, tangent);
  }
  /// dR/dp, where the residual is r.
  Numbers by_load(const Config& q, const Numbers& lambda, double p, const Residual& r) {
    constexpr double little = 1e-6;
    Config nudged = q;
    run_.system.prescribe(nudged, (p + little) * end_, p + little), run_.system.place(nudged);
    Residual ahead;
    evaluate(nudged, lambda, p + little, ahead, false);
    for (size_t i = 0; i < r.r.size(); ++i) ahead.r[i] = (ahead.r[i] - r.r[i]) / little;
    return ahead.r;
  }
  /// K z = -r with the tangent evaluated last; false, and `why_`, where that fails.
  bool solve(const Numbers& r, Numbers& z) {
    const SolveReport solved = correct(*run_.solver, r, z);
    if (!solved.ok) why_ = run_.solver->name() + ": " + solved.message;
    return solved.ok;
  }

  /// Why the first tangent goes nowhere, where `pushes` is what the loads add to the residual.
  std::string moves_nothing(const Numbers& pushes) const {
    const double most = std::ranges::max(pushes | std::views::transform([](double x) { return std::abs(x); }));
    if (!(run_.system.comm->max(most) > 0)) return "nothing loads or moves the scene";
    return "the load moves nothing until it buckles: use analysis = \"buckling\", \"static\", or a small side load";
  }
  /// The way ahead of unit length: on from the state before, or by the first tangent.
  bool way_ahead(Way& way) {
    const State& state = run_.state;
    if (run_.report.steps > 0) {
      way = {Unknown(run_.system, at_.before, state.q).increments(run_.system), at_.share - at_.share_before};
      way.z.resize(3 * run_.system.n_blocks(), 0.0);
    } else {
      Residual r;
      evaluate(state.q, state.lambda, 0, r, true);
      const Numbers pushes = by_load(state.q, state.lambda, 0, r);
      if (!solve(pushes, way.z)) return false;
      if (const std::optional<int> below = run_.solver->eigenvalues_below_zero(run_.system.first_joint_block())) at_.below = *below;
      at_.unit = std::sqrt(dot(way.z, way.z)), way.p = 1;
      if (!(at_.unit > 0)) return why_ = moves_nothing(pushes), false;
      std::fill(way.z.begin() + 3 * run_.system.first_joint_block(), way.z.end(), 0.0);
    }
    if (run_.report.steps > 0) {
      Numbers far = Unknown(run_.system, run_.system.start, state.q).increments(run_.system);
      far.resize(way.z.size(), 0.0);
      at_.unit = std::max(at_.unit, 3 * std::sqrt(dot(far, far)));
    }
    const double size = length(way);
    if (!(size > 0)) return why_ = "the path has come to a stop", false;
    for (double& z : way.z) z /= size;
    way.p /= size;
    return true;
  }

  /// From the state along `way`, so far; corrections at right angles to `across`.  False, and `why_`.
  bool find(const Way& way, double so_far, const Way& across, Point& to) {
    System& system = run_.system;
    const State& from = run_.state;
    const NewtonOptions& options = run_.newton;
    double p = at_.share + so_far * way.p;
    Config guess = from.q;
    system.prescribe(guess, p * end_, p), system.place(guess);
    Unknown u(system, from.q, guess);
    Numbers lambda = from.lambda, z = way.z, by_share;
    for (double& x : z) x *= so_far;
    std::optional<Correction> foreseen;  // the last correction, to first order (physics/solid,
                                         // `foresee`), while corrections halve
    bool foresees = system.traits().deforms;
    const auto move = [&](const Numbers& by) {
      if (foresees) {
        foreseen.emplace(Correction{u.q, none_});
        system.add_rates(foreseen->along, u.q, by);
      }
      u.move(system, by);
    };
    move(z);
    const double unit2 = at_.unit * at_.unit;
    double last = 1e300;
    int revisions = 0, growths = 0;
    const auto is_settled = [&] {  // or what meets is chosen again by this answer
      constexpr int most_revisions = 6;
      if (revisions == most_revisions || !revise(system, stage(u.q, p))) return true;
      ++revisions, last = 1e300, foreseen.reset(), foresees = false;
      return false;
    };
    for (iterations_ = 0;; ++iterations_, ++run_.report.iterations) {
      Residual r;
      if (!foresees) foreseen.reset();
      evaluate(u.q, lambda, p, r, true, foreseen ? &*foreseen : nullptr);
      report_.least_det = r.least_det;
      if (r.least_det.det <= 0) return why_ = system.inside_out(r.least_det), false;
      report_.residual = system.comm->max(relative_residual(system, r));
      if (!std::isfinite(report_.residual)) return why_ = "the residual is not finite", false;
      if (iterations_ > 0 && (report_.residual <= options.tolerance || last <= 1e-2 * options.tolerance)) {
        if (is_settled()) break;
        continue;
      }
      if (iterations_ >= most_iterations * (1 + revisions)) return why_ = "no convergence within the iterations allowed", false;
      Numbers z_p;
      if (!solve(r.r, z) || !solve(by_load(u.q, lambda, p, r), z_p)) return false;
      const double slant = dot(across.z, z_p) + unit2 * across.p, dp = -dot(across.z, z) / slant;
      for (size_t i = 0; i < z.size(); ++i) z[i] += dp * z_p[i];
      to.on.rise = std::copysign(1 / std::sqrt(dot(z_p, z_p) / unit2 + 1), dot(way.z, z_p) + unit2 * way.p);
      const double moves = system.comm->max(relative_correction(system, z)), correction = std::max(moves, std::abs(dp));
      if (foreseen && !(correction <= 0.5 * last)) {
        foresees = false;
        continue;
      }
      // what is left is the round-off of positions, amplified by stiffness, which may be a large share of the small load of a thin part
      if (last < 1e-8 && correction > 0.2 * last && (report_.residual < 1e-6 || moves < 1e-12)) {
        if (is_settled()) break;
        continue;
      }
      const bool grows = !(correction <= 2 * last);
      if (!(correction <= options.reach) || (grows && ++growths > (touching(system) ? most_growths : 0)))
        return why_ = "the corrections grow", false;
      last = correction;
      p += dp;
      Config moved = u.q;
      system.prescribe(moved, p * end_, p), system.place(moved);
      u.start(system, from.q, moved), move(z);
      add_multipliers(system, r.sigma, z, lambda);
    }
    to.so_far = so_far, pace_ = iterations_;
    return look_at(u.q, lambda, p, to);
  }
  /// The state with q and lambda at the share p of the loads, its stability, and what the audit says; false, and `why_`.
  bool look_at(const Config& q, const Numbers& lambda, double p, Point& to) {
    System& system = run_.system;
    const State& from = run_.state;
    if (system.traits().slides) {  // friction fixed, as in dynamics/stability: the tangent is symmetric
      Stage s = stage(q, p);
      s.fixed_friction = true;
      Residual r;
      assemble(system, *run_.solver, s, lambda, r, true);
    }
    const std::optional<int> below = run_.solver->eigenvalues_below_zero(system.first_joint_block());
    to.on.share = p, to.on.below = below ? *below : std::nan("");
    State reached = from;
    reached.q = q, reached.lambda = lambda, reached.t = p * end_;
    to.state = std::move(reached);
    system.commit(to.state.q);
    taken_ = {stage(to.state.q, p), to.state.lambda};
    system.advance(taken_.stage);
    taken_.stage.work_from = &from.q;
    why_ = system.fault(to.state.q);
    if (why_.empty()) why_ = system.too_far(from.q, q);
    Taken before{stage(from.q, at_.share), from.lambda};
    before.stage.end = &to.state.q;
    if (why_.empty()) why_ = run_.audit->look(from.q, to.state, {&taken_, 1}, report_, p, {}, &before);
    return why_.empty();
  }
  /// Where points of contact come and go so that a step along the path does not converge: a load step, damped, and from soft contacts.
  bool find_by_loads(Point& to) {
    const double p = std::min(1.0, at_.share + at_.radius / std::sqrt(2.0));
    Config q;
    Numbers lambda;
    NewtonOptions options = run_.newton;
    options.least_share = 0.03;  // as load steps
    LoadStep step{run_.state.t, at_.share};
    const int before = run_.report.iterations;
    report_ = soft_.find(step, p * end_, p, options, q, lambda);
    iterations_ = run_.report.iterations - before;
    pace_ = most_iterations / 2;
    to.on.rise = at_.rise, to.so_far = at_.radius;
    if (!report_.converged) return why_ = report_.reason, false;
    const State& from = run_.state;
    if (BranchJump(run_.system, *run_.solver, run_.newton)
            .between({from.q, from.lambda, from.t, at_.share}, {q, lambda, p * end_, p}, step.foreseen, false) > 0)
      return why_ = "a load step jumps to another branch", false;
    Residual r;
    evaluate(q, lambda, p, r, true);
    return look_at(q, lambda, p, to);
  }
  void give_up() { run_.system.commit(run_.state.q), run_.system.settle(false); }

  /// The next state: at the radius, at the whole load where that is passed, or at a limit of the loads where one is.  Why not, or "".
  std::string step(Point& to) {
    search(0);
    Way way;
    if (!way_ahead(way)) return why_;
    if (!find(way, at_.radius, way, to)) {
      const bool grows = touching(run_.system) && reach_ == 0 && at_.share < 1 && at_.rise > 0;
      at_.turn.clear();
      return grows && find_by_loads(to) ? "" : why_;
    }
    at_.turn.clear();
    if (reach_ == 0 && at_.share < 1 && to.on.share >= 1) {  // the share is given
      give_up();
      const double ahead = (1 - at_.share) / (to.on.share - at_.share) * at_.radius;
      Way across{Numbers(way.z.size(), 0.0), 1};
      way.p = (1 - at_.share) / ahead;
      if (!find(way, ahead, across, to)) return why_;
      return changes(to) ? approach(way, ahead, across, to) : "";
    }
    if (at_.rise * to.on.rise < 0 && !at_.from_limit) return limit(way, to);
    at_.from_limit = false;
    return changes(to) ? approach(way, to.so_far, way, to) : "";
  }
  bool changes(const Point& to) const { return std::abs(to.on.below - at_.below) > 0 && !at_.after_turn; }

  /// Where stability changes without a limit, the state behind that, which is `whole` ahead in a plane across, is moved up to it: the
  /// nearest state behind that is found a second time.  Why not, or "".
  std::string approach(const Way& way, double whole, const Way& across, Point& to) {
    double near = 0;
    std::vector<double> behind{whole};
    for (int k = 0; k < 8; ++k) {
      const double so_far = (near + behind.back()) / 2;
      Point between;
      give_up();
      const bool found = find(way, so_far, way, between);
      if (found && between.on.rise * at_.rise < 0) break;
      if (found && changes(between))
        behind.push_back(so_far);
      else
        near = so_far;
    }
    for (; behind.size() > 1; behind.pop_back()) {
      give_up();
      if (find(way, behind.back(), way, to) && changes(to)) return "";
    }
    give_up();
    return find(way, whole, across, to) ? "" : why_;
  }

  /// The state where the share of the loads is largest or least, between here and one too far: where the rise is zero, by secants that keep
  /// it between two states.
  std::string limit(const Way& way, Point& to) {
    double near = 0, far = at_.radius, rise_near = at_.rise, rise_far = to.on.rise;
    for (int k = 0; k < 12; ++k) {
      const double share = std::clamp(rise_near / (rise_near - rise_far), 0.05, 0.95);
      const double so_far = near + share * (far - near);
      give_up();
      if (!find(way, so_far, way, to)) return why_;
      if (std::abs(to.on.rise) < 1e-4 || far - near < 1e-6 * at_.radius) break;
      if (to.on.rise * at_.rise > 0)
        near = so_far, rise_near = to.on.rise;
      else
        far = so_far, rise_far = to.on.rise;
    }
    at_.turn = at_.rise > 0 ? "maximum" : "minimum";
    at_.from_limit = true;
    return "";
  }

  void accept(Point& to) {
    System& system = run_.system;
    run_.audit->accept(run_.report.steps + 1);
    State label = to.state;
    label.t = run_.report.steps + 1;
    put_out(to.on, [&] { run_.recorder->step(label, run_.audit->ledger(), taken_, none_, iterations_); });
    system.settle(true);
    ++run_.report.steps;
    if (at_.turn.empty() && to.on.below != at_.below && std::isfinite(to.on.below) && !at_.after_turn)
      at_.turn = to.on.below > at_.below ? "branch" : "branch back";
    at_.after_turn = at_.turn == "maximum" || at_.turn == "minimum";
    if (!at_.turn.empty()) at_.turns.push_back({to.on.share, static_cast<int>(run_.report.steps), at_.turn});
    at_.before = run_.state.q, at_.share_before = at_.share;
    at_.share = to.on.share, at_.below = to.on.below;
    at_.rise = at_.from_limit ? -std::copysign(1e-300, at_.rise) : to.on.rise;
    std::swap(run_.state, to.state);
    at_.radius = std::min(std::sqrt(2.0) / n_, at_.radius * std::clamp(6.0 / std::max(1, pace_), 0.5, 2.0));
    at_.done = reach_ > 0 ? moved(run_.state.q) >= reach_ : at_.share >= 1 - 1e-12;
  }

  void put_out(const PathPoint& on, const std::function<void()>& record) {
    run_.system.part<LoadPath>().now = on;
    record();
  }

  std::string table() const {
    std::string out;
    for (const Turn& t : at_.turns)
      out += fmt::format("step {:4}: {} at {:.6g} of the loads\n", t.step,
                         t.kind == "maximum"   ? "largest load"
                         : t.kind == "minimum" ? "least load"
                         : t.kind == "branch"  ? "stability is lost"
                                               : "stability comes back",
                         t.share);
    return out;
  }

  static constexpr int most_iterations = 12;
  static constexpr int most_growths = 4;  // of corrections in one step: points of contact come and go
  const Entry& time_;
  double n_ = 1;                // states that the whole load would take along the first tangent
  double end_ = 1, reach_ = 0;  // time of the whole load [s]; displacement at which the path ends [m], 0: where it has the whole load
  struct Place {
    double share = 0, share_before = 0, rise = 1, radius = 1, unit = 1;
    double below = 0;  // eigenvalues
    bool done = false, from_limit = false, after_turn = false;
    Config before;  // of the state
    std::string turn;
    std::vector<Turn> turns;
  } at_;
  int iterations_ = 0, pace_ = 0;  // of the step tried last; as many as the length of the next one goes by
  SoftContacts soft_{run_};
  std::string why_;
  NewtonReport report_;
  Taken taken_;
  Config none_;  // no accelerations
};

}  // namespace

std::unique_ptr<Steps> path_steps(RunParts& run, Pause pause) { return std::make_unique<PathSteps>(run, std::move(pause)); }

}  // namespace hilo
