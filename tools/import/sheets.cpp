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
  explicit Finding(const Imported& in) : m_(in.mesh), piece_of_(in.piece_of) {
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
      if (is_smooth(sides) && turned_[sides[0].shell] == (turned_[sides[1].shell] != against(sides)))
        smooth_.insert(edge), join(sides[0], sides[1]);
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

  Vec3 normal(size_t shell) const { return (turned_[shell] ? -1 : 1) * shells_[shell].normal; }

  /// The turn from the edge of a shell, where the surface ends, to its normal, which is that of its middle: half of the turn to the next
  /// shell in the row, so that a pair at a plane of symmetry lies in it.  A bend that the third shell does not go on with is a corner.
  Vec3 turn_from_border(Side s) const {
    struct Facet {
      std::int64_t cell;
      Vec3 normal;
      double width;
    };
    std::vector<Facet> row;
    for (;;) {
      const Shell& shell = shells_[s.shell];
      if (shell.corners != 4) break;
      const auto n = m_.cell(shell.cell);
      const auto end = [&](int k) { return n[(s.k + k) % 4]; };
      const double width = (m_.X[end(2)] + m_.X[end(3)] - m_.X[end(0)] - m_.X[end(1)]).norm() / 2;
      const auto piece = piece_of_.find(shell.cell);
      const auto cell = piece == piece_of_.end() ? shell.cell : piece->second;
      if (!row.empty() && row.back().cell == cell)
        row.back().width += width;
      else if (row.size() == 3)
        break;
      else
        row.push_back({cell, normal(s.shell), width});
      const Edge far = std::minmax(end(2), end(3));
      if (!smooth_.contains(far)) break;
      const auto& sides = edges_.at(far);
      s = sides[sides[0].shell == s.shell ? 1 : 0];
    }
    if (row.size() < 3) return Vec3::Zero();
    const auto bend = [&](size_t i) {  // per length
      const Vec3 across = row[i].normal.cross(row[i + 1].normal);
      const double turn = std::atan2(across.norm(), row[i].normal.dot(row[i + 1].normal));
      return Vec3((turn > 1e-9 ? turn : 0) / ((row[i].width + row[i + 1].width) / 2) * across.normalized());
    };
    const Vec3 first = bend(0), second = bend(1);
    if (first.isZero(0)) return first;
    return std::clamp(second.dot(first) / first.squaredNorm(), 0.0, 1.0) * row[0].width / 2 * first;
  }

  /// The normal of a shell at one of its nodes.
  Vec3 normal_at(size_t shell, std::int64_t node) const {
    const int n = shells_[shell].corners;
    const auto nodes = m_.cell(shells_[shell].cell);
    const auto a = static_cast<int>(std::ranges::find(nodes, node) - nodes.begin());
    Vec3 turn = Vec3::Zero();
    for (const int k : {a % n, (a + n - 1) % n})
      if (k == a % n || a < n)
        if (const auto& sides = edges_.at(std::minmax(nodes[k], nodes[(k + 1) % n])); sides.size() == 1) turn += turn_from_border(sides[0]);
    if (turn.isZero(0)) return normal(shell);
    return Eigen::AngleAxisd(-turn.norm(), turn.normalized()) * normal(shell);
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
          for (const size_t s : of) p.cells.push_back(shells_[s].cell), p.normal += normal_at(s, node);
          p.normal.normalize();
          const auto n = m_.cell(shells_[of[0]].cell);
          p.thickness = thickness(of[0], static_cast<int>(std::ranges::find(n, node) - n.begin()));
          p.offset = (turned_[of[0]] ? -1 : 1) * shells_[of[0]].section->offset;
          return p;
        };
        Vec3 mean = Vec3::Zero();
        for (const size_t s : shells) mean += normal(s);
        mean.normalize();
        if (std::ranges::all_of(shells, [&](size_t s) { return normal(s).dot(mean) > std::cos(most_bend / 2); }))
          parts[shells[0]] = part(shells);
        else  // the tip of a cone: each on its own
          for (const size_t s : shells) parts[s] = part({s});
      }
      for (auto& [first, p] : parts) at[node].push_back(std::move(p));
    }
  }

  const Mesh& m_;
  const std::map<std::int64_t, std::int64_t>& piece_of_;
  std::vector<Shell> shells_;
  std::vector<bool> turned_;
  std::map<Edge, std::vector<Side>> edges_;
  std::set<Edge> smooth_;      // across which sheets go on
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
