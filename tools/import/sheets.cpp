// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/sheets.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <deque>

#include "base/joined.hpp"
#include "import/imported.hpp"

namespace hilo {
namespace {

/// Normals of neighbouring cells further apart than this make a fold [rad]; half of it is how far one may be from the mean at a node.
constexpr double most_bend = 40 * M_PI / 180;
/// Neighbours that enclose less lie on each other [rad].
constexpr double least_open = 10 * M_PI / 180;

using Edge = std::pair<std::int64_t, std::int64_t>;

struct Side {
  size_t shell;
  int k;  // local number of the first node
  bool forward;
};

struct Shell {
  std::int64_t cell;
  int corners;
  Vec3 normal;
  const ThinSection* section;
};

class Finding {
 public:
  explicit Finding(const Imported& in) : m_(in.mesh) {
    for (const auto& [c, section] : in.thin) {
      if (info(m_.shape[c]).dimension != 2) continue;
      const auto n = m_.cell(c);
      const int corners = info(m_.shape[c]).n_corners;
      const Vec3 across = corners == 3 ? (m_.X[n[1]] - m_.X[n[0]]).cross(m_.X[n[2]] - m_.X[n[0]])
                                       : (m_.X[n[2]] - m_.X[n[0]]).cross(m_.X[n[3]] - m_.X[n[1]]);
      shells_.push_back({c, corners, across.normalized(), &section});
    }
    first_.push_back(0);
    for (const Shell& s : shells_) first_.push_back(first_.back() + m_.cell(s.cell).size());
    joined_ = Joined<size_t>(first_.back());
  }

  void run(std::map<std::int64_t, bool>& turned, std::map<std::int64_t, std::vector<Sheets::Part>>& at, std::vector<std::int64_t>& folded) {
    list_edges();
    for (const auto& [edge, sides] : edges_)
      if (sides.size() == 2 && cosine(sides) < -std::cos(least_open)) folded.push_back(shells_[sides[1].shell].cell);
    turn_alike();
    for (const auto& [edge, sides] : edges_)
      if (is_smooth(sides) && turned_[sides[0].shell] == (turned_[sides[1].shell] != against(sides))) join(sides[0], sides[1]);
    for (size_t s = 0; s < shells_.size(); ++s) turned[shells_[s].cell] = turned_[s];
    collect(at);
  }

 private:
  void list_edges() {
    for (size_t s = 0; s < shells_.size(); ++s)
      for (int k = 0; k < shells_[s].corners; ++k) {
        const auto n = m_.cell(shells_[s].cell);
        const auto a = n[k], b = n[(k + 1) % shells_[s].corners];
        edges_[std::minmax(a, b)].push_back({s, k, a < b});
      }
  }
  /// Whether the two are numbered against each other.
  static bool against(const std::vector<Side>& sides) { return sides[0].forward == sides[1].forward; }

  /// Of the angle between the normals on one side.
  double cosine(const std::vector<Side>& sides) const {
    return (against(sides) ? -1 : 1) * shells_[sides[0].shell].normal.dot(shells_[sides[1].shell].normal);
  }
  double thickness(size_t shell, int local) const {
    return shells_[shell].section->thickness_at(static_cast<size_t>(local), static_cast<size_t>(shells_[shell].corners));
  }
  /// First and last node of an edge, as its numbers say, and the middle.
  int local(const Side& s, int which) const {
    const int n = shells_[s.shell].corners;
    if (which == 2) return n + s.k;
    return (which == 0) == s.forward ? s.k : (s.k + 1) % n;
  }
  bool is_smooth(const std::vector<Side>& sides) const {
    if (sides.size() != 2) return false;
    const Shell &a = shells_[sides[0].shell], &b = shells_[sides[1].shell];
    for (int which = 0; which < 2; ++which)
      if (thickness(sides[0].shell, local(sides[0], which)) != thickness(sides[1].shell, local(sides[1], which))) return false;
    return a.section->offset == (against(sides) ? -1 : 1) * b.section->offset && cosine(sides) > std::cos(most_bend);
  }

  /// Neighbours across smooth edges get their normals on the same side; where a sheet has one side alone, as a Moebius strip, an edge stays
  /// that no sheet goes across.
  void turn_alike() {
    std::vector<std::vector<std::pair<size_t, bool>>> beside(shells_.size());
    for (const auto& [edge, sides] : edges_)
      if (is_smooth(sides)) {
        beside[sides[0].shell].emplace_back(sides[1].shell, against(sides));
        beside[sides[1].shell].emplace_back(sides[0].shell, against(sides));
      }
    turned_.assign(shells_.size(), false);
    std::vector<char> seen(shells_.size(), 0);
    for (size_t start = 0; start < shells_.size(); ++start) {
      if (seen[start]) continue;
      std::deque<size_t> open{start};
      seen[start] = 1;
      while (!open.empty()) {
        const size_t s = open.front();
        open.pop_front();
        for (const auto& [other, turn] : beside[s])
          if (!seen[other]) seen[other] = 1, turned_[other] = turn != turned_[s], open.push_back(other);
      }
    }
  }

  size_t slot(size_t shell, int local) const { return first_[shell] + static_cast<size_t>(local); }
  void join(const Side& a, const Side& b) {
    for (int which = 0; which < 3; ++which) {
      if (which == 2 && (first_[a.shell + 1] - first_[a.shell] == static_cast<size_t>(shells_[a.shell].corners) ||
                         first_[b.shell + 1] - first_[b.shell] == static_cast<size_t>(shells_[b.shell].corners)))
        continue;
      joined_.join(slot(a.shell, local(a, which)), slot(b.shell, local(b, which)));
    }
  }

  void collect(std::map<std::int64_t, std::vector<Sheets::Part>>& at) {
    std::map<std::int64_t, std::map<size_t, std::vector<size_t>>> groups;  // node, root: shells
    for (size_t s = 0; s < shells_.size(); ++s) {
      const auto n = m_.cell(shells_[s].cell);
      for (size_t k = 0; k < n.size(); ++k) groups[n[k]][joined_.root(first_[s] + k)].push_back(s);
    }
    for (const auto& [node, by_root] : groups) {
      std::map<size_t, Sheets::Part> parts;  // by the first shell
      for (const auto& [root, shells] : by_root) {
        const auto part = [&](const std::vector<size_t>& of) {
          Sheets::Part p;
          for (const size_t s : of) p.cells.push_back(shells_[s].cell), p.normal += (turned_[s] ? -1 : 1) * shells_[s].normal;
          p.normal.normalize();
          const auto n = m_.cell(shells_[of[0]].cell);
          p.thickness = thickness(of[0], static_cast<int>(std::ranges::find(n, node) - n.begin()));
          p.offset = (turned_[of[0]] ? -1 : 1) * shells_[of[0]].section->offset;
          return p;
        };
        const auto whole = part(shells);
        bool is_one = true;
        for (const size_t s : shells)
          is_one = is_one && (turned_[s] ? -1 : 1) * shells_[s].normal.dot(whole.normal) > std::cos(most_bend / 2);
        if (is_one)
          parts[shells[0]] = whole;
        else  // the tip of a cone: each on its own
          for (const size_t s : shells) parts[s] = part({s});
      }
      for (auto& [first, p] : parts) at[node].push_back(std::move(p));
    }
  }

  const Mesh& m_;
  std::vector<Shell> shells_;
  std::vector<bool> turned_;
  std::map<Edge, std::vector<Side>> edges_;
  std::vector<size_t> first_;  // of the nodes of all shells, one after the other
  Joined<size_t> joined_{0};   // these nodes
};

}  // namespace

Sheets::Sheets(const Imported& in) { Finding(in).run(turned_, at_, folded_); }

const std::vector<Sheets::Part>& Sheets::at(std::int64_t node) const {
  static const std::vector<Part> none;
  const auto it = at_.find(node);
  return it == at_.end() ? none : it->second;
}

const std::vector<Sheets::Part>& sheets_at(const Imported& in, std::int64_t row) {
  static const std::vector<Sheets::Part> none;
  return in.sheets ? in.sheets->at(row) : none;
}

bool needs_body(const std::vector<Sheets::Part>& parts, const ShellSupport& s) {
  const bool bears = std::ranges::all_of(parts, [&](const Sheets::Part& p) { return bears_support(s.held, p.normal); });
  const bool whole = (s.held & 7) == 7;
  return !bears || s.turned || (!whole && (parts.size() > 1 || s.askew));
}

size_t count_nodes(const std::vector<Sheets::Part>& parts, bool of_solid) { return 2 * parts.size() + (of_solid ? 1 : 0); }

bool is_flat(const std::vector<Sheets::Part>& parts) {
  return std::ranges::all_of(parts, [&](const Sheets::Part& p) { return p.normal.cross(parts.front().normal).norm() < 1e-3; });
}

bool drop_drilling(const std::vector<Sheets::Part>& parts, Vec3& M) {
  const Vec3& n = parts.front().normal;
  const bool some = std::abs(M.dot(n)) > 1e-6 * M.norm();
  M -= n * n.dot(M);
  return some;
}

bool bears_support(unsigned held, const Vec3& n) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double lever = i == j ? 0 : std::abs(n[3 - i - j]);
      if (lever > 1e-3 && (held >> i & 1U) != (held >> (3 + j) & 1U)) return false;
    }
  return true;
}

}  // namespace hilo
