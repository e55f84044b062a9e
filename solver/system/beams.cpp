// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/beams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "system/collocation.hpp"
#include "system/connector_clique.hpp"
#include "system/system.hpp"

namespace hilo {
namespace {

using arc::dot, arc::cross, arc::add_to;
using Vector = BeamVector;

Vec3 vec3(const Vector& v) { return Vec3(v[0], v[1], v[2]); }

/// Centre and directors of the bodies at both ends.
std::array<arc::BodyPose<double>, 2> poses_of(const BeamCell& cell, const Config& q) {
  std::array<arc::BodyPose<double>, 2> out;
  for (int e = 0; e < 2; ++e) {
    const int body = cell.body[e];
    std::copy_n(q.c[body].data(), 3, out[e].c.v);
    for (int i = 0; i < 3; ++i) std::copy_n(q.R[body].data() + 3 * i, 3, out[e].R[i].v);
  }
  return out;
}
/// The points of both sections, or rates of these.
arc::SectionPoints<double> points_of(const BeamCell& cell, const Config& q) {
  arc::SectionPoints<double> out;
  arc::points_of(cell.arc, poses_of(cell, q).data(), out);
  return out;
}
arc::Measures<double> measures_of(const BeamCell& cell, const Config& q) { return arc::measures_of(points_of(cell, q).y); }
ArcStrain strain_of(const BeamCell& cell, const Config& q) { return arc_strain(measures_of(cell, q)); }

/// A cell as joints and springs are, with its measures.
const Connector& connector_of(const BeamCell& cell) {
  thread_local Connector c = [] {
    Connector made;
    Config rest;
    rest.c.assign(2, Vec3::Zero()), rest.R.assign(2, Mat3::Identity());
    made.end[0].body = 0, made.end[1].body = 1;
    add_arc_measures(made, rest, Vec3::Zero(), Mat3::Identity(), Vec3::Zero(), Mat3::Identity());
    return made;
  }();
  for (int e = 0; e < 2; ++e) {
    c.end[e].body = cell.body[e];
    c.entities[e].r = vec3(cell.arc.arm[e]);
    for (int i = 0; i < 3; ++i) c.entities[2 + 2 * i + e].r = vec3(cell.arc.axis[e][i]);
  }
  return c;
}

/// Changes of strain over the steps before that dissipation recalls.
ArcStrain recalled(const BeamCell& cell, const Dissipation& d, const Config& from, double last, double before) {
  if (last == 0 && before == 0) return ArcStrain::Zero();
  const ArcStrain one = strain_of(cell, *d.one);
  return last * (strain_of(cell, from) - one) + before * (one - strain_of(cell, *d.two));
}

/// What C* times the change of strain from w0 to w1 takes [J]; at an instant the change is that of its rates.
double taken_by_rates(const BeamCell& cell, const Stage& s) {
  if (s.conserving()) return arc_taken(cell.arc.law, strain_of(cell, *s.w0), strain_of(cell, *s.w1), ArcStrain::Zero());
  const arc::Measures<double> m0 = measures_of(cell, *s.w0), m1 = measures_of(cell, *s.w1);
  const ArcStrain rate = arc_rate(measures_of(cell, *s.left), {m1.a - m0.a, m1.t - m0.t, m1.p - m0.p});
  return arc_taken(cell.arc.law, ArcStrain::Zero(), rate, ArcStrain::Zero());
}

/// Poses of the bodies of W cells, a slot for each configuration that a stage names.
class Poses {
 public:
  /// The slot of a configuration.
  size_t slot(const Config* q) {
    const auto known = std::find(configs_.begin(), configs_.end(), q);
    if (known != configs_.end()) return static_cast<size_t>(known - configs_.begin());
    configs_.push_back(q);
    return configs_.size() - 1;
  }
  size_t size() const { return configs_.size(); }
  void gather(const std::array<int, 2>* bodies, int W, double* to) const {
    for (const Config* q : configs_) {
      for (int l = 0; l < W; ++l) {
        double* lane = to + l;
        for (const int body : bodies[l]) {
          const double *c = q->c[body].data(), *R = q->R[body].data();
          for (int i = 0; i < 3; ++i) lane[i * W] = c[i];
          for (int i = 0; i < 9; ++i) lane[(3 + i) * W] = R[i];
          lane += 12 * W;
        }
      }
      to += 24 * W;
    }
  }

 private:
  std::vector<const Config*> configs_;
};

/// A pair of configurations between which strains act, and what else a pair of the kernel has.
struct StagePair {
  const Config *q0, *q1;
  ArcCall::Pair of;
};

/// What acts between which configurations of a stage: elastic forces with what dissipation takes, and rate forces.
std::vector<StagePair> pairs_of(const Stage& s, bool has_beta) {
  std::vector<StagePair> out;
  bool rates_are_in = !has_beta || !(s.h > 0);
  const Dissipation* d = s.dissipation;
  if (!s.rates_alone) {
    ArcCall::Pair elastic{.elastic = 1, .slope = s.chain}, loss{.kappa = d ? d->kappa : 0, .slope = s.chain};
    if (d) loss.recall[0] = d->last(), loss.recall[1] = d->before();
    if (s.conserving() && !s.step) {
      const bool same = s.w0 == s.e0 && s.w1 == s.e1 && s.slope0() == 0 && std::abs(s.slope1() - s.chain) < 1e-12;
      if (d) {
        elastic.kappa = loss.kappa, elastic.recall[0] = loss.recall[0], elastic.recall[1] = loss.recall[1];
      } else if (!rates_are_in && same) {
        elastic.by_beta = 1 / s.h, rates_are_in = true;
      }
      d = nullptr;
    } else if (!s.step) {
      elastic.mean = true, elastic.weight = s.weight, elastic.end_slopes = s.slopes_of_end;
    }
    out.push_back({s.e0, s.e1, elastic});
    if (d) out.push_back({s.e0, s.e1, loss});
  }
  if (!rates_are_in) {
    const bool is_instant = !s.conserving();
    out.push_back({s.w0, s.w1, {.by_beta = 1 / s.h, .slope = s.slope1(), .is_instant = is_instant, .slope0 = s.slope0()}});
    if (s.slope0() != 0 && !is_instant) out.push_back({s.w1, s.w0, {.by_beta = -1 / s.h, .slope = s.slope0(), .acts = false}});
  }
  return out;
}

}  // namespace

void Beams::add_cell(const SectionPlace& a, const SectionPlace& b, const SectionsAlong& sections, double beta, double alpha) {
  cells.push_back(beam_cell(a, b, points_.start, sections, beta, alpha));
}

void Beams::prepare() {
  std::vector<int> own, all;
  for (size_t k = 0; k < cells.size(); ++k) {
    all.push_back(static_cast<int>(k));
    if (points_.counts(all.back())) own.push_back(all.back());
  }
  own_ = packed(own);
  if (own.size() < all.size()) all_ = packed(all);
}

Beams::Lanes Beams::packed(const std::vector<int>& list) const {
  constexpr size_t n = sizeof(arc::ArcCell<double>) / sizeof(double);
  Lanes out;
  out.kernel = arc_kernel();
  out.cell = list;
  const auto W = static_cast<size_t>(out.kernel.width);
  while (out.cell.size() % W > 0) out.cell.push_back(-1);
  out.data.resize((out.cell.size() * n + 7) / 8);
  for (size_t slot = 0; slot < out.cell.size(); ++slot) {
    const BeamCell& cell = cells[out.cell[slot] >= 0 ? out.cell[slot] : list.back()];
    out.bodies.push_back(cell.body);
    out.has_beta = out.has_beta || cell.arc.beta > 0;
    out.has_alpha = out.has_alpha || cell.arc.alpha > 0;
    const double* from = reinterpret_cast<const double*>(&cell.arc);
    double* to = out.data.front().v + slot / W * W * n + slot % W;
    for (size_t i = 0; i < n; ++i) to[i * W] = from[i];
  }
  return out;
}

std::string Beams::count() const {
  if (cells.empty()) return "";
  return fmt::format("{} beams of {} cells{}", beams.size(), cells.size(),
                     lines.empty() ? "" : fmt::format(" under {} loads by length", lines.size()));
}

void Beams::number(Layout& layout) {
  clique_.clear();
  for (const BeamCell& cell : cells) clique_.push_back(layout.cliques.add(blocks_of_ends(points_, connector_of(cell))));
}

template <class Use>
void Beams::each_cell(const Stage& s, const std::vector<LineForces>& line, bool with_tangent, bool on_all, const Use& use) const {
  const Lanes& lanes = on_all && !all_.cell.empty() ? all_ : own_;
  if (lanes.cell.empty()) return;
  thread_local std::vector<Line> scratch;
  const int W = lanes.kernel.width;
  Poses poses;
  const std::vector<StagePair> pairs = pairs_of(s, lanes.has_beta);
  const bool known = !s.rates_alone && s.step;  // the first pair's forces, by stages that share a step
  const bool drags = s.v && lanes.has_alpha;
  poses.slot(s.left), poses.slot(s.end), poses.slot(s.a);
  if (drags) poses.slot(s.v);
  if (s.last) poses.slot(&s.last->before), poses.slot(&s.last->along);
  for (const StagePair& pair : pairs) {
    poses.slot(pair.q1);
    if (pair.of.s == nullptr) poses.slot(pair.q0);
    if (pair.of.recall[0] != 0 || pair.of.recall[1] != 0) poses.slot(s.dissipation->one), poses.slot(s.dissipation->two);
  }
  constexpr size_t n_f = 12, n_scale = 4, n_K = 144, n_s = ArcLaw::n_measures, n_D = n_s * n_s, n_line = 24 + 64;
  const size_t n_poses = 24 * poses.size();
  scratch.resize((n_poses + n_f + n_scale + n_K + n_s + n_D + n_line) * static_cast<size_t>(W) / 8 + 1);
  double *gathered = scratch.front().v, *f = gathered + n_poses * W, *scale2 = f + n_f * W, *K = scale2 + n_scale * W,
         *forces = K + n_K * W, *slopes = forces + n_s * W, *line_F = slopes + n_D * W, *line_K = line_F + 24 * W;
  const auto pose = [&](const Config* q) { return gathered + 24 * poses.slot(q) * W; };
  ArcCall call{};
  call.left = pose(s.left), call.end = pose(s.end), call.a = pose(s.a), call.v = drags ? pose(s.v) : nullptr;
  if (s.last) call.before = pose(&s.last->before), call.along = pose(&s.last->along);
  for (int i = 0; i < 3; ++i) call.gravity[i] = points_.gravity[i] * s.load_factor;
  call.slope = s.slope, call.mass_slope = s.mass_slope, call.alpha_slope = s.v ? s.alpha_slope : 0;
  for (const StagePair& pair : pairs) {
    ArcCall::Pair& of = call.pairs[call.n_pairs++] = pair.of;
    of.q0 = pose(pair.q0), of.q1 = pose(pair.q1);
    if (of.recall[0] != 0 || of.recall[1] != 0) of.past[0] = pose(s.dissipation->one), of.past[1] = pose(s.dissipation->two);
  }
  if (known) call.pairs[0].s = forces, call.pairs[0].D = slopes;
  if (!line.empty()) call.line_F = line_F, call.line_K = line_K;
  call.f = f, call.scale2 = scale2, call.K = with_tangent ? K : nullptr;
  constexpr size_t n = sizeof(arc::ArcCell<double>) / sizeof(double);
  for (size_t first = 0; first < lanes.cell.size(); first += W) {
    poses.gather(lanes.bodies.data() + first, W, gathered);
    const int* cell = lanes.cell.data() + first;
    for (int l = 0, k = 0; l < W && (known || !line.empty()); ++l) {
      k = cell[l] >= 0 ? cell[l] : k;
      if (known) {
        Response r;
        elastic_along(ArcLaw(cells[k].arc.law, cells[k].arc.beta), MeasurePath(connector_of(cells[k]), *s.step), *s.step, s.member, r);
        for (size_t i = 0; i < n_s; ++i) {
          forces[i * W + l] = r.s[i];
          for (size_t j = 0; j < n_s; ++j) slopes[(i * n_s + j) * W + l] = r.D[i][j];
        }
      }
      if (line.empty()) continue;
      for (int i = 0; i < 24; ++i) line_F[i * W + l] = line[k].F.data()[i];
      for (int i = 0; i < 64; ++i) line_K[i * W + l] = line[k].K.data()[i];
    }
    call.cells = lanes.data.front().v + first * n;
    lanes.kernel.call(call);
    for (int l = 0; l < W; ++l)
      if (cell[l] >= 0) use(cell[l], Found{W, f + l, scale2 + l, K + l});
  }
}

void Beams::evaluate(Pass& p) const {
  const Stage& s = p.s;
  const std::vector<LineForces> line = p.loads ? line_forces(lines, cells, s) : std::vector<LineForces>{};
  each_cell(s, line, p.K != nullptr, false, [&](int k, const Found& found) {
    int kept[12], n = 0;  // rows of bodies that are free
    for (int e = 0; e < 2; ++e) {
      const int body = cells[k].body[e];
      for (int i = 0; i < 6; ++i) p.body[body][i] += found.f[(6 * e + i) * found.width];
      if (points_.body_block[body] >= 0)
        for (int i = 0; i < 6; ++i) kept[n++] = 6 * e + i;
    }
    double largest = found.scale2[0];
    for (int i = 1; i < 4; ++i) largest = std::max(largest, found.scale2[i * found.width]);
    p.scale(std::sqrt(largest));
    if (!p.K) return;
    double dense[144];
    if (n == 12)
      for (int i = 0; i < 144; ++i) dense[i] = found.K[i * found.width];
    else
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) dense[i * n + j] = found.K[(12 * kept[i] + kept[j]) * found.width];
    p.K->add(clique_[k], dense);
  });
}

void Beams::add_energy(const Config& q, const Config& v, Energy& sum) const {
  arc::SectionPoints<double> weight{};
  for (const int c : {0, 4})
    for (int i = 0; i < 3; ++i) weight.y[c][i] = points_.gravity[i];
  for (size_t k = 0; k < cells.size(); ++k) {
    if (!points_.counts(static_cast<int>(k))) continue;
    const BeamCell& cell = cells[k];
    const arc::SectionPoints<double> x = points_of(cell, q), V = points_of(cell, v);
    sum.elastic += arc_energy(cell.arc.law, arc_strain(arc::measures_of(x.y)));
    const std::array<Vector, 8> momenta = momenta_of(cell, V), weights = momenta_of(cell, weight);
    Vector angular{};
    for (int i = 0; i < 8; ++i) {
      sum.kinetic += dot(momenta[i], V.y[i]) / 2;
      sum.gravity -= dot(weights[i], x.y[i]);
      angular = angular + cross(x.y[i], momenta[i]);
    }
    sum.momentum += vec3(momenta[0] + momenta[4]);
    sum.angular += vec3(angular);
  }
}

void Beams::add_work(const Moment& m, Work& sum) const {
  const Stage& s = m.s;
  const std::vector<LineForces> line = line_forces(lines, cells, s);
  const bool rates = s.h > 0 && own_.has_beta, drags = s.v && own_.has_alpha;
  if (line.empty() && !rates && !drags && !s.dissipation) return;
  for (size_t k = 0; k < cells.size(); ++k) {
    if (!points_.counts(static_cast<int>(k))) continue;
    const BeamCell& cell = cells[k];
    if (!line.empty()) sum.external += work(line[k].at(points_of(cell, *s.left)), points_of(cell, s.from()), points_of(cell, *s.end));
    sum.add(s, [&](const Config& from, const Config& to, double last, double before) {
      return arc_taken(cell.arc.law, strain_of(cell, from), strain_of(cell, to), recalled(cell, *s.dissipation, from, last, before));
    });
    if (rates && cell.arc.beta > 0) sum.dissipated += s.share() * cell.arc.beta / s.h * taken_by_rates(cell, s);
    if (drags && cell.arc.alpha > 0)
      sum.dissipated += cell.arc.alpha * work(momenta_of(cell, points_of(cell, *s.v)), points_of(cell, s.from()), points_of(cell, *s.end));
  }
}

double Beams::inertia(int body, const Config& v, const Vec3& w, const Mat3& W) const {
  double sum = 0;
  arc::BodyPose<double> of_w[2];
  for (int e = 0; e < 2; ++e) {
    std::copy_n(w.data(), 3, of_w[e].c.v);
    for (int i = 0; i < 3; ++i) std::copy_n(W.data() + 3 * i, 3, of_w[e].R[i].v);
  }
  for (const BeamCell& cell : cells)
    for (int e = 0; e < 2; ++e)
      if (cell.body[e] == body) {
        const std::array<Vector, 8> F = momenta_of(cell, points_of(cell, v));
        arc::SectionPoints<double> rates;
        arc::points_of(cell.arc, of_w, rates);
        for (int i = 4 * e; i < 4 * e + 4; ++i) sum += dot(F[i], rates.y[i]);
      }
  return sum;
}

std::string Beams::fault(const Config& q) const {
  for (const Beam& beam : beams)
    for (int k = 0; k < beam.n_cells; ++k)
      if (const double turn = ArcLaw::turn(measures_of(cells[beam.first + k], q)); !(turn < ArcLaw::largest_turn))
        return fmt::format("beam \"{}\" turns by {:.3g} rad in its cell {}, more than {}: give it more cells", beam.name, turn, k,
                           ArcLaw::largest_turn);
  return "";
}

std::vector<Output> Beams::outputs() const {
  std::vector<Output> out;
  for (const Beam& beam : beams) out.push_back({.group = "beam", .name = beam.name, .n_mid = 12 * beam.n_cells});
  return out;
}

/// Forces and moments that a cell exerts on its sections, weight, inertia and loads of its own with them: where nothing is loaded they go
/// on from cell to cell.
void Beams::observe(const Sight& sight) {
  if (!sight.step) return;
  const Stage& s = sight.step->s;
  const size_t first = sight.mid.size();
  sight.mid.resize(first + 12 * cells.size());
  each_cell(s, line_forces(lines, cells, s), false, true, [&](int k, const Found& found) {
    double* out = sight.mid.data() + first + 12 * static_cast<size_t>(k);
    const arc::SectionPoints<double> at = points_of(cells[k], *s.left);
    for (int end = 0; end < 2; ++end) {
      Vector F, M;
      for (int i = 0; i < 3; ++i) F[i] = found.f[(6 * end + i) * found.width], M[i] = found.f[(6 * end + 3 + i) * found.width];
      M = M - cross(at.arm[end], F);
      const double side = end == 0 ? -1 : 1;
      for (const Vector& f : {F, M})
        for (int i = 1; i < 4; ++i) *out++ = side * dot(at.y[4 * end + i], f);  // d1, d2, d3
    }
  });
}

void Beams::tie(Ties& ties) const {
  for (const BeamCell& cell : cells)
    if (const int body = tie_ends(points_, connector_of(cell), ties); body >= 0) ties.exclude(body);
}

void each_cell_of_beams(const System& system, const std::function<void(const std::array<int, 2>&)>& use) {
  for (const BeamCell& cell : system.part<Beams>().cells) use(cell.body);
}

}  // namespace hilo
