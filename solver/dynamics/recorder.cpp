#include "dynamics/recorder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "dynamics/profile.hpp"
#include "physics/rolling.hpp"

namespace hilo {
namespace {

/// Four points of a body from its centre and directors: the centre, and one along each principal axis, in the order of rising moments of
/// inertia (falling ones of the Euler tensor J).
std::array<Vec3, 4> body_arms(const Body& b) {
  std::array<Vec3, 4> arms{Vec3::Zero(), Vec3(b.size, 0, 0), Vec3(0, b.size, 0), Vec3(0, 0, b.size)};
  if (b.mass > 0 && !b.J.isZero(0)) {
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(b.J);
    Mat3 axes = eigen.eigenvectors().rowwise().reverse();
    if (axes.determinant() < 0) axes.col(2) *= -1;
    for (int i = 0; i < 3; ++i) arms[1 + i] = b.size * axes.col(i);
  }
  return arms;
}

}  // namespace

std::string stem(const std::string& path) { return path.ends_with(".h5") ? path.substr(0, path.size() - 3) : path; }

Recorder::Recorder(const System& system, const Scene& scene, Setup setup)
    : system_(system), scene_(scene), setup_(std::move(setup)), share_(system) {
  for (const Body& b : system.bodies) arms_.push_back(body_arms(b));
}

/// Histories that belong to an instant: energies, momentum, violation, points of bodies, stations' positions, velocities and axes.
std::vector<double> Recorder::point_values(const State& s, const Ledger& ledger) {
  const System::Energy& e = ledger.energy;
  last_t_ = s.t;
  std::vector<double> v{e.kinetic, e.elastic, e.gravity, ledger.work, ledger.dissipated, ledger.balance};
  for (int i = 0; i < 3; ++i) v.push_back(e.momentum[i]);
  for (int i = 0; i < 3; ++i) v.push_back(e.angular[i]);
  v.push_back(ledger.rows.worst());
  for (size_t b = 1; b < system_.bodies.size(); ++b)
    for (const Vec3& arm : arms_[b]) {
      const Vec3 x = s.q.c[b] + s.q.R[b] * arm;
      v.insert(v.end(), x.data(), x.data() + 3);
    }
  for (const Station& st : system_.stations) {
    double mean[6] = {};
    Mat3 axes = st.axes;
    if (st.body >= 0) {
      const Vec3 x = s.q.c[st.body] + s.q.R[st.body] * st.arm, u = s.v.c[st.body] + s.v.R[st.body] * st.arm;
      for (int i = 0; i < 3; ++i) mean[i] = x[i], mean[3 + i] = u[i];
      axes = s.q.R[st.body] * st.axes;
    } else {
      for (int n : st.nodes)
        for (int i = 0; i < 3; ++i) mean[i] += s.q.x[n][i] / st.n_nodes, mean[3 + i] += s.v.x[n][i] / st.n_nodes;
      system_.comm->sum(mean);
      if (st.sensor && st.n_nodes > 2) {  // polar fit of the patch's motion
        const Vec3 centre(mean[0], mean[1], mean[2]);
        Mat3 F = Mat3::Zero();
        for (int n : st.nodes) F += (s.q.x[n] - centre) * (system_.X[n] - st.mean).transpose();
        system_.comm->sum(std::span<double>(F.data(), 9));
        const Eigen::JacobiSVD<Mat3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
        Mat3 D = Mat3::Identity();
        D(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
        axes = svd.matrixU() * D * svd.matrixV().transpose() * st.axes;
      }
    }
    v.insert(v.end(), mean, mean + 6);
    v.insert(v.end(), axes.data(), axes.data() + 9);
  }
  return v;
}

/// Histories that belong inside a step: reactions of joints, springs and motions, accelerations of stations.
std::vector<double> Recorder::mid_values(const Stage& stage, std::span<const double> lambda_, const Config& a) {
  std::vector<double> v;
  std::vector<double> full;
  std::span<const double> lambda = lambda_;
  if (setup_.redundant) full = share_(stage, lambda_), lambda = full;
  const auto push = [&](const Vec3& x) { v.insert(v.end(), x.data(), x.data() + 3); };
  ConnectorGradient left;
  for (size_t j = 0; j < system_.joints.size(); ++j) {
    const Connector& c = system_.joints[j];
    gradient(c, *stage.left, left);
    double s_left[max_measures];
    joint_forces(c, stage, left, lambda.data() + 3 * (system_.joint_block[j] - system_.first_joint_block()), s_left);
    Vec6 f = force_on_b(c, left, s_left, *stage.left);
    if (c.velocity_rows) {
      const double* own = lambda.data() + 3 * (system_.joint_block[j] - system_.first_joint_block());
      const int b = c.end[1].body;
      Vec6 slip = Slip(c, *stage.left, stage.v).force(own + c.n_position_rows());
      slip.tail<3>() -= (stage.left->R[b] * c.point_b).cross(slip.head<3>());
      f += slip;
    }
    const Mat3 frame = c.end[0].body >= 0 ? Mat3(stage.left->R[c.end[0].body] * c.frame_a) : Mat3::Identity();
    push(frame.transpose() * f.head<3>());
    push(frame.transpose() * f.tail<3>());
  }
  for (const Connector& c : system_.springs) {
    const int n = static_cast<int>(c.measures.size());
    gradient(c, *stage.left, left);
    SpringLaw::Values r0{}, r1{};
    for (int m = 0; m < n; ++m) r0[m] = c.value(m, *stage.w0), r1[m] = c.value(m, *stage.w1);
    Response r;
    spring_elastic(c, stage, r);
    if (stage.h > 0) c.law->viscous(r0, r1, system_.interval(c, stage, lambda_), r);
    const Vec6 f = force_on_b(c, left, r.s.data(), *stage.left);
    if (c.section == "spring") {
      push(f.head<3>()), push(f.tail<3>());
      continue;
    }
    const Mat3 frame = c.end[0].body >= 0 ? Mat3(stage.left->R[c.end[0].body] * c.frame_a) : Mat3::Identity();
    push(frame.transpose() * f.head<3>()), push(frame.transpose() * f.tail<3>());
  }
  if (!system_.motions.empty()) {
    System::Forces forces;
    system_.forces(stage, lambda_, forces);
    for (const Motion& m : system_.motions) {
      const Vec6 f = system_.reaction(m, forces, *stage.left);
      push(f.head<3>()), push(f.tail<3>());
    }
  }
  for (const Station& st : system_.stations) {
    Vec3 mean = Vec3::Zero();
    if (st.body >= 0) {
      mean = a.c[st.body] + a.R[st.body] * st.arm;
    } else {
      for (int n : st.nodes) mean += a.x[n] / st.n_nodes;
      system_.comm->sum(std::span<double>(mean.data(), 3));
    }
    push(mean);
  }
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
    for (const Vec3& arm : arms_[b]) {
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
  f.start_rows<double>("/history/t", {}, "s", "times of the histories");
  const std::string at = "/history/t";
  f.start_rows<double>("/history/energy", {6}, "J",
                       "kinetic, elastic, gravity potential, external work, dissipated, balance E - E0 - W + D", at);
  f.start_rows<double>("/history/momentum", {6}, "kg m/s, kg m^2/s", "linear, and angular about the origin", at);
  f.start_rows<double>("/history/constraint", {}, "m", "largest violation of a joint row", at);
  f.start_rows<std::int32_t>("/history/newton", {}, "", "Newton iterations of the step", at);
  const auto start = [&](const std::string& group, const std::string& name, int width, const char* unit, const char* meaning) {
    arrays_.push_back("/history/" + group + "/" + to_link_name(name));
    f.start_rows<double>(arrays_.back(), {width}, unit, meaning, at);
  };
  for (size_t b = 1; b < system_.bodies.size(); ++b) start("body", system_.bodies[b].name, 12, "m", "positions of the four points");
  for (const Connector& c : system_.joints)
    start("joint", c.name, 6, "N, N m",
          setup_.redundant ? "force and moment on b at the joint point, joint frame carried by a; minimum-norm share of redundant joints"
                           : "force and moment on b at the joint point, joint frame carried by a");
  for (const Connector& c : system_.springs)
    start(c.section, c.name, 6, "N, N m",
          c.section == "spring" ? "force and moment on b at the point, inertial axes"
                                : "force and moment on b at the joint point, joint frame carried by a");
  for (const Motion& m : system_.motions) start("motion", m.name, 6, "N, N m", "force and moment on what is held, inertial axes");
  for (const Station& s : system_.stations) {
    if (s.sensor)
      start("sensor", s.name, 3, "1", "proper acceleration R^T (a - g)/g0, +1 upward at rest");
    else
      start("probe", s.name, 9, "m, m/s, m/s^2", "position, velocity, acceleration");
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
  const size_t n_mid = 6 * (system_.joints.size() + system_.springs.size() + system_.motions.size()) + 3 * system_.stations.size();
  std::vector<double> mid(n_mid, 0.0);
  for (const auto& [w, interval] : weights)
    for (size_t i = 0; i < n_mid; ++i) mid[i] += w * interval->mid[i];
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
  auto array = arrays_.begin();  // in the order of declare_arrays
  for (size_t b = 1; b < system_.bodies.size(); ++b) take(*array++, 12);
  const double* m = mid.data();
  for (size_t k = system_.joints.size() + system_.springs.size() + system_.motions.size(); k > 0; --k) {
    f.append<double>(*array++, {m, 6});
    m += 6;
  }
  for (const Station& s : system_.stations) {
    const Vec3 a(m[0], m[1], m[2]);
    if (s.sensor) {
      const Mat3 axes = Eigen::Map<const Mat3>(p + 6);
      const Vec3 felt = axes.transpose() * (a - system_.gravity) / g0;
      f.append<double>(*array++, {felt.data(), 3});
    } else {
      const double values[9] = {p[0], p[1], p[2], p[3], p[4], p[5], a[0], a[1], a[2]};
      f.append<double>(*array++, values);
    }
    m += 3, p += 15;
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
