// SPDX-License-Identifier: GPL-3.0-or-later
// *MPC as scene lines.  Two nodes that keep their distance are a joint.  Nodes that stay on a line or in a plane have a body of no mass:
// the line or plane is fixed in it, and it goes and turns with the nodes, so that turns may be large.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "base/error.hpp"
#include "import/inp/scene.hpp"
#include "import/links.hpp"
#include "import/sheets.hpp"

namespace hilo {
namespace {

constexpr size_t most_nodes = 2000;  // a joint for each
constexpr double most_off = 1e-4;    // nodes off their line or plane as drawn, in lengths of it: digits of the deck
constexpr double no_width = 1e-6;    // below it nodes are on a line, or at one place

double off_line(const Vec3& x, const Vec3& from, const Vec3& along) { return along.cross(x - from).norm(); }

}  // namespace

/// Why a node cannot be one of an *MPC, or "".
std::string InpScene::why_no_end(const InpMpc& mpc, std::int64_t id) const {
  const auto row = d_.node.find(id);
  const bool body = d_.bodies.contains(id), of_cells = row != d_.node.end();
  if (!body && !of_cells && !d_.loose.contains(id)) throw Error(mpc.place, fmt::format("*MPC, {}: no node {}", mpc.kind, id));
  if (is_of_pairs(d_, in_, id)) return "of nodes of shells";
  if (body && mpc.kind == "BEAM") return "of a node that may turn, which Abaqus and CalculiX read differently";
  return body || of_cells ? "" : "of a node of no cell";
}

/// What joints of these nodes name; nothing where an end cannot be, which is told.
std::vector<InpScene::MpcEnd> InpScene::ends_of(const InpMpc& mpc, const std::vector<std::int64_t>& ids) {
  for (const auto id : ids)
    if (const auto why = why_no_end(mpc, id); !why.empty()) {
      in_.skip(fmt::format("*MPC, {} {}", mpc.kind, why), mpc.place);
      return {};
    }
  std::vector<MpcEnd> ends;
  for (const auto id : ids)
    if (const auto body = d_.bodies.find(id); body != d_.bodies.end())
      ends.push_back({body_name(d_, id), body->second.X, -1});
    else
      ends.push_back({"", in_.mesh.X[static_cast<size_t>(d_.node.at(id))], d_.node.at(id)});
  return ends;
}

void InpScene::keep_distances(const InpMpc& mpc) {
  std::vector<std::vector<std::int64_t>> of;
  for (const InpTarget& t : mpc.nodes) of.push_back(numbers_of(d_, t));
  if (of.size() == 1 && of[0].size() == 2) of = {{of[0][0]}, {of[0][1]}};
  if (of.size() != 2 || of[0].empty() || of[1].empty() || (of[0].size() != of[1].size() && of[0].size() != 1 && of[1].size() != 1))
    throw Error(mpc.place, fmt::format("*MPC, {} is between two nodes, or sets of as many nodes", mpc.kind), "name two");
  const size_t pairs = std::max(of[0].size(), of[1].size());
  if (pairs > most_nodes) return in_.skip(fmt::format("*MPC, {} of more than {} nodes", mpc.kind, most_nodes), mpc.place);
  std::vector<std::int64_t> ids;
  for (size_t i = 0; i < pairs; ++i)
    for (const auto& one : of) ids.push_back(one[std::min(i, one.size() - 1)]);
  auto ends = ends_of(mpc, ids);
  const double least = 1e-9 * size_of(d_, in_.mesh);
  for (size_t i = 0; i < ends.size(); i += 2)
    if (!((ends[i].X - ends[i + 1].X).norm() > least))
      return in_.skip(fmt::format("*MPC, {} of two nodes at one place", mpc.kind), mpc.place);
  for (MpcEnd& e : ends)
    if (e.name.empty()) e.name = end_of(e.row, "mpc");
  for (size_t i = 0; i < ends.size(); i += 2)
    scene_.add_unique({"joint", "distance"}, "mpc_distance", mpc.place,
                      {{"a", ends[i].name}, {"b", ends[i + 1].name}, {"at_a", point(ends[i].X)}, {"at_b", point(ends[i + 1].X)}});
}

/// Off a line through the first of the ends, the farthest node of solid cells at them; -1 where they are of none.
std::int64_t InpScene::row_beside(const std::vector<MpcEnd>& ends, const Vec3& along) {
  const Mesh& m = in_.mesh;
  if (a_cell_.empty()) {
    a_cell_.assign(m.X.size(), -1);
    for (std::int64_t c = 0; c < m.n_cells(); ++c)
      if (info(m.shape[c]).dimension == 3)
        for (const auto a : m.cell(c)) a_cell_[static_cast<size_t>(a)] = c;
  }
  std::int64_t best = -1;
  double most = 0;
  for (const MpcEnd& e : ends)
    if (const auto c = e.row < 0 ? -1 : a_cell_[static_cast<size_t>(e.row)]; c >= 0)
      for (const auto a : m.cell(c))
        if (const double off = off_line(m.X[static_cast<size_t>(a)], ends[0].X, along); off > most) best = a, most = off;
  return best;
}

/// The body has its point at the first node, its line through the farthest one, and its plane through the one farthest from that line: six
/// rows that the body needs, of which three say nothing of the nodes.  Each other node adds the rows of its own.
void InpScene::stay_together(const InpMpc& mpc) {
  const bool plane = mpc.kind == "PLANE";
  const auto skip = [&](const std::string& why) { in_.skip(fmt::format("*MPC, {} {}", mpc.kind, why), mpc.place); };
  std::vector<std::int64_t> ids;
  std::set<std::int64_t> seen;
  for (const InpTarget& t : mpc.nodes)
    for (const auto id : numbers_of(d_, t))
      if (seen.insert(id).second) ids.push_back(id);
  if (ids.size() <= (plane ? 3 : 2)) {
    in_.notes.push_back(fmt::format("{}: *MPC, {} of {} nodes says nothing", mpc.place, mpc.kind, ids.size()));
    return;
  }
  if (ids.size() > most_nodes) return skip(fmt::format("of more than {} nodes", most_nodes));
  std::vector<MpcEnd> ends = ends_of(mpc, ids);
  if (ends.empty()) return;
  const Vec3 origin = ends[0].X;
  const auto farthest = [&](const auto& distance) {
    return std::max_element(ends.begin(), ends.end(), [&](const MpcEnd& a, const MpcEnd& b) { return distance(a.X) < distance(b.X); });
  };
  std::iter_swap(ends.begin() + 1, farthest([&](const Vec3& x) { return (x - origin).norm(); }));
  const double size = (ends[1].X - origin).norm();
  if (!(size > no_width * size_of(d_, in_.mesh))) return skip("of nodes at one place");
  const Vec3 along = (ends[1].X - origin) / size;
  const auto beside_line = [&](const Vec3& x) { return off_line(x, origin, along); };
  const Vec3 widest = farthest(beside_line)->X;
  Vec3 normal = along.cross(widest - origin);
  std::int64_t beside = -1;
  if (plane) {
    if (!(normal.norm() > no_width * size)) return skip("of nodes on a line");
    normal.normalize();
    const auto off_plane = [&](const Vec3& x) { return std::abs(normal.dot(x - origin)); };
    if (!(off_plane(farthest(off_plane)->X) <= most_off * size)) return skip("of nodes that do not lie in a plane");
  } else {
    if (!(normal.norm() <= most_off * size)) return skip("of nodes that do not lie on a line");
    beside = row_beside(ends, along);
    if (beside < 0) return skip("of nodes of no solid");
    const Vec3 x = in_.mesh.X[static_cast<size_t>(beside)];
    normal = along.cross(x - origin).normalized();
    ends.push_back({"", x, beside});  // turns the body about the line, which pulls on nothing
  }
  for (const std::string& name : in_.mesh.all_names()) scene_.take("body", name);
  const std::string body = scene_.unique("body", plane ? "mpc_plane" : "mpc_line");
  massless_body(scene_, body, point(origin), mpc.place);
  for (size_t i = 0; i < ends.size(); ++i) {
    MpcEnd& e = ends[i];
    if (e.name.empty()) e.name = end_of(e.row, "mpc");
    const bool in_plane = plane || e.row == beside;  // of a line the last one alone
    const char* kind = i == 0 ? "spherical" : i == 1 || !in_plane ? "in-line" : "in-plane";
    scene_.add_unique({"joint", kind}, body, mpc.place, {{"a", body}, {"b", e.name}, {"at", point(e.X)}})
        .set_if(i > 0, "axis", i == 1 || !in_plane ? along : normal);
  }
}

void InpScene::mpcs() {
  for (const InpMpc& mpc : d_.mpcs)
    if (mpc.kind == "PLANE" || mpc.kind == "STRAIGHT")
      stay_together(mpc);
    else
      keep_distances(mpc);
}

}  // namespace hilo
