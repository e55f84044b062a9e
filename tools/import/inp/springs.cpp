// SPDX-License-Identifier: GPL-3.0-or-later
// A force along one component of a node has a fixed direction.  A body of no mass slides along it (prismatic joint) and the node stays in
// its plane (in-plane joint), so that the slide is the component.  Two of them, the second on the first, make a difference of components.
#include "import/inp/springs.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "base/error.hpp"
#include "base/param.hpp"
#include "import/links.hpp"

namespace hilo {
namespace {

std::string list(const Vec3& v) { return toml_list({v.x(), v.y(), v.z()}); }

bool along_line(const InpPointSpring& s) { return s.element.type.back() == 'A'; }

class PointSpring {
 public:
  PointSpring(const InpDeck& d, const Imported& in, const InpPointSpring& s, const ImportOptions& o)
      : d_(d), s_(s), o_(o), place_(s.element.place), name_(fmt::format("{}_{}", s.element.type, s.element.id)) {
    Eigen::AlignedBox3d box;
    for (const Vec3& x : in.mesh.X) box.extend(x);
    for (const auto& [id, body] : d.bodies) box.extend(body.X);
    for (const InpSpringEnd& e : s.ends) box.extend(e.X);
    size_ = box.diagonal().norm();
  }

  std::string text() {
    const size_t head = along_line(s_) ? 0 : 1;  // the line of components
    if (head > 0) axis_ = Vec3::Unit(static_cast<Eigen::Index>(s_.value.first[0]) - 1);
    if (s_.value.table)
      read_table(head);
    else
      value_ = s_.value.first.back();
    if (head == 0) return line();
    return s_.ends.size() == 1 ? to_ground() : between();
  }

 private:
  bool damps() const { return s_.value.name == "*DASHPOT"; }
  double si(const char* unit) const { return to_si(unit, o_.units); }
  std::string point(const Vec3& x) const { return list(Vec3(x * si("m") * o_.scale)); }

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

  std::string unique(std::string wish) const {
    const auto taken = [&] {
      const std::string key = upper(wish);
      return d_.nset.contains(key) || d_.elset.contains(key) ||
             std::ranges::any_of(d_.surfaces, [&](const InpSurface& s) { return upper(s.name) == key; });
    };
    while (taken()) wish += "_body";
    return wish;
  }

  /// A body of no mass that slides along the axis on `on`, and with the component of an end.
  std::string slider(const std::string& name, const std::string& on, const InpSpringEnd& e) const {
    std::string out = sliding_body(name, "", list(axis_), point(e.X), place_);
    out += fmt::format("\n[[joint]]   # {}\nkind = \"prismatic\"\nname = {}\na = {}\nb = {}\nat = {}\naxis = {}\n", place_,
                       toml_text(name + "_way"), toml_text(on), toml_text(name), point(e.X), list(axis_));
    return out + joint_to_slide(name + "_end", name, e.name, list(axis_), point(e.X), place_);
  }

  /// The force on the way of a slider, less that of its carrier.
  std::string force(const std::string& slide, const std::string& on, const Vec3& at_on, const Vec3& at) const {
    if (damps() && s_.value.table) return motor(slide + "_way");
    // far enough that the distance is the slide and a constant
    double far = 4 * size_ * si("m") * o_.scale;
    if (!x_.empty()) far += 10 * std::max(std::abs(x_.front()), std::abs(x_.back()));
    const double m = si("m") * o_.scale;
    const std::string ends =
        fmt::format("a = {}\nb = {}\nat_a = {}\nat_b = {}\n", toml_text(on), toml_text(slide), list(Vec3(at_on * m)),
                    list(Vec3(axis_.cwiseProduct(at * m) + (Vec3::Ones() - axis_).cwiseProduct(at_on * m) + far * axis_)));
    return law(ends);
  }
  std::string law(const std::string& ends) const {
    if (s_.value.table)
      return fmt::format("\n[[spring]]   # {}\nkind = \"curve\"\nname = {}\n{}extension = {}\nforce = {}\n", place_, toml_text(name_), ends,
                         toml_list(x_), toml_list(f_));
    return fmt::format("\n[[spring]]   # {}\nkind = \"axial\"\nname = {}\n{}{} = {}\n", place_, toml_text(name_), ends,
                       damps() ? "damping" : "stiffness", toml_number(value_ * si(damps() ? "N s/m" : "N/m")));
  }
  /// Constant beyond the table, as a table of the deck is: a motor goes on with the slope of its last two points.
  std::string motor(const std::string& joint) const {
    const double span = x_.back() - x_.front();
    std::vector<double> rate{x_.front() - span}, force{-f_.front()};
    for (size_t i = 0; i < x_.size(); ++i) rate.push_back(x_[i]), force.push_back(-f_[i]);
    rate.push_back(x_.back() + span), force.push_back(-f_.back());
    return fmt::format("\n[[motor]]   # {}\nkind = \"linear\"\nname = {}\njoint = {}\nrate = {}\nforce = {}\n", place_, toml_text(name_),
                       toml_text(joint), toml_list(rate), toml_list(force));
  }

  std::string to_ground() const {
    const InpSpringEnd& e = s_.ends[0];
    if (!s_.value.table && !damps())  // a joint that gives way has a stiffness
      return fmt::format("\n[[joint]]   # {}\nkind = \"in-plane\"\nname = {}\nb = {}\nat = {}\naxis = {}\nstiffness = {}\n", place_,
                         toml_text(name_), toml_text(e.name), point(e.X), list(axis_), toml_number(value_ * si("N/m")));
    const std::string slide = unique(name_ + "_slide");
    return slider(slide, "ground", e) + force(slide, "ground", e.X, e.X);
  }

  /// Extension: the component of the first node less that of the second.
  std::string between() const {
    const InpSpringEnd &e = s_.ends[0], &f = s_.ends[1];
    if (!s_.value.table) {
      const Vec3 way = f.X - e.X;
      const bool together = way.norm() <= 1e-9 * (e.X.norm() + f.X.norm());
      if (together && !damps())
        return fmt::format("\n[[joint]]   # {}\nkind = \"in-plane\"\nname = {}\na = {}\nb = {}\nat = {}\naxis = {}\nstiffness = {}\n",
                           place_, toml_text(name_), toml_text(e.name), toml_text(f.name), point(e.X), list(axis_),
                           toml_number(value_ * si("N/m")));
      if (!together && way.cross(axis_).norm() <= 1e-9 * way.norm())
        return law(fmt::format("a = {}\nb = {}\nat_a = {}\nat_b = {}\n", toml_text(e.name), toml_text(f.name), point(e.X), point(f.X)));
    }
    const std::string carrier = unique(name_ + "_slide"), slide = unique(name_ + "_slide_2");
    return slider(carrier, "ground", f) + slider(slide, carrier, e) + force(slide, carrier, f.X, e.X);
  }

  /// Along the line of two nodes.
  std::string line() const {
    const InpSpringEnd &a = s_.ends[0], &b = s_.ends[1];
    const Vec3 way = b.X - a.X;
    if (!(way.norm() > 0)) throw Error(place_, fmt::format("{} {} has no length", s_.element.type, s_.element.id));
    if (!(damps() && s_.value.table))
      return law(fmt::format("a = {}\nb = {}\nat_a = {}\nat_b = {}\n", toml_text(a.name), toml_text(b.name), point(a.X), point(b.X)));
    // a cylinder and a rod of no mass: a body carries the one by two axes, the other hangs on its point
    const InpSpringEnd &base = a.turns ? a : b, &tip = a.turns ? b : a;
    const Vec3 along = (tip.X - base.X).normalized(), across = along.unitOrthogonal(), third = along.cross(across);
    const std::string cylinder = unique(name_ + "_cylinder"), rod = unique(name_ + "_rod");
    std::string out = sliding_body(cylinder, "", "", point(base.X), place_) + sliding_body(rod, "", "", point(tip.X), place_);
    out += fmt::format("\n[[joint]]   # {}\nkind = \"universal\"\nname = {}\na = {}\nb = {}\nat = {}\naxis = {}\nx = {}\n", place_,
                       toml_text(cylinder), toml_text(base.name), toml_text(cylinder), point(base.X), list(across), list(third));
    out += fmt::format("\n[[joint]]   # {}\nkind = \"prismatic\"\nname = {}\na = {}\nb = {}\nat = {}\naxis = {}\n", place_,
                       toml_text(rod + "_way"), toml_text(cylinder), toml_text(rod), point(tip.X), list(along));
    out += fmt::format("\n[[joint]]   # {}\nkind = \"spherical\"\nname = {}\na = {}\nb = {}\nat = {}\n", place_, toml_text(rod),
                       toml_text(rod), toml_text(tip.name), point(tip.X));
    return out + motor(rod + "_way");
  }

  const InpDeck& d_;
  const InpPointSpring& s_;
  const ImportOptions& o_;
  std::string place_, name_;
  double size_ = 0, value_ = 0;
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

std::string write_point_spring(const InpDeck& deck, const Imported& in, const InpPointSpring& spring, const ImportOptions& options) {
  return PointSpring(deck, in, spring, options).text();
}

}  // namespace hilo
