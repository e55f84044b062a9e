// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes that the mesh says move as one, at folds of shells: each block is a body without mass, or the body that some of its nodes follow.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>
#include <set>

#include "base/shell_shape.hpp"
#include "system/build/builder.hpp"
#include "system/joints.hpp"
#include "system/motions.hpp"

namespace hilo {
namespace {

/// Nodes nearer to a line than this share of their distances from its middle lie on it.
constexpr double on_line = 1e-3;

/// Components of a block's points that are held, as rows of its rigid motion: those that the others do not imply.
class HeldRows {
 public:
  explicit HeldRows(double size) : size_(size) {}
  bool is_new(const Vec3& arm, int component) {
    Eigen::Matrix<double, 6, 1> row;
    const Vec3 e = Vec3::Unit(component);
    row << e, arm.cross(e) / size_;
    for (const auto& other : rows_) row -= other * other.dot(row);
    for (const auto& other : rows_) row -= other * other.dot(row);
    if (row.norm() < 1e-6) return false;
    rows_.push_back(row.normalized());
    return true;
  }

 private:
  double size_;
  std::vector<Eigen::Matrix<double, 6, 1>> rows_;
};

/// A shell that deforms turns on a solid that deforms, as a hinge, and not on a rigid one: said, because the mesh is the same.  Flags are
/// by region.  Collective.
void tell_clamps(const Mesh& mesh, const std::vector<char>& is_rigid, const std::vector<char>& is_shell, const Comm& comm,
                 const std::string& file) {
  const size_t n = mesh.block_name.size();
  std::vector<double> met(2 * n, 0.0);  // by block: a rigid solid, a shell that deforms
  for (std::int64_t e = 0; e < mesh.n_cells(); ++e) {
    const bool rigid = is_rigid[mesh.region[e]], shell = is_shell[mesh.region[e]] || static_cast<Shape>(mesh.shape[e]) == shell8;
    if (rigid == shell) continue;
    for (const auto i : mesh.cell(e))
      if (mesh.block[i] >= 0) met[2 * static_cast<size_t>(mesh.block[i]) + (rigid ? 0 : 1)] = 1;
  }
  comm.sum(met);
  size_t clamps = 0, first = 0;
  for (size_t b = n; b-- > 0;)
    if (met[2 * b] > 0 && met[2 * b + 1] > 0) ++clamps, first = b;
  const Vec3& at = mesh.block_at[first];
  if (clamps > 0)
    warn(file, fmt::format("{} nodes where shells stand on rigid solids are clamps, that at ({:.4g}, {:.4g}, {:.4g}) among them; on solids "
                           "that deform they are hinges",
                           clamps, at[0], at[1], at[2]));
}

}  // namespace

std::vector<int> Builder::whole_blocks(std::vector<int> nodes) const {
  const auto& block = mesh_->mesh.block;
  if (mesh_->mesh.block_name.empty()) return nodes;
  std::set<int> blocks;
  for (const int i : nodes)
    if (block[i] >= 0) blocks.insert(static_cast<int>(block[i]));
  std::vector<int> all = comm_.gather(std::vector<int>(blocks.begin(), blocks.end()));
  blocks.insert(all.begin(), all.end());
  if (blocks.empty()) return nodes;
  for (int i = 0; i < static_cast<int>(block.size()); ++i)
    if (block[i] >= 0 && blocks.contains(static_cast<int>(block[i]))) nodes.push_back(i);
  std::ranges::sort(nodes);
  nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
  return nodes;
}

void Builder::join_by_blocks(const std::vector<int>& region, Pairs& shared) const {
  if (mesh_->mesh.block_name.empty()) return;
  Pairs met;  // block, region
  for (size_t i = 0; i < region.size(); ++i)
    if (region[i] >= 0 && mesh_->mesh.block[i] >= 0) met.insert({static_cast<int>(mesh_->mesh.block[i]), region[i]});
  agree(met, comm_);
  std::map<int, int> first;
  for (const auto& [block, r] : met)
    if (const auto [at, fresh] = first.try_emplace(block, r); !fresh) shared.insert({at->second, r});
}

/// After all that makes bodies of nodes.  Collective.
void Builder::make_blocks() {
  if (!mesh_ || mesh_->mesh.block_name.empty()) return;
  const Mesh& mesh = mesh_->mesh;
  const size_t n = mesh.block_name.size();
  const auto n_nodes = static_cast<int>(mesh.X.size());
  const auto refuse = [&](size_t b, const std::string& why, const std::string& hint) {
    throw Error(mesh_->file,
                fmt::format("the nodes at ({:.4g}, {:.4g}, {:.4g}), {}, move as one, {}", mesh.block_at[b][0], mesh.block_at[b][1],
                            mesh.block_at[b][2], mesh.block_name[b], why),
                hint);
  };
  Pairs met;  // block, what a node of it follows
  std::vector<std::vector<int>> nodes_of(n);
  std::vector<double> moments(10 * n, 0.0);  // number, places and their squares, about the block's own
  for (int i = 0; i < n_nodes; ++i) {
    const auto b = mesh.block[i];
    if (b < 0) continue;
    met.insert({static_cast<int>(b), out_->follower[i]});
    if (const int held = held_to(i); held >= 0) met.insert({static_cast<int>(b), held});  // by a weld, where it is of a linear region
    nodes_of[static_cast<size_t>(b)].push_back(i);
    if (!out_->node_owned[i]) continue;
    double* m = moments.data() + 10 * b;
    const Vec3 r = out_->X[i] - mesh.block_at[static_cast<size_t>(b)];
    const double more[10] = {1, r[0], r[1], r[2], r[0] * r[0], r[1] * r[1], r[2] * r[2], r[0] * r[1], r[0] * r[2], r[1] * r[2]};
    for (int k = 0; k < 10; ++k) m[k] += more[k];
  }
  comm_.sum(moments);
  agree(met, comm_);
  std::vector<std::set<int>> follows(n);
  for (const auto& [block, body] : met) follows[static_cast<size_t>(block)].insert(body);
  std::vector<int> body_of(n, -1);
  std::vector<double> of_nonlinear(n, 0.0);  // nodes of cells of nonlinear regions
  for (std::int64_t e = 0; e < mesh.n_cells(); ++e)
    if (regions_[mesh.region[e]].fidelity == Fidelity::nonlinear)
      for (const auto i : mesh.cell(e))
        if (mesh.block[i] >= 0) of_nonlinear[static_cast<size_t>(mesh.block[i])] = 1;
  std::vector<double> is_held(n, 0.0);  // in single components
  for (const Motion& m : out_->part<Motions>().list)
    for (const int i : m.nodes)
      if (m.body < 0 && mesh.block[i] >= 0) is_held[static_cast<size_t>(mesh.block[i])] = 1;
  comm_.sum(of_nonlinear), comm_.sum(is_held);
  for (size_t b = 0; b < n; ++b) {
    std::set<int> bodies = follows[b];
    const auto of_modes = [&](int body) { return body >= 0 && out_->bodies[body].linear; };
    const auto found = std::ranges::find_if(bodies, of_modes);
    const int linear = found == bodies.end() ? -1 : *found;  // regions that meet in a block are one
    if (linear >= 0) bodies.erase(linear);
    const auto named = body_by_name_.find(mesh.block_name[b]);
    const bool has_body = named != body_by_name_.end();
    if (linear >= 0 && bodies.empty() && of_nonlinear[b] == 0 && is_held[b] == 0 && !has_body) continue;  // its reduction has the block
    const bool has_free = bodies.erase(-1) > 0, is_alone = bodies.empty();
    if (has_body) bodies.insert(named->second);
    if (!bodies.empty()) body_of[b] = *bodies.begin();
    const auto still = [&](int body) { return out_->bodies[body].ground || (out_->bodies[body].held && !out_->bodies[body].moving); };
    if (bodies.size() > 1 && !std::ranges::all_of(bodies, still))
      refuse(b, fmt::format("and belong to \"{}\" and \"{}\"", out_->bodies[*bodies.begin()].name, out_->bodies[*bodies.rbegin()].name),
             "one of them, joined to the other");
    if (!has_free && linear < 0) continue;
    const double* m = moments.data() + 10 * b;
    const Vec3 mean = Vec3(m[1], m[2], m[3]) / m[0];
    Mat3 S;
    S << m[4], m[7], m[8], m[7], m[5], m[9], m[8], m[9], m[6];
    S = S / m[0] - mean * mean.transpose();
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(S);
    const double size = std::sqrt(std::max(0.0, eigen.eigenvalues()[2]));
    int& body = body_of[b];
    if (body < 0) {
      body = new_body(mesh.block_name[b], mesh.block_at[b]);
      out_->bodies[body].patch = out_->bodies[body].block = true;
    }
    if (out_->bodies[body].mass == 0 && out_->bodies[body].free()) out_->bodies[body].size = std::max(size, 1e-9 * out_->length);
    if (is_alone && eigen.eigenvalues()[1] < on_line * on_line * eigen.eigenvalues()[2])
      out_->bodies[body].line = eigen.eigenvectors().col(2);
    if (linear < 0) {
      out_->bodies[body].has_cells = true;
      continue;
    }
    std::vector<int> its;
    for (const int i : nodes_of[b])
      if (out_->follower[i] == linear) its.push_back(i);
    weld(linear, body, out_->bodies[body].name, its);
  }
  for (int i = 0; i < n_nodes; ++i)
    if (mesh.block[i] >= 0 && out_->follower[i] < 0 && body_of[static_cast<size_t>(mesh.block[i])] >= 0)
      out_->follower[i] = body_of[static_cast<size_t>(mesh.block[i])];
  hold_blocks(body_of);
  std::vector<char> is_rigid, is_shell;
  for (const Region& r : regions_) is_rigid.push_back(r.fidelity == Fidelity::rigid), is_shell.push_back(r.shell);
  tell_clamps(mesh, is_rigid, is_shell, comm_, mesh_->file);
}

/// Single components that motions hold of nodes of blocks: rows of their bodies.  Collective.
void Builder::hold_blocks(const std::vector<int>& body_of) {
  const Mesh& mesh = mesh_->mesh;
  auto& motions = out_->part<Motions>().list;
  std::vector<double> held;  // motion, block, place of a node
  for (size_t k = 0; k < motions.size(); ++k) {
    Motion& m = motions[k];
    if (m.body >= 0) continue;
    for (const int i : m.nodes) {
      if (mesh.block[i] < 0) continue;
      if (out_->node_owned[i])
        held.insert(held.end(), {static_cast<double>(k), static_cast<double>(mesh.block[i]), out_->X[i][0], out_->X[i][1], out_->X[i][2]});
      out_->fixed[i] = {false, false, false};
    }
    std::erase_if(m.nodes, [&](int i) { return mesh.block[i] >= 0; });
  }
  held = comm_.gather(held);
  std::set<std::array<double, 5>> all;
  for (size_t i = 0; i + 4 < held.size(); i += 5) all.insert({held[i + 1], held[i], held[i + 2], held[i + 3], held[i + 4]});  // by block
  auto& joints = out_->part<Joints>().list;
  double block = -1;
  std::optional<HeldRows> rows;
  std::map<std::pair<double, double>, std::vector<std::pair<Vec3, int>>> wanted;  // motion and block: points and components
  for (const auto& [b, k, x, y, z] : all) {
    const auto number = static_cast<size_t>(b);
    const Motion& m = motions[static_cast<size_t>(k)];
    if (m.moving)
      throw Error(scene_.path,
                  fmt::format("motion \"{}\" moves single components of nodes of {}, which move as one", m.name, mesh.block_name[number]),
                  "all three, or a joint");
    const Body& body = out_->bodies[body_of[number]];
    if (body.moving) {
      const Motion& by = *std::ranges::find(motions, body_of[number], &Motion::body);
      for (int c = 0; c < 3; ++c)
        if (m.component[c] && (by.angle != 0 || by.displacement[c] != 0))
          throw Error(scene_.path,
                      fmt::format("motion \"{}\" holds single components of nodes of {}, which motion \"{}\" moves", m.name,
                                  mesh_->mesh.block_name[number], by.name),
                      "name a set without these nodes");
    }
    if (!body.free()) continue;  // it cannot move there
    if (block != b) rows.emplace(body.size), block = b;
    for (int c = 0; c < 3; ++c)
      if (const Vec3 at(x, y, z); m.component[c] && rows->is_new(at - body.Xc, c)) wanted[{k, b}].emplace_back(at, c);
  }
  for (const auto& [key, points] : wanted) {
    Motion& m = motions[static_cast<size_t>(key.first)];
    const auto number = static_cast<size_t>(key.second);
    const int body = body_of[number];
    Joint c;
    c.name = fmt::format("{} {}", m.name, mesh.block_name[number]);
    c.kind = &joint_kinds().at("in-plane");
    c.join({0, -1}, {body, -1}, out_->start, points[0].first, Mat3::Identity());
    for (const auto& [at, component] : points) {
      const int a = c.add_point(0, out_->start, at), b = c.add_point(1, out_->start, at);
      c.add_zero_measure({{Term::coordinate, a, b, 0, 1, Vec3::Unit(component)}}, out_->start);
    }
    m.joints.push_back(static_cast<int>(joints.size()));
    joints.push_back(std::move(c));
  }
}

}  // namespace hilo
