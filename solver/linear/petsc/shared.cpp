// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/shared.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace hilo::petsc {

SharedBlocks::SharedBlocks(const BlockMap& map)
    : owned_(map.n_owned, -1), is_owned_(map.global.size()), is_shared_(map.global.size(), 1), ghosts_(size()), lent_(size()) {
  const int n = size();
  first_ = comm().gather(std::vector{map.first});
  first_.push_back(map.n_global);
  if (3 * map.n_global > std::numeric_limits<PetscInt>::max())
    throw Error("", "more unknowns than PETSc's 32-bit numbers reach", "use a coarser mesh", Exit::resources);
  std::vector<std::vector<PetscInt>> ask(n);
  for (size_t i = 0; i < map.global.size(); ++i) {
    const std::int64_t k = map.global[i] - map.first;
    is_owned_[i] = k >= 0 && k < map.n_owned;
    if (is_owned_[i]) {
      owned_[k] = static_cast<int>(i);
      is_shared_[i] = 0;
      continue;
    }
    const int r = owner(map.global[i]);
    ghosts_[r].push_back(static_cast<int>(i));
    ask[r].push_back(static_cast<PetscInt>(map.global[i]));
  }
  for (const int i : owned_)
    if (i < 0) fail("a rank does not hold a block that it owns", static_cast<int>(Exit::fault));
  const auto asked = comm().exchange(ask);
  for (int r = 0; r < n; ++r)
    for (const auto g : asked[r]) lent_[r].push_back(owned_[g - map.first]), is_shared_[lent_[r].back()] = 1;
}

int SharedBlocks::owner(std::int64_t global) const {
  return static_cast<int>(std::upper_bound(first_.begin(), first_.end() - 1, global) - first_.begin()) - 1;
}

namespace {

/// Blocks `from[r]` of each rank pair go to blocks `to[r]` of the other side, added or copied; the order of ranks is fixed, so sums repeat.
void move(std::span<double> local, const std::vector<std::vector<int>>& from, const std::vector<std::vector<int>>& to, bool add) {
  const int n = size();
  std::vector<MPI_Request> requests;
  std::vector<std::vector<double>> out(n), in(n);
  for (int r = 0; r < n; ++r) {
    if (!to[r].empty()) {
      in[r].resize(3 * to[r].size());
      MPI_Irecv(in[r].data(), static_cast<int>(in[r].size()), MPI_DOUBLE, r, 71, PETSC_COMM_WORLD, &requests.emplace_back());
    }
    if (!from[r].empty()) {
      out[r].reserve(3 * from[r].size());
      for (const int i : from[r]) out[r].insert(out[r].end(), local.begin() + 3 * i, local.begin() + 3 * i + 3);
      MPI_Isend(out[r].data(), static_cast<int>(out[r].size()), MPI_DOUBLE, r, 71, PETSC_COMM_WORLD, &requests.emplace_back());
    }
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  for (int r = 0; r < n; ++r)
    for (size_t k = 0; k < to[r].size(); ++k)
      for (int c = 0; c < 3; ++c) {
        double& x = local[3 * to[r][k] + c];
        x = in[r][3 * k + c] + (add ? x : 0);
      }
}

}  // namespace

void SharedBlocks::sum(std::span<double> local) const {
  if (first_.size() == 2) return;
  move(local, ghosts_, lent_, true);
  copy_out(local);
}

void SharedBlocks::copy_out(std::span<double> local) const {
  if (first_.size() > 2) move(local, lent_, ghosts_, false);
}

}  // namespace hilo::petsc
