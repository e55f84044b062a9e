// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/run/playback.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "post/run/marker.hpp"

namespace hilo {

Playback::Playback(RunFile& run) : run_(run), mesh_(run.mesh()) {
  if (run.store().has("/history/path")) path_ = run.series("path");
  if (run.steps.empty())
    throw Error(run.path, "holds no field output yet", run.complete ? "see output.interval of the scene" : "the run is in progress");
}

Playback::Between Playback::between(double t) const {
  const auto& s = run_.steps;
  const auto after = std::lower_bound(s.begin(), s.end(), t, [](const Step& step, double time) { return step.t < time; });
  const auto b = std::min(static_cast<size_t>(after - s.begin()), s.size() - 1);
  const size_t a = b > 0 ? b - 1 : 0;
  const double span = s[b].t - s[a].t, near = 1e-6 * (span > 0 ? span : 1);
  if (std::abs(t - s[b].t) <= near || s.size() == 1) return {b, b, 0};
  if (std::abs(t - s[a].t) <= near) return {a, a, 0};
  if (t < s.front().t || t > s.back().t)
    throw Error(run_.path, fmt::format("no output around t = {:g} s", t), fmt::format("there are {:g} to {:g} s", first(), last()));
  return {a, b, (t - s[a].t) / span};
}

const RunFile::Field& Playback::stored(size_t step, const std::string& array) {
  for (const Kept& k : kept_)
    if (k.step == step && k.array == array) return k.field;
  // An output farther than one from this is not needed any more; a movie goes forward.
  std::erase_if(kept_, [&](const Kept& k) { return (k.step + 1 < step || k.step > step + 1) && !(k.step == 0 && has_modes()); });
  RunFile::Field field = run_.field(run_.steps[step], array);
  const auto cells = array.starts_with("cell_");
  const auto rows = static_cast<size_t>(cells ? mesh_.n_cells() : mesh_.n_nodes());
  if (field.value.size() != rows * static_cast<size_t>(field.columns))
    throw Error(run_.path,
                fmt::format("field \"{}\" of step {} has {} numbers for {} {}", array, run_.steps[step].key, field.value.size(), rows,
                            cells ? "cells" : "nodes"),
                "the mesh was changed after the run, or the step is not written yet");
  kept_.push_back({step, array, std::move(field)});
  return kept_.back().field;
}

RunFile::Field Playback::linear(const Between& at, const std::string& array) {
  RunFile::Field f = stored(at.a, array);
  if (at.a == at.b) return f;
  const auto& g = stored(at.b, array);
  for (size_t i = 0; i < f.value.size(); ++i) f.value[i] += at.w * (g.value[i] - f.value[i]);
  return f;
}

/// The state of rest and a share of what the shape adds to it; quantities without a sign keep theirs.
RunFile::Field Playback::of_mode(double t, const std::string& array, double larger) {
  const auto k = static_cast<size_t>(std::clamp(t + 1e-6, 0.0, static_cast<double>(run_.steps.size() - 1) + 0.5));
  const double swing = std::cos(2 * std::numbers::pi * (t - static_cast<double>(k)));
  RunFile::Field f = stored(0, array);
  const auto& shape = stored(k, array);
  const double share = larger * (f.columns == 1 ? std::abs(swing) : swing);
  for (size_t i = 0; i < f.value.size(); ++i) f.value[i] += share * (shape.value[i] - f.value[i]);
  return f;
}

std::string Playback::caption(double t) const {
  const auto k = static_cast<size_t>(t + 1e-6);
  if (has_modes() && k < run_.shapes.size())
    return k == 0         ? "state of rest"
           : run_.buckles ? fmt::format("shape {}, {:.5g} of the loads", k, run_.shapes[k])
                          : fmt::format("mode {}, {:.5g} Hz", k, run_.shapes[k]);
  if (path_) return fmt::format("state {:.4g}, {:.4g} of the loads", t, at_time(*path_, t).front());
  return last() < 1 ? fmt::format("t = {:.3f} ms", 1e3 * t) : fmt::format("t = {:.4f} s", t);
}

RunFile::Field Playback::field(double t, const std::string& array) {
  if (has_modes()) return of_mode(t, array, 1);
  const Between at = between(t);
  if (array != "displacement" || at.a == at.b || !run_.has_field(run_.steps[at.a], "velocity")) return linear(at, array);
  const double w = at.w, h = run_.steps[at.b].t - run_.steps[at.a].t;
  const double p0 = (1 + 2 * w) * (1 - w) * (1 - w), p1 = w * w * (3 - 2 * w), m0 = h * w * (1 - w) * (1 - w), m1 = h * w * w * (w - 1);
  RunFile::Field f = stored(at.a, array);
  const auto u1 = stored(at.b, array).value;  // copies: the next look-up may move what is kept
  const auto v0 = stored(at.a, "velocity").value;
  const auto& v1 = stored(at.b, "velocity").value;
  for (size_t i = 0; i < f.value.size(); ++i) f.value[i] = p0 * f.value[i] + p1 * u1[i] + m0 * v0[i] + m1 * v1[i];
  return f;
}

const std::vector<Vec3>& Playback::positions(double t) {
  if (t == x_time_) return x_;
  x_ = mesh_.X;
  x_time_ = t;
  if (!run_.has_field(run_.steps[has_modes() ? 0 : between(t).a], "displacement")) return x_;
  const auto u = (has_modes() ? of_mode(t, "displacement", drawn_larger) : field(t, "displacement")).value;
  for (size_t n = 0; n < x_.size(); ++n) x_[n] += Vec3(u[3 * n], u[3 * n + 1], u[3 * n + 2]);
  return x_;
}

}  // namespace hilo
