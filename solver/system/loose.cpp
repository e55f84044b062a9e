// SPDX-License-Identifier: GPL-3.0-or-later
// Motions that nothing resists: what would leave a static analysis without an answer, told by name before it is asked for one.
//
// Every part moves as a rigid body, x -> v + w x (x - c): a cluster of cells joined by faces, a body, a node of bars alone.  Over these
// motions V, six to a part, the tangent K and the joint rows G are summed clique by clique, each to its own scale, so that a soft spring
// counts as much as steel:
//   N = sum V^T K V / max |V^T K V|  +  sum (G V)^T (G V) / max |G V|^2
// Rows of V that motions prescribe are zero, so a motion they stop strains the cells beside them.  Null vectors of N are free motions:
// found by inverse iteration, and told as translations and turns about axes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "linear/tangent_reader.hpp"
#include "system/rigid_motion.hpp"
#include "system/solids.hpp"
#include "system/touching.hpp"

namespace hilo {
namespace {

/// Unknown blocks as functions of the motion of their part.
struct Block {
  int part = -1;
  Eigen::Matrix<double, 3, 6> V = Eigen::Matrix<double, 3, 6>::Zero();
  bool inner = true;  // it meets but cells, and nothing of it is prescribed
};

/// Takes a tangent, and finds how far from a body's centre what resists its turns acts: of a point mass on a beam, this is no small part of
/// the beam, though the body itself has no size.  At most the length of the scene: a row of turns alone has round-off for moves.
class Reach final : public TangentReader {
 public:
  explicit Reach(const System& system) : system_(system), arm(system.bodies.size(), 0.0) {
    centre_of_.assign(system.first_joint_block(), -1);
    for (size_t b = 0; b < system.bodies.size(); ++b)
      if (system.body_block[b] >= 0) centre_of_[system.body_block[b] + 1] = static_cast<int>(b);
  }
  void add(int clique, const double* dense) override {
    const auto list = system_.layout.cliques[clique];
    const auto n = static_cast<Eigen::Index>(list.size());
    const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> K(dense, 3 * n, 3 * n);
    for (Eigen::Index turn = 0; turn < n; ++turn) {
      if (list[turn] < 0 || list[turn] >= system_.first_joint_block() || centre_of_[list[turn]] < 0) continue;
      const auto centre = std::find(list.begin(), list.end(), list[turn] - 1) - list.begin();
      if (centre == n) continue;
      double& most = arm[centre_of_[list[turn]]];
      const auto take = [&](double turns, double moves) {
        if (moves > 0) most = std::max(most, std::min(turns / moves, system_.length));
      };
      take(std::sqrt(K.block<3, 3>(3 * turn, 3 * turn).norm()), std::sqrt(K.block<3, 3>(3 * centre, 3 * centre).norm()));
      for (Eigen::Index row = 0; row < n; ++row)
        if (list[row] >= system_.first_joint_block())
          take(K.block<3, 3>(3 * row, 3 * turn).norm(), K.block<3, 3>(3 * row, 3 * centre).norm());
    }
  }

 private:
  const System& system_;
  std::vector<int> centre_of_;  // of a block of turns, its body

 public:
  std::vector<double> arm;  // [m], of each body, 0 where nothing that moves it resists turns
};

/// Takes a tangent, and keeps the sum N.
class Resistance final : public TangentReader {
 public:
  Resistance(const System& system, const std::vector<Block>& blocks) : system_(system), blocks_(blocks) {}
  std::vector<Eigen::Triplet<double>> entries;
  void zero() override { entries.clear(); }
  void add(int clique, const double* dense) override {
    const auto list = system_.layout.cliques[clique];
    const int n = static_cast<int>(list.size());
    std::vector<int> parts;
    bool inside = true;  // cells of one part that nothing stops: no resistance
    for (const int b : list) {
      if (b < 0 || (b < system_.first_joint_block() && blocks_[b].part < 0)) continue;
      if (b >= system_.first_joint_block() || blocks_[b].part >= n_clusters || !blocks_[b].inner) inside = false;
      if (b < system_.first_joint_block() && std::find(parts.begin(), parts.end(), blocks_[b].part) == parts.end())
        parts.push_back(blocks_[b].part);
    }
    if (parts.empty() || (inside && parts.size() == 1 && n > 1 && !of_contacts)) return;  // a point alone is held from outside
    const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> K(dense, 3 * n, 3 * n);
    Eigen::MatrixXd V = Eigen::MatrixXd::Zero(3 * n, 6 * static_cast<Eigen::Index>(parts.size()));
    for (int i = 0; i < n; ++i)
      if (list[i] >= 0 && list[i] < system_.first_joint_block() && blocks_[list[i]].part >= 0) {
        const auto k = std::find(parts.begin(), parts.end(), blocks_[list[i]].part) - parts.begin();
        V.block<3, 6>(3 * i, 6 * k) = blocks_[list[i]].V;
      }
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(V.cols(), V.cols()), M = Eigen::MatrixXd::Zero(V.cols(), V.cols());
    double scale = 0;
    for (int i = 0; i < 3 * n; ++i) {
      if (list[i / 3] < 0) continue;
      const Eigen::RowVectorXd row = K.row(i) * V;
      if (list[i / 3] < system_.first_joint_block()) {
        M += V.row(i).transpose() * row;
        scale += V.row(i).norm() * (K.row(i).cwiseAbs() * V.cwiseAbs()).norm();
      } else if (const double size = (K.row(i).cwiseAbs() * V.cwiseAbs()).squaredNorm(); size > 0) {
        sum += row.transpose() * row / size;
      }
    }
    if (scale > 0) sum += (M + M.transpose()) / (2 * scale);
    for (Eigen::Index i = 0; i < sum.rows(); ++i)
      for (Eigen::Index j = 0; j < sum.cols(); ++j)
        if (sum(i, j) != 0)
          entries.emplace_back(6 * parts[i / 6] + static_cast<int>(i % 6), 6 * parts[j / 6] + static_cast<int>(j % 6), sum(i, j));
  }
  int n_clusters = 0;        // parts of nodes; bodies follow
  bool of_contacts = false;  // which hold a part from outside

 private:
  const System& system_;
  const std::vector<Block>& blocks_;
};

}  // namespace

System::Loose System::loose(const Stage& stage, bool with_loads) const {
  std::vector<std::int64_t> cluster_of;
  const auto& solids = part<Solids>();
  const int n_clusters = solids.clusters(cluster_of);
  std::vector<int> moving;  // bodies
  for (size_t b = 0; b < bodies.size(); ++b)
    if (body_block[b] >= 0) moving.push_back(static_cast<int>(b));
  const int n_parts = n_clusters + static_cast<int>(moving.size()), n_regions = static_cast<int>(region_nodes.size());
  Loose out;
  if (n_parts == 0) return out;
  const Config& q = *stage.end;
  std::vector<double> sums(static_cast<size_t>(n_clusters) * (5 + n_regions), 0.0);  // count, X, X^2, regions
  const auto of = [&](std::int64_t cluster) { return sums.data() + cluster * (5 + n_regions); };
  for (size_t i = 0; i < X.size(); ++i)
    if (cluster_of[i] < n_clusters && node_owned[i]) {
      double* s = of(cluster_of[i]);
      s[0] += 1, s[4] += q.x[i].squaredNorm();
      for (int k = 0; k < 3; ++k) s[1 + k] += q.x[i][k];
    }
  for (const SolidBatch& b : solids.batches) {  // a cell is of the cluster that most of its nodes are in
    const auto n = static_cast<size_t>(info(b.shape).n_nodes);
    for (size_t e = 0; e < b.cells.size(); ++e) {
      const std::span<const int> nodes(b.nodes.data() + e * n, n);
      std::pair<std::ptrdiff_t, std::int64_t> most{0, n_clusters};
      for (const int i : nodes)
        if (cluster_of[i] < n_clusters)
          most = std::max(
              most, {std::count_if(nodes.begin(), nodes.end(), [&](int k) { return cluster_of[k] == cluster_of[i]; }), cluster_of[i]});
      if (most.second < n_clusters) of(most.second)[5 + b.region] = 1;
    }
  }
  comm->sum(sums);
  std::vector<Part> parts(n_parts);
  for (int c = 0; c < n_clusters; ++c) {
    const double* s = of(c);
    Part& p = parts[c];
    if (s[0] == 0) continue;
    p.centre = Vec3(s[1], s[2], s[3]) / s[0];
    p.length = std::sqrt(std::max(0.0, s[4] / s[0] - p.centre.squaredNorm()));
    std::vector<std::string> names;
    for (int r = 0; r < n_regions; ++r)
      if (s[5 + r] > 0) names.push_back('"' + mesh->mesh.region_name[r] + '"');
    p.are_several = names.size() > 1;
    p.name = fmt::format("region{} {}", p.are_several ? "s" : "", fmt::join(names, ", "));
  }
  std::vector<Vec3> node(X.size(), Vec3::Zero());
  std::vector<Vec6> body(bodies.size(), Vec6::Zero());
  std::vector<double> lambda(3 * n_joint_blocks(), 0.0);
  Residual unused;
  unused.r.assign(3 * n_blocks(), 0.0);
  Reach reach(*this);
  Pass pass{stage, lambda, unused, &reach, node, body, 1, false};  // loads have turns without moves
  for (const Equations* part : all<Equations>()) part->evaluate(pass);
  comm->max(reach.arm);
  for (size_t k = 0; k < moving.size(); ++k) {
    const Body& body = bodies[moving[k]];
    parts[n_clusters + k] = {q.c[moving[k]], std::max(body.size, reach.arm[moving[k]]),
                             (body.patch ? "joint patch \"" : "body \"") + body.name + '"'};
  }
  for (Part& p : parts)
    if (!(p.length > 1e-9 * length)) p.length = length;

  std::vector<Block> blocks(first_joint_block());
  std::vector<Mat6> gram(n_parts, Mat6::Zero());  // of what a motion moves
  for (size_t i = 0; i < X.size(); ++i) {
    if (node_block[i] < 0) continue;
    if (cluster_of[i] >= n_clusters) continue;  // in no cell
    Block& b = blocks[node_block[i]];
    b.part = static_cast<int>(cluster_of[i]);
    b.V << Mat3::Identity(), -skew(q.x[i] - parts[b.part].centre) / parts[b.part].length;
    for (int k = 0; k < 3; ++k)
      if (fixed[i][k]) b.V.row(k).setZero(), b.inner = false;
    if (node_owned[i]) gram[b.part] += b.V.transpose() * b.V;
  }
  for (const SolidBatch& b : solids.batches) {
    const auto n = static_cast<size_t>(info(b.shape).n_nodes);
    for (size_t e = 0; e < b.cells.size(); ++e) {
      const std::span<const int> nodes(b.nodes.data() + e * n, n);
      if (std::none_of(nodes.begin(), nodes.end(), [&](int i) { return follower[i] >= 0; })) continue;
      for (const int i : nodes)
        if (node_block[i] >= 0) blocks[node_block[i]].inner = false;
    }
  }
  comm->sum(std::span<double>(gram.front().data(), 36 * static_cast<size_t>(n_parts)));
  for (size_t k = 0; k < moving.size(); ++k) {
    const int first = body_block[moving[k]], part = n_clusters + static_cast<int>(k);
    blocks[first].part = blocks[first + 1].part = part;
    blocks[first].V.leftCols<3>().setIdentity();
    blocks[first + 1].V.rightCols<3>() = Mat3::Identity() / parts[part].length;
    gram[part].setIdentity();
  }

  Resistance resistance(*this, blocks);
  resistance.n_clusters = n_clusters;
  pass.K = &resistance, pass.loads = with_loads;
  for (const Equations* equations : all<Equations>()) {
    resistance.of_contacts = dynamic_cast<const Touching*>(equations) != nullptr;
    equations->evaluate(pass);
  }

  std::vector<std::vector<std::int64_t>> tell(comm->size);
  for (auto& list : tell)
    for (const auto& e : resistance.entries)
      list.push_back(e.row()), list.push_back(e.col()), list.push_back(std::bit_cast<std::int64_t>(e.value()));
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& list : comm->size > 1 ? comm->exchange(tell) : tell)
    for (size_t k = 0; k + 2 < list.size(); k += 3)
      entries.emplace_back(static_cast<int>(list[k]), static_cast<int>(list[k + 1]), std::bit_cast<double>(list[k + 2]));
  for (int k = 0; k < n_parts; ++k) {  // motions that move nothing: turns of a line about itself, parts that are prescribed altogether
    const Eigen::SelfAdjointEigenSolver<Mat6> eigen(gram[k]);
    for (int m = 0; m < 6; ++m)
      if (eigen.eigenvalues()[m] <= 1e-12 * std::max(1.0, eigen.eigenvalues()[5]))
        for (int i = 0; i < 6; ++i)
          for (int j = 0; j < 6; ++j) entries.emplace_back(6 * k + i, 6 * k + j, eigen.eigenvectors()(i, m) * eigen.eigenvectors()(j, m));
  }
  Eigen::SparseMatrix<double> N(6 * static_cast<Eigen::Index>(n_parts), 6 * static_cast<Eigen::Index>(n_parts));
  N.setFromTriplets(entries.begin(), entries.end());
  const Motions Z = null_vectors(N);
  if (Z.cols() == 0) return out;

  std::vector<std::string> lines;
  std::vector<std::pair<int, int>> order;  // nodes of bars and massless patches go with what they belong to: told last
  Motions turns(3 * static_cast<Eigen::Index>(n_parts), Z.cols());
  for (int k = 0; k < n_parts; ++k) {
    turns.middleRows<3>(3 * k) = Z.middleRows<3>(6 * k + 3);
    if (Z.middleRows<6>(6 * k).norm() > 1e-6) order.emplace_back(k >= n_clusters && bodies[moving[k - n_clusters]].patch, k);
  }
  std::sort(order.begin(), order.end());
  for (const auto& [late, k] : order) {
    if (lines.size() == 3 || (late && !lines.empty())) break;
    std::string line = parts[k].name + (parts[k].are_several ? " are " : " is ") + told(Z.middleRows<6>(6 * k), parts[k]);
    if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(std::move(line));
  }
  out.text = fmt::format("{}", fmt::join(lines, "; "));
  const Motions straight = vanishing(Z, turns);
  for (Eigen::Index c = 0; c < straight.cols(); ++c) {
    std::vector<double> z(3 * n_blocks(), 0.0);
    for (size_t b = 0; b < blocks.size(); ++b)
      if (blocks[b].part >= 0)
        Eigen::Map<Vec3>(z.data() + 3 * b) = blocks[b].V * straight.col(c).segment<6>(6 * static_cast<Eigen::Index>(blocks[b].part));
    out.straight.push_back(std::move(z));
  }
  return out;
}

}  // namespace hilo
