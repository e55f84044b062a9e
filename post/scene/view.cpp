// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/scene/view.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vtkCamera.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/error.hpp"

namespace hilo {
namespace {

struct Preset {
  const char* name;
  View view;
};
const std::vector<Preset>& presets() {
  static const std::vector<Preset> table = {{"iso", {{1, -1.25, 0.85}, {0, 0, 1}, false}},
                                            {"iso-left", {{1, 1.25, 0.85}, {0, 0, 1}, false}},
                                            {"iso-rear", {{-1, -1.25, 0.85}, {0, 0, 1}, false}},
                                            {"iso-below", {{1, -1.25, -0.7}, {0, 0, 1}, false}},
                                            {"front", {{1, 0, 0}, {0, 0, 1}, true}},
                                            {"rear", {{-1, 0, 0}, {0, 0, 1}, true}},
                                            {"left", {{0, 1, 0}, {0, 0, 1}, true}},
                                            {"right", {{0, -1, 0}, {0, 0, 1}, true}},
                                            {"top", {{0, 0, 1}, {0, 1, 0}, true}},
                                            {"bottom", {{0, 0, -1}, {0, -1, 0}, true}}};
  return table;
}
constexpr double view_angle = 20;  // [degree], vertical

}  // namespace

const std::vector<std::string>& view_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> n;
    for (const auto& p : presets()) n.emplace_back(p.name);
    return n;
  }();
  return names;
}

View parse_view(const std::string& text) {
  for (const auto& p : presets())
    if (text == p.name) return p.view;
  std::vector<double> x;
  std::stringstream stream(text);
  bool numbers = true;
  for (std::string part; std::getline(stream, part, ',');) {
    double v = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), v);
    numbers = numbers && error == std::errc() && end == part.data() + part.size();
    x.push_back(v);
  }
  if (numbers && (x.size() == 3 || x.size() == 6)) {
    View v{{x[0], x[1], x[2]}, {0, 0, 1}, false};
    if (x.size() == 6)
      v.up = {x[3], x[4], x[5]};
    else if (std::hypot(x[0], x[1]) < 1e-6 * std::abs(x[2]))
      v.up = {0, 1, 0};
    if (v.towards.cross(v.up).norm() > 1e-9 * v.towards.norm() * v.up.norm()) return v;
    throw Error("--camera", fmt::format("\"{}\" gives no direction and upward direction", text), "", Exit::usage);
  }
  std::string hint = suggest(text, view_names());
  if (hint.empty()) hint = fmt::format("one of {}, or x,y,z towards the camera", fmt::join(view_names(), ", "));
  throw Error("--camera", fmt::format("no view \"{}\"", text), hint, Exit::usage);
}

Fit::Fit(const View& view, double aspect, double room) : view_(view), aspect_(aspect), room_(room) {
  back_ = view.towards.normalized();
  right_ = view.up.cross(back_).normalized();
  up_ = back_.cross(right_);
  const double half = view.parallel ? 0 : std::tan(view_angle * M_PI / 360);
  slope_ = {half * aspect * (1 - 2 * room), half * (1 - 2 * room)};
  const double infinity = std::numeric_limits<double>::infinity();
  high_ = {-infinity, -infinity}, low_ = {infinity, infinity};
  nearest_ = -infinity, farthest_ = infinity;
}

void Fit::add(const Vec3& x) {
  const double r[] = {x.dot(right_), x.dot(up_)}, b = x.dot(back_);
  for (size_t i = 0; i < 2; ++i) {
    high_[i] = std::max(high_[i], r[i] + slope_[i] * b);
    low_[i] = std::min(low_[i], r[i] - slope_[i] * b);
  }
  nearest_ = std::max(nearest_, b), farthest_ = std::min(farthest_, b);
}

void Fit::aim(vtkCamera* camera) const {
  // A point at depth D - b before the camera is seen when |r - centre| <= slope (D - b); both bounds are linear in the centre and in D.
  const double middle = 0.5 * (nearest_ + farthest_), depth = std::max(nearest_ - farthest_, 1e-9);
  Vec3 centre = middle * back_;
  centre += 0.5 * (high_[0] + low_[0]) * right_ + 0.5 * (high_[1] + low_[1]) * up_;
  const double size = std::max({high_[0] - low_[0], high_[1] - low_[1], depth});
  double distance = 3 * size;  // from the centre
  if (view_.parallel) {
    camera->ParallelProjectionOn();
    camera->SetParallelScale(0.5 * std::max({(high_[0] - low_[0]) / aspect_, high_[1] - low_[1], 1e-6 * size}) / (1 - 2 * room_));
  } else {
    camera->ParallelProjectionOff();
    camera->SetViewAngle(view_angle);
    const double D = std::max((high_[0] - low_[0]) / (2 * slope_[0]), (high_[1] - low_[1]) / (2 * slope_[1]));
    distance = std::max(D - middle, 1e-6 * size);
  }
  const Vec3 eye = centre + distance * back_;
  camera->SetFocalPoint(centre.data());
  camera->SetPosition(eye.data());
  camera->SetViewUp(up_.data());
}

}  // namespace hilo
