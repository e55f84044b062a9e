// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/links.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <bit>

#include "base/error.hpp"
#include "import/deck_material.hpp"

namespace hilo {

std::optional<HoldingJoint> joint_that_holds(unsigned components) {
  const unsigned slides = components & 7, turns = components >> 3 & 7;
  const auto free = [](unsigned bits) { return std::countr_zero(7 & ~bits); };  // the axis that is not held
  const int n_slides = std::popcount(slides), n_turns = std::popcount(turns);
  if (slides == 7 && turns == 7) return HoldingJoint{"fixed", -1};
  if (slides == 7 && turns == 0) return HoldingJoint{"spherical", -1};
  if (slides == 7 && n_turns == 2) return HoldingJoint{"revolute", free(turns)};
  if (n_slides == 2 && turns == 7) return HoldingJoint{"prismatic", free(slides)};
  if (n_slides == 2 && turns == slides) return HoldingJoint{"cylindrical", free(slides)};
  if (n_slides == 1 && n_turns == 2 && (turns & slides) == 0) return HoldingJoint{"planar", std::countr_zero(slides)};
  if (n_slides == 1 && turns == 0) return HoldingJoint{"in-plane", std::countr_zero(slides)};
  if (n_slides == 2 && turns == 0) return HoldingJoint{"in-line", free(slides)};
  return std::nullopt;
}

std::string joints_that_hold(unsigned components, const Mat3& axes, const std::string& name, const std::string& a, const std::string& b,
                             const std::string& at, const std::string& place,
                             const std::function<std::string(const std::string&, const std::string&)>& unique) {
  struct Stage {
    const char* kind;
    int axis, x;
  };
  std::vector<Stage> stages;
  if (const auto one = joint_that_holds(components)) {
    stages.push_back({one->kind, one->axis, -1});
  } else if (components != 0) {
    const unsigned turns = components >> 3 & 7;
    const int held = std::countr_zero(turns);
    for (int k = 0; k < 3; ++k)
      if (!(components >> k & 1)) stages.push_back({"prismatic", k, -1});
    if (turns == 0)
      stages.push_back({"spherical", -1, -1});
    else if (std::popcount(turns) == 1)  // its cross bends about the two others
      stages.push_back({"universal", (held + 1) % 3, (held + 2) % 3});
    else if (std::popcount(turns) == 2)
      stages.push_back({"revolute", std::countr_zero(7 & ~turns), -1});
  }
  std::string out, from = a;
  for (size_t i = 0; i < stages.size(); ++i) {
    const Stage& s = stages[i];
    std::string to = b;
    if (i + 1 < stages.size()) {
      to = unique("body", name + "_slide");
      out += fmt::format("\n[[body]]   # {}\nname = {}\nmass = 0\ncom = {}\n", place, toml_text(to), at);
    }
    out += fmt::format("\n[[joint]]   # {}\nkind = \"{}\"\nname = {}\na = {}\nb = {}\nat = {}\n", place, s.kind,
                       toml_text(unique("joint", name)), toml_text(from), toml_text(to), at);
    const auto direction = [&](int k) { return toml_list({axes(0, k), axes(1, k), axes(2, k)}); };
    if (s.axis >= 0) out += fmt::format("axis = {}\n", direction(s.axis));
    if (s.x >= 0) out += fmt::format("x = {}\n", direction(s.x));
    from = to;
  }
  return out;
}

std::string motion_of_body(const std::string& name, const std::string& on, const Prescribed& by, const std::string& at,
                           const std::string& past, const std::string& place) {
  const std::string head = fmt::format("\n[[motion]]   # {}\nkind = \"{}\"\nname = {}\non = {}\n", place,
                                       !by.any()                 ? "fixed"
                                       : by.turn == Vec3::Zero() ? "translation"
                                                                 : "rotation",
                                       toml_text(name), toml_text(on));
  if (!by.any()) return head;
  if (by.turn == Vec3::Zero()) return head + fmt::format("displacement = {}\n", toml_list({by.way.x(), by.way.y(), by.way.z()})) + past;
  if (by.way != Vec3::Zero())
    throw Error(place, fmt::format("\"{}\" is moved and turned by given amounts, which is not read", on), "move it or turn it");
  const Vec3 axis = by.turn.normalized();
  return head +
         fmt::format("at = {}\naxis = {}\nangle = {}\n", at, toml_list({axis.x(), axis.y(), axis.z()}), toml_number(by.turn.norm())) + past;
}

std::string moving_body(const std::string& name, const Prescribed& by, const std::string& at, const std::string& past,
                        const std::string& place) {
  return fmt::format("\n[[body]]   # {}\nname = {}\nmass = 0.0\ncom = {}\n", place, toml_text(name), at) +
         motion_of_body(name, name, by, at, past, place);
}

std::optional<std::vector<Vec3>> shares_of_mean(const std::vector<Vec3>& X, const std::vector<double>& w, const Vec3& at, const Vec3& F,
                                                const Vec3& M) {
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
  const Vec3 moment = M + (at - c).cross(F);
  Vec3 turn = Vec3::Zero();
  if (moment.norm() > 1e-12 * (M.norm() + (at - c).norm() * F.norm())) {
    turn = T.completeOrthogonalDecomposition().solve(moment);
    if (!((T * turn - moment).norm() < 1e-9 * moment.norm())) return std::nullopt;
  }
  std::vector<Vec3> f;
  for (size_t a = 0; a < X.size(); ++a) f.push_back(w[a] * (F / W + turn.cross(X[a] - c)));
  return f;
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

std::string sliding_body(const std::string& name, const std::string& joint, const std::string& axis, const std::string& at,
                         const std::string& place) {
  std::string out = fmt::format("\n[[body]]   # {}\nname = {}\nmass = 0\ncom = {}\n", place, toml_text(name), at);
  if (!joint.empty())
    out += fmt::format("\n[[joint]]   # {}\nkind = \"prismatic\"\nname = {}\nb = {}\nat = {}\naxis = {}\n", place, toml_text(joint),
                       toml_text(name), at, axis);
  return out;
}

std::string joints_of_sum(const std::vector<SumTerm>& terms, const std::string& name, const std::string& place,
                          const std::function<std::string(const std::string& section, const std::string& wish)>& unique) {
  const auto list = [](const Vec3& v) { return toml_list({v.x(), v.y(), v.z()}); };
  if (terms.size() == 1)
    return fmt::format("\n[[joint]]   # {}\nkind = \"in-plane\"\nname = {}\nb = {}\nat = {}\naxis = {}\n", place,
                       toml_text(unique("joint", name)), toml_text(terms[0].end), terms[0].at, list(terms[0].way.normalized()));
  std::string out;
  const auto row = [&](const SumTerm& a, const SumTerm& b, const SumTerm* c) {
    out += fmt::format("\n[[joint]]   # {}\nkind = \"weighted-sum\"\nname = {}\na = {}\nb = {}\nat_a = {}\nat_b = {}\n", place,
                       toml_text(unique("joint", name)), toml_text(a.end), toml_text(b.end), a.at, b.at);
    out += fmt::format("axis_a = {}\naxis_b = {}\n", list(a.way.normalized()), list(b.way.normalized()));
    if (c) {
      out += fmt::format("carrier = {}\nat_carrier = {}\naxis_carrier = {}\n", toml_text(c->end), c->at, list(c->way.normalized()));
      out += fmt::format("factor_carrier = {}\n", toml_number(c->way.norm()));
    }
    out += fmt::format("factors = {}\n", toml_list({a.way.norm(), b.way.norm()}));
  };
  SumTerm first = terms[0];
  size_t next = 1;
  for (; terms.size() - next > 2; ++next) {
    const std::string body = unique("body", name + "_sum");
    out += sliding_body(body, unique("joint", body), "[1, 0, 0]", terms[0].at, place);
    const SumTerm sum{body, terms[0].at, -Vec3::UnitX()};
    row(first, terms[next], &sum);
    first = {body, terms[0].at, Vec3::UnitX()};
  }
  row(first, terms[next], next + 1 < terms.size() ? &terms[next + 1] : nullptr);
  return out;
}

std::string joint_to_slide(const std::string& name, const std::string& body, const std::string& node, const std::string& axis,
                           const std::string& at, const std::string& place) {
  return fmt::format("\n[[joint]]   # {}\nkind = \"in-plane\"\nname = {}\na = {}\nb = {}\nat = {}\naxis = {}\n", place, toml_text(name),
                     toml_text(body), toml_text(node), at, axis);
}

}  // namespace hilo
