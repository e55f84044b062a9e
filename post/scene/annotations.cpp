// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/scene/annotations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace hilo {
namespace {

constexpr Rgb joint_force_colour{0.56, 0.10, 0.44}, spring_force_colour{0.05, 0.36, 0.36}, held_colour{0.16, 0.30, 0.66};

const Entry* find(const Scene& scene, const std::string& section, const std::string& name) {
  for (const Entry& e : scene.entries(section))
    if (e.name == name) return &e;
  return nullptr;
}

/// The end of a joint: a set within one rigid region is carried by all of it.
std::optional<Marker> carrier(RunFile& run, const Entry& e, const char* key) {
  std::string name = e.text(key);
  if (name == "ground") return {};
  const MeshFile& file = run.mesh_file();
  const Mesh& mesh = file.mesh;
  const auto known = mesh.all_names();
  if (mesh.find_region(name) < 0 && std::find(known.begin(), known.end(), name) != known.end()) {
    std::vector<char> in(static_cast<size_t>(mesh.n_nodes()), 0);
    const auto nodes = mesh.nodes_of(name, e.where(key));
    for (const auto n : nodes) in[static_cast<size_t>(n)] = 1;
    std::vector<std::vector<char>> held(mesh.region_name.size());
    std::vector<size_t> count(mesh.region_name.size(), 0);
    for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
      const auto r = static_cast<size_t>(mesh.region[static_cast<size_t>(c)]);
      if (file.fidelity[r] != Fidelity::rigid) continue;
      for (const auto n : mesh.cell(c))
        if (in[static_cast<size_t>(n)]) {
          if (held[r].empty()) held[r].assign(in.size(), 0);
          count[r] += !held[r][static_cast<size_t>(n)], held[r][static_cast<size_t>(n)] = 1;
        }
    }
    for (size_t r = 0; r < count.size(); ++r)
      if (count[r] == nodes.size()) name = mesh.region_name[r];
  }
  return Marker(run, name, e.where(key));
}

ForceArrow arrow(RunFile& run, const Scene& scene, const std::string& history) {
  const auto dot = history.find('.');
  const std::string group = history.substr(0, dot), name = history.substr(dot + 1);
  ForceArrow f;
  f.name = name;
  f.history = run.series(history);
  f.colour = group == "spring" ? spring_force_colour : group == "motion" ? held_colour : joint_force_colour;
  const bool on_joint = group == "stop" || group == "motor" || group == "friction";
  const Entry* e = find(scene, group, name);
  if (!e && group == "spring") e = find(scene, "joint", name);  // one that gives way
  if (e && on_joint) e = find(scene, "joint", e->text("joint"));
  if (!e) throw Error(run.path, fmt::format("the scene has no {} \"{}\"", group, name), "the file was not written by hilo-solve");
  if (group == "motion") {
    f.b = carrier(run, *e, "on");
    f.at = e->has("at") ? e->vector3("at") : f.b->reference();
    return f;
  }
  f.a = carrier(run, *e, "a"), f.b = carrier(run, *e, "b");
  f.at = e->has("at_b") ? e->vector3("at_b") : e->has("at") ? e->vector3("at") : f.b ? f.b->reference() : Vec3::Zero();
  if (group == "spring") {
    f.a.reset();  // inertial axes
    return f;
  }
  if (e->has("axis")) f.frame = frame_of_axis(e->vector3("axis").normalized(), e->has("x") ? e->vector3("x").normalized() : Vec3::Zero());
  return f;
}

/// An arrow in a white outline, to be seen on any colour.
void outlined_arrow(Painter& p, const Vec2& a, const Vec2& b, const Rgb& colour) {
  const double length = (b - a).norm(), head = std::min(14 * p.scale, length);
  const Vec2 along = (b - a) / length, across(-along.y(), along.x()), neck = b - head * along;
  const std::array<Vec2, 3> tip{b, Vec2(neck + 0.42 * head * across), Vec2(neck - 0.42 * head * across)};
  p.line(a, neck, white, 6.4);
  p.line(std::array{tip[0], tip[1], tip[2], tip[0], tip[1]}, white, 3);
  p.line(a, b - 0.8 * head * along, colour, 3.4);
  p.polygon(tip, colour);
}

}  // namespace

Vec3 ForceArrow::force(double t, const std::vector<Vec3>& x) const {
  const auto row = at_time(history, t);
  const Mat3 R = a ? a->pose(t, x).R : Mat3::Identity();
  return R * frame * Vec3(row[0], row[1], row[2]);
}

Vec3 ForceArrow::point(double t, const std::vector<Vec3>& x) const { return b ? b->pose(t, x)(at) : at; }

std::vector<ForceArrow> force_arrows(RunFile& run, const std::vector<std::string>& globs) {
  std::vector<ForceArrow> arrows;
  if (globs.empty()) return arrows;
  const Scene scene = scene_of(run);
  std::vector<std::string> names, taken;
  for (const auto& h : run.series_names())
    for (const char* group : {"joint.", "spring.", "stop.", "motor.", "friction.", "motion."})
      if (h.starts_with(group)) names.push_back(h);
  for (const auto& glob : globs) {
    bool any = false;
    for (const auto& name : names) {
      if (!matches(glob, name) && !matches(glob, name.substr(name.find('.') + 1))) continue;
      any = true;
      if (std::find(taken.begin(), taken.end(), name) == taken.end()) taken.push_back(name), arrows.push_back(arrow(run, scene, name));
    }
    if (any) continue;
    std::vector<std::string> known;
    for (const auto& name : names) known.push_back(name.substr(name.find('.') + 1));
    const std::string hint = suggest(glob, known);
    throw Error("--forces", fmt::format("no joint or spring \"{}\"", glob), hint.empty() ? "see hilo-post series --list" : hint);
  }
  return arrows;
}

Annotations::Annotations(const FrameOptions& o, RunFile& run) : arrows_(force_arrows(run, o.forces)) {
  for (const auto& name : o.trace) traced_.emplace_back(name, Marker(run, name, "--trace"));
}

double Annotations::largest_force(const std::vector<double>& times) const {
  double most = 0;
  for (const ForceArrow& f : arrows_)
    for (const double t : times) {
      const auto row = at_time(f.history, t);
      most = std::max(most, Vec3(row[0], row[1], row[2]).norm());
    }
  return most;
}

void Annotations::frame(double t, Playback& playback, const Pose& drawn, std::vector<Vec3>& extremes) {
  for (auto& [name, marker] : traced_)
    for (const Vec3& x : marker.way(t, playback)) extremes.push_back(drawn.back(x));
}

void Annotations::draw(Painter& p, const Projection& project, const Box& box, double t, Playback& playback, const Pose& drawn,
                       double metres) {
  std::vector<Label> labels;
  for (size_t i = 0; i < traced_.size(); ++i) {
    std::vector<Vec2> way;
    for (const Vec3& x : traced_[i].second.way(t, playback)) way.push_back(project(drawn.back(x)));
    const Rgb colour = curve_colour(static_cast<int>(i) + 1);
    p.line(way, white, 4.5, 0.8);
    p.line(way, colour, 2.2);
    p.disc(way.back(), 5.5 * p.scale, white), p.disc(way.back(), 4 * p.scale, colour);
    labels.push_back({way.back(), traced_[i].first, colour});
  }
  if (!arrows_.empty()) {
    const auto& x = playback.positions(t);
    for (const ForceArrow& f : arrows_) {
      const Vec3 force = f.force(t, x), at = f.point(t, x);
      if (force.norm() == 0) continue;  // a moment alone, or none
      const Vec2 from = project(drawn.back(at)), to = project(drawn.back(at + metres * force));
      if ((to - from).norm() < 2 * p.scale) {
        p.disc(from, 4.5 * p.scale, white), p.disc(from, 3 * p.scale, f.colour);
      } else {
        outlined_arrow(p, from, to, f.colour);
      }
      labels.push_back({to, fmt::format("{} {}", f.name, force_text(force.norm())), f.colour});
    }
  }
  draw_labels(p, labels, box, 14);
}

std::string force_text(double newton) {
  const double size = std::abs(newton);
  return size >= 1e6   ? fmt::format("{:.3g} MN", newton / 1e6)
         : size >= 1e3 ? fmt::format("{:.3g} kN", newton / 1e3)
                       : fmt::format("{:.3g} N", newton);
}

double round_below(double x) {
  const double power = std::pow(10, std::floor(std::log10(x)));
  return (x >= 5 * power ? 5 : x >= 2 * power ? 2 : 1) * power;
}

}  // namespace hilo
