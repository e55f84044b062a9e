// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/interface.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "base/joined.hpp"
#include "linear/petsc/session.hpp"

namespace hilo::petsc {
namespace {

using Key = std::vector<PetscInt>;  // rank and piece of each holder

/// Connected parts of the blocks that `group` does not leave apart (negative: not asked for).
template <class Group>
std::vector<PetscInt> components(const SubdomainMatrix& F, const Group& group) {
  std::vector<PetscInt> part(F.n_blocks(), -1), stack;
  PetscInt n = 0;
  for (PetscInt i = 0; i < F.n_blocks(); ++i) {
    if (part[i] >= 0 || group(i) < 0) continue;
    part[i] = n;
    stack.assign(1, i);
    while (!stack.empty()) {
      const PetscInt k = stack.back();
      stack.pop_back();
      for (const PetscInt j : F.neighbours(k))
        if (part[j] < 0 && group(j) == group(k)) part[j] = n, stack.push_back(j);
    }
    ++n;
  }
  return part;
}

/// The holders of each block of the subdomains, through its owner.
std::vector<Key> find_keys(const SubdomainMatrix& F, const std::vector<PetscInt>& piece) {
  std::vector<std::vector<PetscInt>> tell(size());
  for (PetscInt i = 0; i < F.n_blocks(); ++i) tell[F.owner(i)].insert(tell[F.owner(i)].end(), {F.global(i), piece[i]});
  const auto told = comm().exchange(tell);
  std::vector<Key> of_owned(F.n_owned());
  for (int r = 0; r < size(); ++r)
    for (size_t k = 0; k < told[r].size(); k += 2) {
      auto& key = of_owned[told[r][k] - F.first_owned()];
      key.push_back(r), key.push_back(told[r][k + 1]);
    }
  std::vector<std::vector<PetscInt>> answer(size());
  for (int r = 0; r < size(); ++r)
    for (size_t k = 0; k < told[r].size(); k += 2) {
      const auto& key = of_owned[told[r][k] - F.first_owned()];
      answer[r].push_back(static_cast<PetscInt>(key.size()));
      answer[r].insert(answer[r].end(), key.begin(), key.end());
    }
  const auto answers = comm().exchange(answer);
  std::vector<size_t> at(size(), 0);
  std::vector<Key> keys(F.n_blocks());
  for (PetscInt i = 0; i < F.n_blocks(); ++i) {
    const auto& list = answers[F.owner(i)];
    size_t& k = at[F.owner(i)];
    keys[i].assign(list.begin() + k + 1, list.begin() + k + 1 + list[k]);
    k += 1 + list[k];
  }
  return keys;
}

/// Rigid motions of nodes, orthonormal; fewer than six where the nodes are in a line.
Eigen::MatrixXd rigid_motions(const SubdomainMatrix& F, const std::vector<PetscInt>& blocks) {
  const auto n = static_cast<Eigen::Index>(blocks.size());
  const auto& X = F.positions();
  Eigen::MatrixXd modes = Eigen::MatrixXd::Zero(3 * n, X.empty() ? 3 : 6);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0;
  const auto at = [&](PetscInt i) { return Eigen::Vector3d(X[3 * i], X[3 * i + 1], X[3 * i + 2]); };
  if (!X.empty()) {
    for (const PetscInt i : blocks) centre += at(i);
    centre /= static_cast<double>(n);
    for (const PetscInt i : blocks) radius = std::max(radius, (at(i) - centre).norm());
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    modes.block(3 * k, 0, 3, 3).setIdentity();
    if (!(radius > 0)) continue;
    const Eigen::Vector3d r = (at(blocks[k]) - centre) / radius;
    modes.block(3 * k, 3, 3, 3) << 0, r[2], -r[1], -r[2], 0, r[0], r[1], -r[0], 0;
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(modes);
  qr.setThreshold(1e-6);
  return qr.householderQ() * Eigen::MatrixXd::Identity(3 * n, qr.rank());
}

}  // namespace

Interface find_interface(const SubdomainMatrix& F) {
  Interface out;
  out.piece = components(F, [](PetscInt) { return 0; });
  for (const int p : out.piece) out.n_pieces = std::max(out.n_pieces, p + 1);
  const auto keys = find_keys(F, out.piece);
  std::map<Key, PetscInt> group_of;  // of the blocks that a piece of this rank, the first of their holders, divides into classes
  std::vector<PetscInt> group(F.n_blocks(), -1);
  for (PetscInt i = 0; i < F.n_blocks(); ++i)
    if (keys[i].size() > 2 && keys[i][0] == rank() && keys[i][1] == out.piece[i])
      group[i] = group_of.try_emplace(keys[i], static_cast<PetscInt>(group_of.size())).first->second;
  const auto part = components(F, [&](PetscInt i) { return group[i]; });
  const auto less = [&](PetscInt a, PetscInt b) { return F.global(a) < F.global(b); };
  const auto new_class = [&](std::vector<PetscInt> blocks, int first) {
    std::sort(blocks.begin(), blocks.end(), less);
    const auto& key = keys[blocks[0]];
    InterfaceClass c{blocks, {}, out.piece[blocks[0]], first, rigid_motions(F, blocks)};
    for (size_t k = 0; k < key.size(); k += 2) c.holders.push_back({key[k], key[k + 1]});
    out.classes.push_back(std::move(c));
  };
  std::map<PetscInt, std::vector<PetscInt>> led;
  for (PetscInt i = 0; i < F.n_blocks(); ++i)
    if (part[i] >= 0) led[part[i]].push_back(i);
  for (auto& [unused, blocks] : led) new_class(blocks, 0);
  int mine = 0;
  for (const auto& c : out.classes) mine += static_cast<int>(c.q.cols());
  int before = static_cast<int>(comm().before(mine));
  out.n_constraints = static_cast<int>(comm().sum(std::int64_t{mine}));
  // the other holders learn their classes by the number of the first constraint
  std::vector<std::vector<PetscInt>> send(size());
  for (auto& c : out.classes) {
    c.first = before;
    before += static_cast<int>(c.q.cols());
    for (const PetscInt i : c.blocks)
      for (size_t k = 2; k < keys[i].size(); k += 2)
        send[keys[i][k]].insert(send[keys[i][k]].end(), {F.global(i), keys[i][k + 1], c.first});
  }
  std::map<std::pair<PetscInt, PetscInt>, PetscInt> place;  // of a shared block in a piece
  for (PetscInt i = 0; i < F.n_blocks(); ++i)
    if (keys[i].size() > 2) place[{F.global(i), out.piece[i]}] = i;
  std::map<std::pair<int, int>, std::vector<PetscInt>> others;
  for (const auto& list : comm().exchange(send))
    for (size_t k = 0; k < list.size(); k += 3) others[{list[k + 2], list[k + 1]}].push_back(place.at({list[k], list[k + 1]}));
  for (auto& [first_and_piece, blocks] : others) new_class(blocks, first_and_piece.first);
  std::sort(out.classes.begin(), out.classes.end(),
            [](const auto& a, const auto& b) { return std::pair(a.first, a.piece) < std::pair(b.first, b.piece); });
  return out;
}

std::vector<int> connected_parts(const SubdomainMatrix& F) {
  const auto piece = components(F, [](PetscInt) { return 0; });
  const auto keys = find_keys(F, piece);
  // links between pieces, to all ranks: (rank, piece) twice each, a piece's link to itself included
  std::set<std::array<PetscInt, 4>> links;
  for (PetscInt i = 0; i < F.n_blocks(); ++i)
    for (size_t k = 0; k < keys[i].size(); k += 2) links.insert({rank(), piece[i], keys[i][k], keys[i][k + 1]});
  std::vector<PetscInt> mine;
  for (const auto& link : links) mine.insert(mine.end(), link.begin(), link.end());
  const std::vector<PetscInt> all = comm().gather(mine);
  std::map<std::pair<PetscInt, PetscInt>, int> number;
  for (size_t k = 0; k < all.size(); k += 4) number.try_emplace({all[k], all[k + 1]}, static_cast<int>(number.size()));
  Joined pieces(number.size());
  for (size_t k = 0; k < all.size(); k += 4) pieces.join(number.at({all[k], all[k + 1]}), number.at({all[k + 2], all[k + 3]}));
  std::map<int, int> part_of_root;
  for (int a = 0; a < static_cast<int>(pieces.size()); ++a) part_of_root.try_emplace(pieces.root(a), static_cast<int>(part_of_root.size()));
  // an owned block may lie in another rank's subdomain only: its holders tell
  std::vector<std::vector<PetscInt>> tell(size());
  for (PetscInt i = 0; i < F.n_blocks(); ++i)
    tell[F.owner(i)].insert(tell[F.owner(i)].end(), {F.global(i), part_of_root.at(pieces.root(number.at({rank(), piece[i]})))});
  std::vector<int> part(F.n_owned(), 0);
  for (const auto& list : comm().exchange(tell))
    for (size_t k = 0; k < list.size(); k += 2) part[list[k] - F.first_owned()] = list[k + 1];
  return part;
}

}  // namespace hilo::petsc
