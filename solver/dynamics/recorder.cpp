#include "dynamics/recorder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "dynamics/profile.hpp"
#include "model/schema.hpp"
#include "system/bodies.hpp"

namespace hilo {
std::string stem(const std::string& path) { return path.ends_with(".h5") ? path.substr(0, path.size() - 3) : path; }

Recorder::Recorder(const System& system, const Scene& scene, Setup setup)
    : system_(system), scene_(scene), setup_(std::move(setup)), share_(system) {
  for (const auto& part : system.parts())
    for (Output& output : part->outputs()) {
      n_mid_ += static_cast<size_t>(output.n_mid);
      outputs_.push_back(std::move(output));
    }
}

/// What belongs to an instant: energies, momentum, violation, and what the contributions have to say.
std::vector<double> Recorder::point_values(const State& s, const Ledger& ledger) {
  const Energy& e = ledger.energy;
  last_t_ = s.t;
  std::vector<double> v{e.kinetic, e.elastic, e.gravity, ledger.work, ledger.dissipated, ledger.balance};
  for (int i = 0; i < 3; ++i) v.push_back(e.momentum[i]);
  for (int i = 0; i < 3; ++i) v.push_back(e.angular[i]);
  v.push_back(ledger.rows.worst());
  for (const auto& part : system_.parts()) part->add_end_values(s.q, s.v, v);
  return v;
}

/// What belongs inside a step: reactions, accelerations of stations.
std::vector<double> Recorder::mid_values(const Stage& stage, std::span<const double> lambda, const Config& a) {
  std::vector<double> full;
  if (setup_.redundant) full = share_(stage, lambda);
  const Moment moment(system_, stage, lambda, setup_.redundant ? full : lambda, &a);
  std::vector<double> v;
  for (const auto& part : system_.parts()) part->add_mid_values(moment, v);
  return v;
}

/// What a rank alone does and may fail at (a full disk) is noted here and told to all ranks by share_failure.
void Recorder::on_store(const std::function<void(Store&)>& write) {
  if (!store_ || failure_) return;
  try {
    write(*store_);
  } catch (const Error& e) {
    failure_ = e;
  }
}

void Recorder::share_failure() const {
  system_.comm->together([&] {
    if (failure_) throw *failure_;
  });
}

void Recorder::declare() {
  system_.comm->together([&] {
    if (system_.comm->rank != 0) return;
    store_ = std::make_unique<Store>(Store::create_growing(setup_.path));
    for (const char* of_former : {".xdmf", ".json"}) ::unlink((stem(setup_.path) + of_former).c_str());  // they told of the file replaced
  });
  on_store([&](Store& f) { declare_arrays(f); });
}

void Recorder::declare_arrays(Store& f) {
  f.set("/", "format", std::string("hilo run"));
  f.set("/", "version", std::int64_t{1});
  f.set("/", "complete", std::int64_t{0});
  f.write_strings("/provenance", setup_.provenance);
  f.write_text("/scene", scene_.text);
  f.set("/", "title", scene_.table("scene").has("title") ? scene_.table("scene").text("title") : std::string());
  if (system_.mesh) {
    const LocalMesh& m = *system_.mesh;
    f.link("/mesh", m.file, "/mesh");
    std::vector<std::string> words;
    for (Fidelity level : m.fidelity) words.emplace_back(word(level));
    f.write_strings("/tags/fidelity", words);
  }
  std::vector<std::string> names;
  std::vector<double> points, mass, inertia;
  for (size_t b = 1; b < system_.bodies.size(); ++b) {
    const Body& body = system_.bodies[b];
    names.push_back(body.name);
    for (const Vec3& arm : body_arms(body)) {
      const Vec3 x = body.Xc + arm;
      points.insert(points.end(), x.data(), x.data() + 3);
    }
    mass.push_back(body.mass);
    const Vec3 e = Eigen::SelfAdjointEigenSolver<Mat3>(body.J.trace() * Mat3::Identity() - body.J).eigenvalues();
    inertia.insert(inertia.end(), e.data(), e.data() + 3);
  }
  const auto n_bodies = static_cast<std::int64_t>(names.size());
  if (n_bodies > 0) {
    f.write_strings("/body/name", names);
    f.write<double>("/body/points", points, {n_bodies, 4, 3}, "m", "reference positions of the points of each body");
    f.write<double>("/body/mass", mass, {n_bodies}, "kg");
    f.write<double>("/body/inertia", inertia, {n_bodies, 3}, "kg m^2", "principal moments");
  }
  const std::string at = "/history/t";
  const auto start = [&]<class T>(const std::string& path, T) {
    const ArraySchema& of = run_array(path);
    f.start_rows<T>(path, row_shape(of), std::string(of.unit), std::string(of.meaning), path == at ? "" : at);
  };
  start(at, double{});
  start("/history/energy", double{}), start("/history/momentum", double{}), start("/history/constraint", double{});
  start("/history/newton", std::int32_t{});
  for (const Output& output : outputs_) {
    arrays_.push_back("/history/" + output.group + "/" + to_link_name(output.name));
    start(arrays_.back(), double{});
  }
}

void Recorder::first(const State& s, const Ledger& ledger) {
  Row row;
  row.t = s.t;
  row.point = point_values(s, ledger);
  row.field = true;
  row.q = s.q, row.v = s.v;
  next_field_ = setup_.interval;
  rows_.push_back(std::move(row));
  declare();
  if (system_.mesh) declare_rows();
  share_failure();
}

void Recorder::step(const State& s, const Ledger& ledger, const Taken& taken, const Config& a, int iterations) {
  const Timed timed(phases().output);
  ++phases().records;
  Interval interval;
  interval.h = s.t - last_t_;
  interval.mid = mid_values(taken.stage, taken.lambda, a);
  interval.a = a;
  interval.starts_at_jump = !rows_.empty() && rows_.back().jump;
  intervals_.push_back(std::move(interval));
  Row row;
  row.t = s.t;
  row.newton = iterations;
  row.point = point_values(s, ledger);
  row.jump =
      std::any_of(setup_.jumps.begin(), setup_.jumps.end(), [&](double t) { return std::abs(t - s.t) <= 1.001 * system_.same_time; });
  row.field = setup_.is_static || s.t >= next_field_ * (1 - 1e-9);
  if (row.field) {
    row.q = s.q, row.v = s.v;
    if (setup_.interval > 0) next_field_ = setup_.interval * (std::floor(s.t * (1 + 1e-9) / setup_.interval) + 1);
  }
  rows_.push_back(std::move(row));
  advance(false);
  if (wall_clock() - last_flush_ > 0.5) on_store([](Store& f) { f.flush(); }), last_flush_ = wall_clock();
  share_failure();
}

/// Write every row whose neighbouring steps are known.  Mid values belong to their own time in the step and are interpolated to its ends.
void Recorder::advance(bool last) {
  const double own = setup_.own_time;
  const size_t from_right = setup_.alternates ? 3 : 2;  // steps an extrapolation takes
  const auto ready = [&] {                              // row 0 of the deque
    if (rows_.empty()) return false;
    if (last || setup_.is_static) return true;
    if (!first_written_) return intervals_.size() >= from_right;
    return intervals_.size() >= (rows_[0].jump ? 1 + from_right : own == 1 ? 1 : 2);
  };
  while (ready()) {
    // in the deque, intervals_[0] ends at rows_[0] once the first row is out, else it starts there
    const size_t after = first_written_ ? 1 : 0;
    const bool has_before = first_written_ && !intervals_.empty(), has_after = intervals_.size() > after;
    if (has_before && (own == 1 || has_after) && (!rows_[0].jump || setup_.is_static)) {
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
    if (first_written_) {
      past_.push_back(std::move(intervals_.front())), intervals_.pop_front();
      if (past_.size() > 2) past_.pop_front();
    }
    first_written_ = true;
    if (rows_.empty()) return;
  }
}

/// Value at the outer end of the first of up to three neighbouring intervals: the line through their own times.  Where they alternate
/// about the truth, the line through the means at the two nodes further in is free of that: m1 + h1 (m2 - m3)/(h2 + h3).
std::vector<std::pair<double, const Recorder::Interval*>> Recorder::extrapolated(const std::vector<const Interval*>& m,
                                                                                 bool from_right) const {
  if (m.size() == 1) return {{1, m[0]}};
  if (setup_.alternates && m.size() == 3) {
    const double w = m[0]->h / (m[1]->h + m[2]->h);
    return {{1, m[0]}, {w, m[1]}, {-w, m[2]}};
  }
  const double own = from_right ? setup_.own_time : 1 - setup_.own_time;  // distance from the outer end, in steps
  const double near = own * m[0]->h, far = m[0]->h + own * m[1]->h, w = near / (far - near);
  return {{1 + w, m[0]}, {-w, m[1]}};
}

/// Row 0 of the deque with the weighted sum of intervals as its mid-step values; zeros where there are none.
void Recorder::write_row(const std::vector<std::pair<double, const Interval*>>& weights) {
  const Row& row = rows_[0];
  std::vector<double> mid(n_mid_, 0.0);
  for (const auto& [w, interval] : weights)
    for (size_t i = 0; i < n_mid_; ++i) mid[i] += w * interval->mid[i];
  if (row.field) {
    Config a, sum;
    combine(a, {{0, &row.q}});
    for (const auto& [w, interval] : weights) combine(sum, {{1, &a}, {w, &interval->a}}), std::swap(a, sum);
    write_field(row, a);
  }
  ++rows_written_;
  on_store([&](Store& f) { write_histories(f, row, mid); });
}

void Recorder::write_histories(Store& f, const Row& row, const std::vector<double>& mid) const {
  f.append<double>("/history/t", {&row.t, 1});
  const double* p = row.point.data();
  const auto take = [&](const std::string& array, size_t count) {
    f.append<double>(array, {p, count});
    p += count;
  };
  take("/history/energy", 6), take("/history/momentum", 6), take("/history/constraint", 1);
  const std::int32_t newton = row.newton;
  f.append<std::int32_t>("/history/newton", {&newton, 1});
  const double* m = mid.data();
  std::vector<double> values;
  for (size_t k = 0; k < outputs_.size(); ++k) {
    const Output& output = outputs_[k];
    if (output.row) {
      output.row(p, m, values);
    } else {
      values.assign(p, p + output.n_end);
      values.insert(values.end(), m, m + output.n_mid);
    }
    f.append<double>(arrays_[k], values);
    p += output.n_end, m += output.n_mid;
  }
}

void Recorder::finish(bool complete) {
  advance(true);
  on_store([&](Store& f) {
    f.set("/", "complete", static_cast<std::int64_t>(complete));
    f.flush();
    if (n_fields_ > 0) write_xdmf();
  });
  share_failure();
  store_.reset();
}

void Recorder::discard() {
  if (!store_) return;
  store_->discard();
  store_.reset();
  ::unlink((stem(setup_.path) + ".xdmf").c_str());
}

}  // namespace hilo
