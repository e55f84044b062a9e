// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/links.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <bit>

#include "base/error.hpp"

namespace hilo {

namespace {

/// A kind of joint, and which of the axes are its own and its x, or -1.
struct Stage {
  const char* kind;
  int axis = -1, x = -1;
};

/// The joint that holds these components, else joints one behind the other.
std::vector<Stage> stages_that_hold(unsigned components) {
  const unsigned slides = components & 7, turns = components >> 3 & 7;
  const auto free = [](unsigned bits) { return std::countr_zero(7 & ~bits); };  // the axis that is not held
  const int n_slides = std::popcount(slides), n_turns = std::popcount(turns), held = std::countr_zero(turns);
  if (components == 0) return {};
  if (slides == 7 && turns == 7) return {{"fixed"}};
  if (n_slides == 2 && turns == slides) return {{"cylindrical", free(slides)}};
  if (n_slides == 1 && n_turns == 2 && (turns & slides) == 0) return {{"planar", std::countr_zero(slides)}};
  if (n_slides == 1 && turns == 0) return {{"in-plane", std::countr_zero(slides)}};
  if (n_slides == 2 && turns == 0) return {{"in-line", free(slides)}};
  std::vector<Stage> stages;
  for (int k = 0; k < 3; ++k)
    if (!(slides >> k & 1)) stages.push_back({"prismatic", k});
  if (turns == 0)
    stages.push_back({"spherical"});
  else if (n_turns == 1)  // its cross bends about the two others
    stages.push_back({"universal", (held + 1) % 3, (held + 2) % 3});
  else if (n_turns == 2)
    stages.push_back({"revolute", free(turns)});
  return stages;
}

}  // namespace

void joints_that_hold(SceneWriter& scene, unsigned components, const Mat3& axes, const std::string& name, const std::string& a,
                      const std::string& b, const Vec3& at, const std::string& place) {
  const auto stages = stages_that_hold(components);
  std::string from = a;
  for (size_t i = 0; i < stages.size(); ++i) {
    const auto& [kind, axis, x] = stages[i];
    const std::string to = i + 1 < stages.size() ? massless_body(scene, scene.unique("body", name + "_slide"), at, place) : b;
    SceneTable& joint = scene.add_unique({"joint", kind}, name, place, {{"a", from}, {"b", to}, {"at", at}});
    if (axis >= 0) joint.set("axis", axes.col(axis));
    if (x >= 0) joint.set("x", axes.col(x));
    from = to;
  }
}

void hold_body(SceneWriter& scene, const std::string& name, unsigned components, const Mat3& axes, const Prescribed& by, const Vec3& at,
               const std::string& history, const std::string& place) {
  if (components == 63) return motion_of_body(scene, scene.unique("motion", name), name, by, at, history, place);
  std::string to = "ground";
  if (by.any()) {
    to = massless_body(scene, scene.unique("body", name + "_moved"), at, place);
    motion_of_body(scene, to, to, by, at, history, place);
  }
  joints_that_hold(scene, components, axes, name + "_support", to, name, at, place);
}

void hold_set(SceneWriter& scene, const std::string& set, unsigned components, const std::optional<Vec3>& displacement,
              const std::string& history, const std::string& place) {
  std::vector<std::string> along;
  for (size_t k = 0; k < 3; ++k)
    if (components >> k & 1) along.emplace_back(1, "xyz"[k]);
  scene
      .add_unique({"motion", displacement ? "translation" : "fixed"}, set, place,
                  {{"on", set}, {"components", along}, {"displacement", displacement ? SceneValue(*displacement) : SceneValue()}})
      .set_if(displacement.has_value(), "history", history);
  scene.supports.push_back({set, place, history, components, displacement.value_or(Vec3::Zero())});
}

void motion_of_body(SceneWriter& scene, const std::string& name, const std::string& on, const Prescribed& by, const Vec3& at,
                    const std::string& history, const std::string& place) {
  if (by.turn != Vec3::Zero() && by.way != Vec3::Zero())
    throw Error(place, fmt::format("\"{}\" is moved and turned by given amounts, which is not read", on), "move it or turn it");
  if (!by.any())
    scene.add({"motion", "fixed"}, name, place, {{"on", on}});
  else if (by.turn == Vec3::Zero())
    scene.add({"motion", "translation"}, name, place, {{"on", on}, {"displacement", by.way}, {"history", history}});
  else
    scene.add({"motion", "rotation"}, name, place,
              {{"on", on}, {"at", at}, {"axis", by.turn.normalized()}, {"angle", by.turn.norm()}, {"history", history}});
}

std::optional<MeanShares> shares_of_mean(const std::vector<Vec3>& X, const std::vector<double>& w, const Vec3& at, const Vec3& F,
                                         const Vec3& M, const std::vector<double>& v) {
  double W = 0;
  Vec3 c = Vec3::Zero();
  for (size_t a = 0; a < X.size(); ++a) W += w[a], c += w[a] * X[a];
  if (!(W > 0)) return std::nullopt;
  c /= W;
  Mat3 T = Mat3::Zero();
  for (size_t a = 0; a < X.size(); ++a) {
    const Vec3 r = X[a] - c;
    T += w[a] * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
  }
  for (const double of_turn : v) T += of_turn * Mat3::Identity();
  const Vec3 moment = M + (at - c).cross(F);
  MeanShares out;
  if (moment.norm() > 1e-12 * (M.norm() + (at - c).norm() * F.norm())) {
    out.turn = T.completeOrthogonalDecomposition().solve(moment);
    if (!((T * out.turn - moment).norm() < 1e-9 * moment.norm())) return std::nullopt;
  }
  for (size_t a = 0; a < X.size(); ++a) out.forces.push_back(w[a] * (F / W + out.turn.cross(X[a] - c)));
  return out;
}

namespace {
/// Ascending: how far points spread along three axes, squared.
Vec3 spread(const std::vector<Vec3>& points) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& x : points) mean += x / static_cast<double>(points.size());
  Mat3 S = Mat3::Zero();
  for (const Vec3& x : points) S += (x - mean) * (x - mean).transpose();
  return Eigen::SelfAdjointEigenSolver<Mat3>(S).eigenvalues();
}
}  // namespace

bool on_a_line(const std::vector<Vec3>& points) {
  const Vec3 v = spread(points);
  return !(v[1] > 1e-10 * v[2]);
}

bool in_a_plane(const std::vector<Vec3>& points) {
  const Vec3 v = spread(points);
  return !(v[0] > 1e-10 * v[2]);
}

std::string massless_body(SceneWriter& scene, const std::string& name, const Vec3& at, const std::string& place) {
  scene.add("body", name, place, {{"mass", 0}, {"com", at}});
  return name;
}

std::string sliding_body(SceneWriter& scene, const std::string& name, const Vec3& axis, const Vec3& at, const std::string& place) {
  massless_body(scene, name, at, place);
  scene.add_unique({"joint", "prismatic"}, name, place, {{"b", name}, {"at", at}, {"axis", axis}});
  return name;
}

void add_turn(SceneWriter& scene, std::vector<SumTerm>& terms, const std::string& body, const Vec3& at, const Vec3& beside, const Vec3& way,
              const std::string& place) {
  const std::string of = scene.unique("body", body + "_turn");  // the ends of a sum are different bodies
  massless_body(scene, of, beside, place);
  scene.add_unique({"joint", "fixed"}, of, place, {{"a", body}, {"b", of}, {"at", beside}});
  terms.push_back({of, beside, way});
  terms.push_back({body, at, -way});
}

void joints_of_sum(SceneWriter& scene, const std::vector<SumTerm>& all, const std::string& name, const std::string& place) {
  std::vector<SumTerm> terms;  // one of each point, as the ends of a sum are different bodies
  for (const SumTerm& t : all) {
    const auto same = std::ranges::find_if(terms, [&](const SumTerm& s) { return s.end == t.end && s.at == t.at; });
    same == terms.end() ? terms.push_back(t) : void(same->way += t.way);
  }
  std::erase_if(terms, [](const SumTerm& t) { return t.way == Vec3::Zero(); });
  if (terms.empty()) return;
  if (terms.size() == 1) return joint_to_slide(scene, name, "", terms[0].end, terms[0].way.normalized(), terms[0].at, place);
  const auto row = [&](const SumTerm& a, const SumTerm& b, const SumTerm* c) {
    SceneTable& joint = scene.add_unique(
        {"joint", "weighted-sum"}, name, place,
        {{"a", a.end}, {"b", b.end}, {"at_a", a.at}, {"at_b", b.at}, {"axis_a", a.way.normalized()}, {"axis_b", b.way.normalized()}});
    if (c)
      joint.set("carrier", c->end).set("at_carrier", c->at).set("axis_carrier", c->way.normalized()).set("factor_carrier", c->way.norm());
    joint.set("factors", {a.way.norm(), b.way.norm()});
  };
  SumTerm first = terms[0];
  size_t next = 1;
  for (; terms.size() - next > 2; ++next) {
    const SumTerm sum{sliding_body(scene, scene.unique("body", name + "_sum"), Vec3::UnitX(), terms[0].at, place), terms[0].at,
                      -Vec3::UnitX()};
    row(first, terms[next], &sum);
    first = {sum.end, terms[0].at, Vec3::UnitX()};
  }
  row(first, terms[next], next + 1 < terms.size() ? &terms[next + 1] : nullptr);
}

void joint_to_slide(SceneWriter& scene, const std::string& name, const std::string& body, const std::string& node, const Vec3& axis,
                    const Vec3& at, const std::string& place) {
  scene.add_unique({"joint", "in-plane"}, name, place, {{"a", body}, {"b", node}, {"at", at}, {"axis", axis}});
  if (body.empty()) scene.supports.push_back({node, place, "", 0, Vec3::Zero(), axis});
}

}  // namespace hilo
