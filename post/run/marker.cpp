// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/run/marker.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cstdio>

#include "base/error.hpp"

namespace hilo {

Pose best_pose(const std::vector<Vec3>& X, const std::vector<Vec3>& x) {
  Pose p;
  const auto n = static_cast<double>(X.size());
  for (size_t i = 0; i < X.size(); ++i) p.from += X[i] / n, p.to += x[i] / n;
  Mat3 spread = Mat3::Zero(), own = Mat3::Zero();
  for (size_t i = 0; i < X.size(); ++i) {
    spread += (x[i] - p.to) * (X[i] - p.from).transpose();
    own += (X[i] - p.from) * (X[i] - p.from).transpose();
  }
  const Eigen::JacobiSVD<Mat3> svd(spread, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (!(svd.singularValues()[1] > 1e-9 * own.trace())) return p;  // a point or a line
  Mat3 sign = Mat3::Identity();
  sign(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  p.R = svd.matrixU() * sign * svd.matrixV().transpose();
  return p;
}

std::vector<double> at_time(const Series& s, double t) {
  if (s.t.empty()) return std::vector<double>(s.column.size(), 0.0);
  const auto after = static_cast<size_t>(std::lower_bound(s.t.begin(), s.t.end(), t) - s.t.begin());
  const size_t b = std::min(after, s.t.size() - 1), a = b > 0 && s.t[b] >= t ? b - 1 : b;
  const double w = b > a ? std::clamp((t - s.t[a]) / (s.t[b] - s.t[a]), 0.0, 1.0) : 0;
  std::vector<double> row(s.column.size());
  for (size_t c = 0; c < row.size(); ++c) row[c] = s.at(a, c) + w * (s.at(b, c) - s.at(a, c));
  return row;
}

Marker::Marker(RunFile& run, const std::string& name, const std::string& option) : mesh_(&run.mesh()) {
  Vec3 p;
  char rest = 0;
  std::vector<std::string> known = mesh_->all_names();
  const auto histories = run.series_names();
  const auto has = [&](const std::string& what) { return std::find(histories.begin(), histories.end(), what) != histories.end(); };
  if (std::find(known.begin(), known.end(), name) != known.end()) {
    nodes_ = mesh_->nodes_of(name, option);
  } else if (has("probe." + name)) {
    series_ = run.series("probe." + name);
  } else if (has("body." + name)) {
    series_ = run.series("body." + name);
    const auto names = run.store().read_strings("/body/name");
    const auto at = static_cast<size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    const auto points = run.store().read<double>("/body/points");
    for (size_t k = 0; at < names.size() && k < 4; ++k) body_.emplace_back(&points[12 * at + 3 * k]);
  } else if (has("sensor." + name)) {
    const Scene scene = scene_of(run);
    for (const Entry& e : scene.entries("sensor"))
      if (e.name == name) *this = Marker(run, e.text("on"), option);
    return;
  } else if (std::sscanf(name.c_str(), "%lf,%lf,%lf%c", &p.x(), &p.y(), &p.z(), &rest) == 3) {
    const auto nearer = [&](const Vec3& a, const Vec3& b) { return (a - p).squaredNorm() < (b - p).squaredNorm(); };
    nodes_ = {std::min_element(mesh_->X.begin(), mesh_->X.end(), nearer) - mesh_->X.begin()};
  } else {
    for (const auto& h : histories)
      for (const char* group : {"probe.", "sensor.", "body."})
        if (h.starts_with(group)) known.push_back(h.substr(std::string(group).size()));
    const std::string hint = suggest(name, known);
    throw Error(option, fmt::format("no region, set, probe, sensor or body \"{}\"", name),
                hint.empty() ? "or x,y,z for the node that is nearest" : hint);
  }
  if (!nodes_.empty())
    for (const auto n : nodes_) reference_ += mesh_->X[static_cast<size_t>(n)] / static_cast<double>(nodes_.size());
  else if (!body_.empty())
    reference_ = body_.front();
  else if (series_ && series_->rows() > 0)
    reference_ = Vec3(series_->at(0, 0), series_->at(0, 1), series_->at(0, 2));
}

Pose Marker::pose(double t, const std::vector<Vec3>& x) const {
  if (!nodes_.empty()) {
    std::vector<Vec3> before, now;
    for (const auto n : nodes_) before.push_back(mesh_->X[static_cast<size_t>(n)]), now.push_back(x[static_cast<size_t>(n)]);
    return best_pose(before, now);
  }
  const auto row = at_time(*series_, t);
  if (body_.empty()) return {Mat3::Identity(), reference_, Vec3(row[0], row[1], row[2])};
  std::vector<Vec3> now;
  for (size_t k = 0; k < 4; ++k) now.emplace_back(&row[3 * k]);
  Pose p = best_pose(body_, now);
  return {p.R, body_.front(), now.front()};
}

std::vector<Vec3> Marker::way(double t, Playback& playback) {
  std::vector<Vec3> path;
  if (series_) {
    for (size_t k = 0; k < series_->rows() && series_->t[k] < t; ++k)
      path.emplace_back(series_->at(k, 0), series_->at(k, 1), series_->at(k, 2));
    path.push_back(pose(t, {}).to);
    return path;
  }
  const auto& steps = playback.run().steps;
  for (size_t k = passed_.size(); k < steps.size() && steps[k].t < t; ++k)
    passed_.push_back(pose(steps[k].t, playback.positions(steps[k].t)).to);
  for (size_t k = 0; k < passed_.size() && steps[k].t < t; ++k) path.push_back(passed_[k]);
  path.push_back(pose(t, playback.positions(t)).to);
  return path;
}

}  // namespace hilo
