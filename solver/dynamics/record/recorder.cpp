// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/record/recorder.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "dynamics/profile.hpp"
#include "system/resolved.hpp"

namespace hilo {

Recorder::Recorder(const System& system, const Scene& scene, Setup setup)
    : system_(system),
      scene_(scene),
      setup_(std::move(setup)),
      file_(*system.comm, setup_.path, setup_.single_precision),
      histories_(system) {
  if (setup_.redundant) share_.emplace(system);
  if (system.mesh) mesh_.emplace(system, file_, setup_.fields, setup_.skin, setup_.envelope);
}

void Recorder::first(const State& s, const Ledger& ledger, const Stage* there, std::span<const double> lambda) {
  Row row;
  row.t = s.t;
  std::optional<Moment> moment;
  std::vector<double> shared;
  if (there && share_) shared = (*share_)(*there, lambda);
  if (there) moment.emplace(system_, *there, lambda, setup_.redundant ? shared : lambda, there->a);
  Histories::Numbers numbers = histories_.numbers(s.t, s.q, s.v, ledger, moment ? &*moment : nullptr);
  row.point = std::move(numbers.end);
  if (there) there_ = Interval{.mid = std::move(numbers.mid), .a = *there->a};
  row.field = true;
  row.q = s.q, row.v = s.v, row.memory = system_.part<Solids>().memory();
  next_field_ = setup_.interval;
  rows_.push_back(std::move(row));
  last_t_ = s.t;
  open(false);
}

void Recorder::open(bool again) {
  if (again)
    file_.open([&](Store& f) {
      histories_.go_on(f, n_written_);
      if (mesh_) mesh_->shorten(f);
    });
  else
    file_.create();
  const std::vector<double> resolved = resolved_frequencies(system_);
  file_.on_store([&](Store& f) {
    declare_run(f, resolved), declare_bodies(f);
    if (!again) histories_.declare(f);
  });
  if (mesh_) mesh_->declare();
  file_.share_failure();
}

void Recorder::archive(Archive& a) {
  file_.keep_checkpoints();
  if (!a.restores() && n_written_ > 0) commit(RunOutput::When::now_safe);
  double interval = setup_.interval;
  a("recorder", rows_, intervals_, past_, n_written_, last_t_, next_field_, interval);
  if (interval != setup_.interval && setup_.interval > 0)
    next_field_ = setup_.interval * (std::floor(last_t_ * (1 + 1e-9) / setup_.interval) + 1);
  if (a.restores())
    for (Row& row : rows_) row.jump = is_jump(row.t), row.field = row.field && !row.last;  // at what was the end there was none
  if (mesh_) mesh_->archive(a);
  if (share_) share_.emplace(system_);  // its factors are made anew on either side
  if (a.restores()) open(n_written_ > 0);
}

bool Recorder::is_jump(double t) const {
  return std::ranges::any_of(setup_.jumps, [&](double at) { return std::abs(at - t) <= 1.001 * system_.same_time; });
}

void Recorder::step(const State& s, const Ledger& ledger, const Taken& taken, const Config& a, int iterations, const Config* shown) {
  const Timed timed(phases().output);
  const Config& v = shown ? *shown : s.v;
  ++phases().records;
  Interval interval;
  interval.h = s.t - last_t_;
  std::vector<double> shared;
  if (share_) shared = (*share_)(taken.stage, taken.lambda);
  const std::span<const double> lambda = taken.lambda;
  const Moment moment(system_, taken.stage, lambda, setup_.redundant ? shared : lambda, &a);
  Histories::Numbers numbers = histories_.numbers(s.t, s.q, v, ledger, &moment);
  interval.mid = std::move(numbers.mid);
  interval.a = a;
  interval.starts_at_jump = !rows_.empty() && rows_.back().jump;
  intervals_.push_back(std::move(interval));
  Row row;
  row.t = s.t;
  row.newton = iterations, last_t_ = s.t;
  row.point = std::move(numbers.end);
  row.jump = is_jump(s.t);
  const bool due = setup_.is_static || s.t >= next_field_ * (1 - 1e-9);
  if (due && setup_.interval > 0) next_field_ = setup_.interval * (std::floor(s.t * (1 + 1e-9) / setup_.interval) + 1);
  row.last = !due && s.t >= setup_.end - system_.same_time, row.field = due || row.last;
  if (row.field || setup_.envelope) row.q = s.q, row.v = v, row.memory = system_.part<Solids>().memory();
  rows_.push_back(std::move(row));
  advance(false);
  commit(RunOutput::When::now_and_then);
}

/// What was written becomes safe: the first rows at once, others after a while, or now.
void Recorder::commit(RunOutput::When when) {
  file_.share_failure();
  if (n_written_ == 0) return;
  if (file_.commit(when) && mesh_) mesh_->show();
  if (when != RunOutput::When::now_and_then) file_.share_failure();
}

/// Write every row whose neighbouring steps are known.  Mid values belong to their own time in the step and are interpolated to its ends.
void Recorder::advance(bool last) {
  const double own = setup_.own_time;
  const size_t from_right = n_extrapolated();
  const auto ready = [&] {  // row 0 of the deque
    if (rows_.empty()) return false;
    if (last || setup_.is_static) return true;
    if (n_written_ == 0) return there_ || intervals_.size() >= from_right;
    return intervals_.size() >= (rows_[0].jump ? 1 + from_right : own == 1 ? 1 : 2);
  };
  while (ready()) {
    // in the deque, intervals_[0] ends at rows_[0] once the first row is out, else it starts there
    const size_t after = n_written_ > 0;
    const bool has_before = n_written_ > 0 && !intervals_.empty(), has_after = intervals_.size() > after;
    if (n_written_ == 0 && there_) {
      write_row({{1, &*there_}});
    } else if (has_before && (own == 1 || has_after) && (!rows_[0].jump || setup_.is_static)) {
      const double before = (1 - own) * intervals_[0].h, behind = own == 1 ? 1 : own * intervals_[1].h;
      write_row({{behind / (before + behind), &intervals_[0]}, {before / (before + behind), &intervals_[own == 1 ? 0 : 1]}});
    } else if (has_after && !setup_.is_static) {
      std::vector<const Interval*> next{&intervals_[after]};
      for (size_t k = after + 1; k < intervals_.size() && !intervals_[k].starts_at_jump && next.size() < from_right; ++k)
        next.push_back(&intervals_[k]);
      write_row(extrapolated(next, true));
    } else if (has_before) {  // the end: from the left, with the intervals kept for it
      std::vector<const Interval*> next{&intervals_[0]};
      for (size_t k = past_.size(); k-- > 0 && !next.back()->starts_at_jump;) next.push_back(&past_[k]);
      write_row(extrapolated(next, false));
    } else {
      write_row({});
    }
    rows_.pop_front();
    if (n_written_ > 0) {
      past_.push_back(std::move(intervals_.front())), intervals_.pop_front();
      if (past_.size() >= n_extrapolated()) past_.pop_front();
    }
    ++n_written_;
    if (rows_.empty()) return;
  }
}

/// Value at the outer end of the first of neighbouring intervals: weights by which what is constant or linear in time comes out right, what
/// alternates from step to step falls out, and what is of the second degree comes out right too.
std::vector<std::pair<double, const Recorder::Interval*>> Recorder::extrapolated(const std::vector<const Interval*>& m,
                                                                                 bool from_right) const {
  const auto n = static_cast<Eigen::Index>(std::min(m.size(), n_extrapolated()));
  const double own = from_right ? setup_.own_time : 1 - setup_.own_time;  // distance from the outer end, in steps
  Eigen::MatrixXd A(n, n);
  double distance = 0;  // in units of the first step
  for (Eigen::Index k = 0; k < n; ++k) {
    const double h = m[k]->h / m[0]->h, d = distance + own * h;
    distance += h;
    for (Eigen::Index i = 0; i < n; ++i) A(i, k) = i < 2 ? std::pow(d, i) : i == 2 && setup_.alternates ? (k % 2 == 0 ? 1 : -1) : d * d;
  }
  const Eigen::VectorXd w = A.fullPivLu().solve(Eigen::VectorXd::Unit(n, 0));
  std::vector<std::pair<double, const Interval*>> out;
  for (Eigen::Index k = 0; k < n; ++k) out.emplace_back(w[k], m[k]);
  return out;
}

/// Row 0 of the deque with the weighted sum of intervals as its mid-step values; zeros where there are none.
void Recorder::write_row(const std::vector<std::pair<double, const Interval*>>& weights) {
  const Row& row = rows_[0];
  std::vector<double> mid(histories_.n_mid(), 0.0);
  for (const auto& [w, interval] : weights)
    for (size_t i = 0; i < mid.size(); ++i) mid[i] += w * interval->mid[i];
  if (std::ranges::any_of(weights, [](const auto& of) { return of.first < 0; })) {
    std::vector<const std::vector<double>*> all;
    for (const auto& of : weights) all.push_back(&of.second->mid);
    histories_.hold(mid, all);
  }
  if ((row.field || setup_.envelope) && mesh_) {
    Config a, sum;
    combine(a, {{0, &row.q}});
    for (const auto& [w, interval] : weights) combine(sum, {{1, &a}, {w, &interval->a}}), std::swap(a, sum);
    const Snapshot at{row.q, row.v, a, row.memory.batch};
    if (setup_.envelope) mesh_->envelop(row.t, at);
    try {
      if (row.field) mesh_->write(row.t, at);
    } catch (const Error& e) {  // sources of fields know no scene
      if (e.where != "output.fields") throw;
      throw Error(scene_.table("output").where("fields"), e.message, e.hint, e.exit);
    }
  }
  file_.on_store([&](Store& f) { histories_.append(f, row.t, row.newton, row.point, mid); });
}

void Recorder::finish(bool complete) {
  advance(true);
  file_.on_store([&](Store& f) { f.set("/", "complete", static_cast<std::int64_t>(complete)); });
  if (mesh_) mesh_->write_envelope();
  commit(RunOutput::When::now);
  if (mesh_) mesh_->finish(true);
  file_.share_failure();
  file_.close();
}

void Recorder::give_up() {
  const bool alone = system_.comm->size == 1;
  if (n_written_ > 0 && alone) file_.on_store([](Store& f) { f.flush(); });
  if (n_written_ > 0 && mesh_) mesh_->finish(alone);
  file_.close();
}

}  // namespace hilo
