// SPDX-License-Identifier: GPL-3.0-or-later
// The cards of an .inp deck that make nodes and elements of others: *NGEN along a line or an arc, *NFILL between two sets of nodes, *NCOPY
// elsewhere, *ELGEN as rows and layers of one element, *ELCOPY on other nodes [Abaqus keywords].
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "import/inp/card.hpp"

namespace hilo {
namespace {

/// All that a deck may generate: a line of text must not fill the memory.
constexpr std::int64_t most_generated = 5'000'000;
constexpr const char* too_many = "is a number wrong?";

/// How many, from 1 on.
std::int64_t count_of(const DataLine& l, size_t field, const char* what) {
  const auto n = l.integer(field, 1);
  if (n < 1 || n > most_generated) throw Error(l.place(field), fmt::format("{} {}", n, what), fmt::format("1 to {}", most_generated));
  return n;
}

void count(InpReading& r, std::int64_t more, const std::string& place) {
  r.deck.generated += more;
  if (r.deck.generated > most_generated)
    throw Error(place, fmt::format("{} generates more than {} nodes and elements", r.card.name, most_generated), too_many);
}

std::int64_t last_number(const InpDeck& d) { return (d.shift ? instance_numbers : assembly_numbers) - 1; }

/// The number of a node that is there.
std::int64_t known_node(const InpReading& r, const DataLine& l, size_t field) {
  const auto id = l.integer(field);
  if (id < 1 || id > last_number(r.deck) || !r.deck.node.contains(id + r.deck.node_shift()))
    throw Error(l.place(field), fmt::format("{}: no node {} so far", r.card.name, id), "*NODE gives it before");
  return id + r.deck.node_shift();
}
const Vec3& place_of(const InpDeck& d, std::int64_t node) { return d.X[static_cast<size_t>(d.node.at(node))]; }

/// A step of numbers.
std::int64_t step_of(const DataLine& l, size_t field) {
  const auto by = l.integer(field, 1);
  if (by < -instance_numbers || by > instance_numbers)
    throw Error(l.place(field), fmt::format("a step of {} between numbers", by), too_many);
  return by;
}

/// A node; one that is there already must be at this place.
void add_node(InpReading& r, std::int64_t id, const Vec3& x, double size, const std::string& place) {
  InpDeck& d = r.deck;
  if (id < 1 || id > last_number(d)) throw Error(place, fmt::format("{}: node number {} is not one", r.card.name, id));
  id += d.node_shift();
  const auto [at, fresh] = d.node.try_emplace(id, static_cast<std::int64_t>(d.X.size()));
  if (fresh) {
    d.X.push_back(x);
    d.node_id.push_back(id);
  } else if ((d.X[static_cast<size_t>(at->second)] - x).norm() > 1e-6 * size)
    throw Error(place, fmt::format("{} generates node {}, which is there at another place", r.card.name, id - d.node_shift()),
                "number each node once");
}

/// The point of the line from a to b at a share of it: straight, or on the arc or parabola of the extra point.
class Line {
 public:
  Line(const InpReading& r, const DataLine& l, const Vec3& a, const Vec3& b) : a_(a), b_(b), kind_(r.card.word("LINE")) {
    if (kind_.empty()) return;
    const std::string system = r.card.word("SYSTEM");
    extra_ = l.empty(3) ? l.vector(4) : place_of(r.deck, known_node(r, l, 3));
    if (l.empty(3) && l.empty(4) && l.empty(5) && l.empty(6))
      throw Error(l.place(3), fmt::format("*NGEN, LINE={} has no extra point", kind_), kind_ == "C" ? "the centre" : "the middle");
    if (l.empty(3) && system == "C") {
      const double t = extra_[1] * std::numbers::pi / 180;
      extra_ = Vec3(extra_[0] * std::cos(t), extra_[0] * std::sin(t), extra_[2]);
    }
    if (kind_ == "C") arc(l);
  }
  Vec3 at(double share) const {
    if (kind_ == "C") return extra_ + Eigen::AngleAxisd(share * angle_, axis_) * (a_ - extra_) * (1 + share * growth_);
    if (kind_ == "P")  // through a, the extra point in the middle, and b
      return (1 - share) * (1 - 2 * share) * a_ + 4 * share * (1 - share) * extra_ + share * (2 * share - 1) * b_;
    return a_ + share * (b_ - a_);
  }

 private:
  void arc(const DataLine& l) {
    const Vec3 u = a_ - extra_, v = b_ - extra_;
    const Vec3 normal = l.vector(7);
    if (!(u.norm() > 0) || !(std::abs(u.norm() - v.norm()) <= 1e-3 * u.norm()))
      throw Error(l.place(l.empty(3) ? 4 : 3), fmt::format("*NGEN, LINE=C: the ends are {:g} and {:g} from the centre", u.norm(), v.norm()),
                  "an arc has one radius");
    growth_ = v.norm() / u.norm() - 1;
    const Vec3 across = u.cross(v);
    const bool straight = !(across.norm() > 1e-8 * u.norm() * v.norm());
    if (normal.norm() > 0) {
      axis_ = normal.normalized();
      if (std::abs(axis_.dot(u)) > 1e-3 * u.norm() || std::abs(axis_.dot(v)) > 1e-3 * v.norm())
        throw Error(l.place(7), "*NGEN, LINE=C: the normal is not that of the arc's plane");
      angle_ = std::atan2(across.dot(axis_), u.dot(v));
      if (angle_ <= 1e-9) angle_ += 2 * std::numbers::pi;
      if (a_ == b_) angle_ = 2 * std::numbers::pi;
    } else if (straight) {
      throw Error(l.place(7), "*NGEN, LINE=C: the ends and the centre are on a line", "give the normal of the arc, in fields 8 to 10");
    } else {
      axis_ = across.normalized();
      angle_ = std::atan2(across.norm(), u.dot(v));
    }
  }

  Vec3 a_, b_, extra_ = Vec3::Zero(), axis_ = Vec3::UnitZ();
  double angle_ = 0, growth_ = 0;
  std::string kind_;
};

/// First node, last node, step of the numbers, extra node or its three coordinates, normal of an arc of half a turn and more.
void read_ngen(InpReading& r) {
  const Card& card = r.card;
  InpDeck& d = r.deck;
  require_known(card, {"NSET", "LINE", "SYSTEM"}, "write the nodes out");
  const std::string line = card.word("LINE"), system = card.word("SYSTEM");
  if (!line.empty() && line != "C" && line != "P") throw Error(card.place("LINE"), "*NGEN, LINE=" + line, "C, an arc, or P, a parabola");
  if (!system.empty() && system != "RC" && system != "C")
    throw Error(card.place("SYSTEM"), fmt::format("*NGEN, SYSTEM={} is not read", system), "RC or C, or a node as the extra point");
  InpSet* set = card.has("NSET") ? &set_of_nodes(card.need("NSET"), d) : nullptr;
  for (DataLine l; r.lines.next_data(l);) {
    const auto from = known_node(r, l, 0), to = known_node(r, l, 1), by = step_of(l, 2);
    const auto first = from - d.node_shift(), last = to - d.node_shift();
    const Vec3 a = place_of(d, from), b = place_of(d, to);  // copies: the nodes that follow move them
    if (by == 0 || (last - first) % by != 0 || (last - first) / by < 1)
      throw Error(l.place(2), fmt::format("*NGEN: steps of {} do not lead from {} to {}", by, first, last));
    const auto n = (last - first) / by;
    count(r, n, l.place());
    const Line points(r, l, a, b);
    const double size = std::max(a.norm(), b.norm()) + (b - a).norm();
    for (std::int64_t i = 1; i < n; ++i)
      add_node(r, first + i * by, points.at(static_cast<double>(i) / static_cast<double>(n)), size, l.place());
    if (set)
      for (std::int64_t i = 0; i <= n; ++i) set->members.push_back(first + i * by + d.node_shift());
  }
}

/// The set of a name that stands before, in this instance or outside of it.
const InpSet& earlier_set(const InpReading& r, const std::map<std::string, InpSet>& sets, const std::string& name, const char* kind,
                          const std::string& place) {
  auto set = sets.find(upper(r.deck.prefix) + upper(name));
  if (set == sets.end()) set = sets.find(upper(name));
  if (set == sets.end()) throw Error(place, fmt::format("{}: no {} \"{}\" so far", r.card.name, kind, name), suggest_name(name, sets));
  return set->second;
}

/// The nodes of a set as *NFILL goes through them: by number, where the deck does not say UNSORTED.
std::vector<std::int64_t> bound(const InpReading& r, const DataLine& l, size_t field) {
  const InpDeck& d = r.deck;
  if (l.is_integer(field)) return {known_node(r, l, field)};
  const InpSet& set = earlier_set(r, d.nset, std::string(l.text(field)), "node set", l.place(field));
  std::vector<std::int64_t> ids = set.members;
  if (!set.unsorted) sort_unique(ids);
  for (const auto id : ids)
    if (!d.node.contains(id))
      throw Error(l.place(field), fmt::format("*NFILL: no node {} of set \"{}\" so far", id - d.node_shift(), set.name));
  if (ids.empty()) throw Error(l.place(field), fmt::format("*NFILL: node set \"{}\" is empty", set.name));
  return ids;
}

/// Shares of the way from the first bound to the second: each length is that before it divided by BIAS; with TWO STEP, each pair of them.
std::vector<double> shares(const InpReading& r, std::int64_t n) {
  double bias = 1;
  if (r.card.has("BIAS")) {
    const std::string text = r.card.need("BIAS");
    const DataLine one{r.card.file, r.card.line, {{text, 1}}};
    bias = one.number(0);
    if (!(bias > 0) || !std::isfinite(bias)) throw Error(r.card.place("BIAS"), fmt::format("*NFILL, BIAS={}", text), "a number above zero");
  }
  std::vector<double> x{0};
  const bool two = r.card.has("TWOSTEP");
  double length = 1;
  for (std::int64_t i = 0; i < n; ++i) {
    x.push_back(x.back() + length);
    if (!two || i % 2 == 1) length /= bias;
  }
  if (!std::isfinite(x.back()) || !(x[static_cast<size_t>(n) - 1] < x.back()))
    throw Error(r.card.place("BIAS"), fmt::format("*NFILL, BIAS={:g}, leaves no room for {} intervals", bias, n), "a BIAS nearer to 1");
  for (double& s : x) s /= x[static_cast<size_t>(n)];
  return x;
}

/// First set, second set, intervals between them, step of the numbers.
void read_nfill(InpReading& r) {
  const Card& card = r.card;
  InpDeck& d = r.deck;
  require_known(card, {"NSET", "BIAS", "TWOSTEP"}, "write the nodes out");
  InpSet* set = card.has("NSET") ? &set_of_nodes(card.need("NSET"), d) : nullptr;
  for (DataLine l; r.lines.next_data(l);) {
    const auto from = bound(r, l, 0), to = bound(r, l, 1);
    const auto n = count_of(l, 2, "intervals of *NFILL"), by = step_of(l, 3);
    if (from.size() != to.size())
      throw Error(l.place(), fmt::format("*NFILL: {} nodes in \"{}\", {} in \"{}\"", from.size(), l.text(0), to.size(), l.text(1)),
                  "as many in both");
    if (by == 0 && n > 1) throw Error(l.place(3), "*NFILL: a step of 0 between node numbers");
    for (size_t k = 0; k < from.size(); ++k) count(r, n, l.place());
    const auto x = shares(r, n);
    for (size_t k = 0; k < from.size(); ++k) {
      const Vec3 a = place_of(d, from[k]), b = place_of(d, to[k]);
      const double size = std::max(a.norm(), b.norm()) + (b - a).norm();
      for (std::int64_t i = 1; i < n; ++i)
        add_node(r, from[k] - d.node_shift() + i * by, a + x[static_cast<size_t>(i)] * (b - a), size, l.place());
      if (!set) continue;
      for (std::int64_t i = 0; i < n; ++i) set->members.push_back(from[k] + i * by);
      set->members.push_back(to[k]);
    }
  }
}

/// The element `from` once more, with its nodes moved on.
void copy_element(InpReading& r, std::int64_t from, std::int64_t by, std::int64_t nodes_by, const DataLine& l) {
  InpDeck& d = r.deck;
  const auto id = from + by;
  if (id - d.shift < 1 || id - d.shift > last_number(d))
    throw Error(l.place(0), fmt::format("{}: element number {} is not one", r.card.name, id - d.shift));
  if (d.has_element(id))
    throw Error(l.place(0), fmt::format("{} generates element {}, which is there already", r.card.name, id - d.shift),
                "number each element once");
  const std::string* file = &*d.files.insert(*l.file).first;
  if (const auto b = d.beams.find(from); b != d.beams.end()) {
    if (d.towards.contains(from))
      throw Error(l.place(0),
                  fmt::format("{} of element {}, which has a node of its orientation: that of its copies is not clear", r.card.name,
                              from - d.shift),
                  "write the elements out");
    InpBeam beam = b->second;
    beam.id = id, beam.place = l.place(0), beam.file = file, beam.line = l.line;
    for (auto& node : beam.nodes) node += nodes_by;
    d.beams.emplace(id, std::move(beam));
    return;
  }
  if (const auto p = d.points.find(from); p != d.points.end()) {
    InpPoint point = p->second;
    point.id = id, point.place = l.place(0);
    for (auto& node : point.nodes) node += nodes_by;
    d.points.emplace(id, std::move(point));
    return;
  }
  const bool pyramid = d.pyramids.contains(from);
  for (const auto half : {std::int64_t{0}, second_half}) {
    if (half != 0 && !pyramid) break;
    const auto c = static_cast<size_t>(d.cell.at(from + half));
    std::vector<std::int64_t> nodes(d.cell_nodes.begin() + d.offset[c], d.cell_nodes.begin() + d.offset[c + 1]);
    for (auto& node : nodes) node += nodes_by;
    d.add_cell(id + half, static_cast<Shape>(d.shape[c]), nodes, file, l.line);
    if (pyramid) d.pyramids.insert(id + half);
  }
}

/// An element; of its row, of the rows and of the layers: how many, step of the node numbers, step of the element numbers.
void read_elgen(InpReading& r) {
  const Card& card = r.card;
  InpDeck& d = r.deck;
  require_known(card, {"ELSET", "ALLNODES"}, "write the elements out");
  InpSet* set = card.has("ELSET") ? &set_of_cells(card.need("ELSET"), d) : nullptr;
  for (DataLine l; r.lines.next_data(l);) {
    const auto number = l.integer(0), master = number < 0 || number > last_number(d) ? 0 : number + d.shift;
    if (!d.has_element(master)) throw Error(l.place(0), fmt::format("*ELGEN: no element {} so far", number), "*ELEMENT gives it before");
    std::array<std::int64_t, 3> n, nodes, numbers;
    std::int64_t all = 1;
    for (size_t k = 0; k < 3; ++k) {
      static constexpr const char* what[] = {"elements in a row of *ELGEN", "rows of *ELGEN", "layers of *ELGEN"};
      n[k] = count_of(l, 3 * k + 1, what[k]);
      all *= n[k];
      if (all > most_generated)
        throw Error(l.place(3 * k + 1), fmt::format("*ELGEN generates more than {} elements", most_generated), too_many);
      if (k > 0 && n[k] > 1)
        for (const size_t field : {3 * k + 2, 3 * k + 3})
          if (l.empty(field))
            throw Error(l.place(field), fmt::format("*ELGEN: {} {}, without a step of {}", n[k], k == 1 ? "rows" : "layers",
                                                    field == 3 * k + 2 ? "node numbers" : "element numbers"));
      nodes[k] = step_of(l, 3 * k + 2), numbers[k] = step_of(l, 3 * k + 3);
    }
    count(r, all, l.place());
    for (std::int64_t k = 0; k < n[2]; ++k)
      for (std::int64_t j = 0; j < n[1]; ++j)
        for (std::int64_t i = 0; i < n[0]; ++i) {
          const auto by = i * numbers[0] + j * numbers[1] + k * numbers[2];
          if (i > 0 || j > 0 || k > 0) copy_element(r, master, by, i * nodes[0] + j * nodes[1] + k * nodes[2], l);
          if (set) set->members.push_back(master + by);
        }
  }
}

/// A whole number of a parameter.
std::int64_t number_of(const Card& card, const char* key, std::int64_t fallback) {
  if (!card.has(key)) return fallback;
  const auto n = card.integer(key);
  if (n < -instance_numbers || n > instance_numbers) throw Error(card.place(key), fmt::format("{}: {}", card.name, n), too_many);
  return n;
}

/// What a copy does to a point: x -> A x + b.
struct Copied {
  Mat3 A = Mat3::Identity();
  Vec3 b = Vec3::Zero();
};

/// A way and a turn about an axis; or the image in a point, a line or a plane of three points.
Copied copied_by(InpReading& r) {
  const Card& card = r.card;
  Copied c;
  DataLine l;
  if (card.has("SHIFT")) {
    while (r.lines.next_data(l)) {
      if (l.fields.size() <= 3) {
        c.b += l.vector(0);
        continue;
      }
      const Vec3 at = l.vector(0), axis = l.vector(3) - at;
      if (!(axis.norm() > 0)) throw Error(l.place(3), "*NCOPY: the two points of its axis are one");
      const Mat3 turn = Eigen::AngleAxisd(l.number(6) * std::numbers::pi / 180, axis.normalized()).toRotationMatrix();
      c = {turn * c.A, at + turn * (c.b - at)};
    }
    return c;
  }
  const std::string kind = card.word("REFLECT");
  if (kind != "POINT" && kind != "LINE" && kind != "MIRROR")
    throw Error(card.place("REFLECT"), "*NCOPY, REFLECT=" + kind, "POINT, LINE or MIRROR");
  std::vector<double> x;
  std::string place = card.place();
  while (r.lines.next_data(l)) {
    place = l.place();
    for (size_t i = 0; i < l.fields.size(); ++i) x.push_back(l.number(i));
  }
  const size_t due = kind == "POINT" ? 3 : kind == "LINE" ? 6 : 9;
  if (x.size() != due) throw Error(place, fmt::format("*NCOPY, REFLECT={}: {} numbers", kind, x.size()), fmt::format("{}", due));
  const auto at = [&](size_t i) { return Vec3(x[3 * i], x[3 * i + 1], x[3 * i + 2]); };
  const Vec3 a = at(0), u = due > 3 ? Vec3(at(1) - a) : Vec3(Vec3::Zero()), n = due > 6 ? Vec3(u.cross(at(2) - a)) : u;
  if (due > 3 && !(n.norm() > 1e-9 * u.norm() * (due > 6 ? (at(2) - a).norm() : 1.) && n.norm() > 0))
    throw Error(place, fmt::format("*NCOPY, REFLECT={}: its points are {}", kind, due > 6 ? "on a line" : "one"));
  if (kind == "POINT")
    c.A = -Mat3::Identity();
  else if (kind == "LINE")
    c.A = 2 * n.normalized() * n.normalized().transpose() - Mat3::Identity();
  else
    c.A = Mat3::Identity() - 2 * n.normalized() * n.normalized().transpose();
  c.b = a - c.A * a;
  return c;
}

/// The set that a card copies.
const InpSet& set_to_copy(const InpReading& r, const std::map<std::string, InpSet>& sets) {
  return earlier_set(r, sets, r.card.need("OLDSET"), "set", r.card.place("OLDSET"));
}

void read_ncopy(InpReading& r) {
  const Card card = r.card;
  InpDeck& d = r.deck;
  require_known(card, {"OLDSET", "CHANGENUMBER", "NEWSET", "SHIFT", "REFLECT", "MULTIPLE"}, "write the nodes out");
  card.need("CHANGENUMBER");
  if (card.has("SHIFT") == card.has("REFLECT")) throw Error(card.place() + ":1", "*NCOPY: SHIFT or REFLECT is due");
  const auto by = number_of(card, "CHANGENUMBER", 0), times = number_of(card, "MULTIPLE", 1);
  if (times < 1 || times > most_generated || (card.has("REFLECT") && times > 1))
    throw Error(card.place("MULTIPLE"), fmt::format("*NCOPY, MULTIPLE={}", times));
  const std::vector<std::int64_t> ids = set_to_copy(r, d.nset).members;
  InpSet* set = card.has("NEWSET") ? &set_of_nodes(d.prefix + card.need("NEWSET"), d) : nullptr;
  const Copied c = copied_by(r);
  for (size_t k = 0; k < ids.size(); ++k) count(r, times, card.place());
  for (const auto id : ids) {
    if (!d.node.contains(id)) throw Error(card.place("OLDSET"), fmt::format("*NCOPY: no node {} so far", id - d.node_shift()));
    Vec3 x = place_of(d, id);
    const double size = x.norm() + (c.A * x + c.b).norm();
    for (std::int64_t k = 1; k <= times; ++k) {
      x = c.A * x + c.b;
      add_node(r, id - d.node_shift() + k * by, x, size, card.place());
      if (set) set->members.push_back(id + k * by);
    }
  }
}

void read_elcopy(InpReading& r) {
  const Card& card = r.card;
  InpDeck& d = r.deck;
  require_known(card, {"OLDSET", "ELEMENTSHIFT", "SHIFTNODES", "NEWSET"}, "write the elements out");
  card.need("ELEMENTSHIFT"), card.need("SHIFTNODES");
  const auto by = number_of(card, "ELEMENTSHIFT", 0), nodes_by = number_of(card, "SHIFTNODES", 0);
  const std::vector<std::int64_t> ids = set_to_copy(r, d.elset).members;
  InpSet* set = card.has("NEWSET") ? &set_of_cells(d.prefix + card.need("NEWSET"), d) : nullptr;
  const DataLine here{card.file, card.line, {{card.name, 1}}};
  count(r, static_cast<std::int64_t>(ids.size()), card.place());
  for (const auto id : ids) {
    if (!d.has_element(id)) throw Error(card.place("OLDSET"), fmt::format("*ELCOPY: no element {} so far", id - d.shift));
    copy_element(r, id, by, nodes_by, here);
    if (set) set->members.push_back(id + by);
  }
}

}  // namespace

std::vector<InpCard> inp_generate_cards() {
  return {{"NGEN", read_ngen}, {"NFILL", read_nfill}, {"ELGEN", read_elgen}, {"NCOPY", read_ncopy}, {"ELCOPY", read_elcopy}};
}

}  // namespace hilo
