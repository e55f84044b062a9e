// SPDX-License-Identifier: GPL-3.0-or-later
// A force along one component of a node has a fixed direction.  A body of no mass slides along it (prismatic joint) and the node stays in
// its plane (in-plane joint), so that the slide is the component.  Two of them, the second on the first, make a difference of components.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "base/error.hpp"
#include "import/inp/passes.hpp"
#include "import/links.hpp"

namespace hilo {
namespace {

bool along_line(const InpPointSpring& s) { return s.element.type.back() == 'A'; }

class PointSpring {
 public:
  PointSpring(const InpDeck& d, double size, const InpPointSpring& s, const ImportOptions& o, SceneWriter& scene)
      : d_(d),
        s_(s),
        o_(o),
        scene_(scene),
        place_(s.element.place),
        name_(fmt::format("{}_{}", s.element.type, s.element.id)),
        size_(size) {}

  void write() {
    const size_t head = along_line(s_) ? 0 : 1;  // the line of components
    if (head > 0) axis_ = Vec3::Unit(static_cast<Eigen::Index>(s_.value.first[0]) - 1);
    if (s_.value.table)
      read_table(head);
    else
      value_ = s_.value.first.back();
    if (head == 0) return line();
    s_.ends.size() == 1 ? to_ground() : between();
  }

 private:
  bool damps() const { return s_.value.name == "*DASHPOT"; }
  double si(const char* unit) const { return o_.si(unit); }
  Vec3 point(const Vec3& x) const { return o_.point(x); }

  /// Force and extension, or force and rate of extension, on each line.
  void read_table(size_t head) {
    std::vector<std::pair<double, double>> points;
    for (size_t i = head; i < s_.value.first.size(); ++i)
      points.emplace_back(s_.value.second[i] * si(damps() ? "m/s" : "m"), s_.value.first[i] * si("N"));
    std::ranges::sort(points);
    for (const auto& [x, f] : points) x_.push_back(x), f_.push_back(f);
    if (points.size() < 2 || std::ranges::adjacent_find(x_) != x_.end())
      throw Error(
          s_.value.place,
          fmt::format("{}, NONLINEAR: two forces at least, at {} that differ", s_.value.name, damps() ? "velocities" : "extensions"),
          damps() ? "force, velocity" : "force, extension");
  }

  std::string unique(const std::string& wish) const { return free_body_name(d_, wish); }

  /// A body of no mass that slides along the axis on `on`, and with the component of an end.
  void slider(const std::string& name, const std::string& on, const InpSpringEnd& e) const {
    massless_body(scene_, name, point(e.X), place_);
    scene_.add({"joint", "prismatic"}, name + "_way", place_, {{"a", on}, {"b", name}, {"at", point(e.X)}, {"axis", axis_}});
    joint_to_slide(scene_, name + "_end", name, e.name, axis_, point(e.X), place_);
  }

  /// The force on the way of a slider, less that of its carrier.
  void force(const std::string& slide, const std::string& on, const Vec3& at_on, const Vec3& at) const {
    if (damps() && s_.value.table) return motor(slide + "_way");
    // far enough that the distance is the slide and a constant
    double far = 4 * size_ * si("m") * o_.scale;
    if (!x_.empty()) far += 10 * std::max(std::abs(x_.front()), std::abs(x_.back()));
    law(on, slide, point(at_on), axis_.cwiseProduct(point(at)) + (Vec3::Ones() - axis_).cwiseProduct(point(at_on)) + far * axis_);
  }
  void law(const std::string& a, const std::string& b, const Vec3& at_a, const Vec3& at_b) const {
    SceneTable& spring =
        scene_.add({"spring", s_.value.table ? "curve" : "axial"}, name_, place_, {{"a", a}, {"b", b}, {"at_a", at_a}, {"at_b", at_b}});
    if (s_.value.table)
      spring.set("extension", x_).set("force", f_);
    else
      spring.set(damps() ? "damping" : "stiffness", value_ * si(damps() ? "N s/m" : "N/m"));
  }
  void law(const InpSpringEnd& a, const InpSpringEnd& b) const { law(a.name, b.name, point(a.X), point(b.X)); }
  /// Constant beyond the table, as a table of the deck is: a motor goes on with the slope of its last two points.
  void motor(const std::string& joint) const {
    const double span = x_.back() - x_.front();
    std::vector<double> rate{x_.front() - span}, force{-f_.front()};
    for (size_t i = 0; i < x_.size(); ++i) rate.push_back(x_[i]), force.push_back(-f_[i]);
    rate.push_back(x_.back() + span), force.push_back(-f_.back());
    scene_.add({"motor", "linear"}, name_, place_, {{"joint", joint}, {"rate", rate}, {"force", force}});
  }
  /// A joint that gives way along the axis, to the ground where there is no a.
  void yielding(const std::string& a, const std::string& b) const {
    scene_.add({"joint", "in-plane"}, name_, place_,
               {{"a", a}, {"b", b}, {"at", point(s_.ends[0].X)}, {"axis", axis_}, {"stiffness", value_ * si("N/m")}});
  }

  void to_ground() const {
    const InpSpringEnd& e = s_.ends[0];
    if (!s_.value.table && !damps()) return yielding("", e.name);
    const std::string slide = unique(name_ + "_slide");
    slider(slide, "ground", e), force(slide, "ground", e.X, e.X);
  }

  /// Extension: the component of the first node less that of the second.
  void between() const {
    const InpSpringEnd &e = s_.ends[0], &f = s_.ends[1];
    if (!s_.value.table) {
      const Vec3 way = f.X - e.X;
      const bool together = way.norm() <= 1e-9 * (e.X.norm() + f.X.norm());
      if (together && !damps()) return yielding(e.name, f.name);
      if (!together && way.cross(axis_).norm() <= 1e-9 * way.norm()) return law(e, f);
    }
    const std::string carrier = unique(name_ + "_slide"), slide = unique(name_ + "_slide_2");
    slider(carrier, "ground", f), slider(slide, carrier, e), force(slide, carrier, f.X, e.X);
  }

  /// Along the line of two nodes.
  void line() const {
    const InpSpringEnd &a = s_.ends[0], &b = s_.ends[1];
    const Vec3 way = b.X - a.X;
    if (!(way.norm() > 0)) throw Error(place_, fmt::format("{} {} has no length", s_.element.type, s_.element.id));
    if (!(damps() && s_.value.table)) return law(a, b);
    // a cylinder and a rod of no mass: a body carries the one by two axes, the other hangs on its point
    const InpSpringEnd &base = a.turns ? a : b, &tip = a.turns ? b : a;
    const Vec3 along = (tip.X - base.X).normalized(), across = along.unitOrthogonal(), third = along.cross(across);
    const std::string cylinder = massless_body(scene_, unique(name_ + "_cylinder"), point(base.X), place_);
    const std::string rod = massless_body(scene_, unique(name_ + "_rod"), point(tip.X), place_);
    scene_.add({"joint", "universal"}, cylinder, place_,
               {{"a", base.name}, {"b", cylinder}, {"at", point(base.X)}, {"axis", across}, {"x", third}});
    scene_.add({"joint", "prismatic"}, rod + "_way", place_, {{"a", cylinder}, {"b", rod}, {"at", point(tip.X)}, {"axis", along}});
    scene_.add({"joint", "spherical"}, rod, place_, {{"a", rod}, {"b", tip.name}, {"at", point(tip.X)}});
    motor(rod + "_way");
  }

  const InpDeck& d_;
  const InpPointSpring& s_;
  const ImportOptions& o_;
  SceneWriter& scene_;
  std::string place_, name_;
  double size_, value_ = 0;
  Vec3 axis_ = Vec3::Zero();
  std::vector<double> x_, f_;
};

}  // namespace

std::string why_no_spring(const InpPointSpring& s) {
  const auto &first = s.value.first, &second = s.value.second;
  const auto why = [&](const char* what) { return s.value.name + (s.value.table ? ", NONLINEAR, of " : " of ") + s.element.type + what; };
  const size_t head = along_line(s) ? 0 : 1, values = first.size() - std::min(first.size(), head);
  if (values == 0) return why(" without a value");
  if (head > 0) {
    const double dof = first[0], other = s.ends.size() == 2 ? second[0] : dof;
    if (dof != other || !(dof == 1 || dof == 2 || dof == 3))
      return why(s.ends.size() == 2 ? ", but along one component of both nodes" : ", but along a component");
  }
  if (!s.value.table && values > 1) return s.value.name + " of several values";
  if (s.value.table && s.value.name == "*DASHPOT" && head == 0 && !s.ends[0].turns && !s.ends[1].turns)
    return why(" between two nodes that do not turn");
  return "";
}

void write_point_spring(const InpDeck& deck, double size, const InpPointSpring& spring, const ImportOptions& options, SceneWriter& scene) {
  PointSpring(deck, size, spring, options, scene).write();
}

}  // namespace hilo
