// Stress of nodes and cells in the result: recovered by the ranks, brought together where the rows are written.
#include <algorithm>

#include "dynamics/recorder.hpp"
#include "dynamics/stress_recovery.hpp"

namespace hilo {

/// A node's stress is that of its first flexible region (first: lowest number) over all ranks.
void Recorder::write_stress(const Row& row, const std::string& group) {
  constexpr int n_sent = 10;  // row, region, stress, von Mises, error
  const System& s = system_;
  if (!recovery_) recovery_ = std::make_shared<StressRecovery>(s);
  const auto at = recovery_->recover(row.q.x);
  std::vector<std::vector<double>> send(s.comm->size);
  for (size_t i = 0; i < recovery_->sites().size(); ++i) {
    const auto& site = recovery_->sites()[i];
    const std::int64_t to_row = node_row_[site.node];
    if (to_row < 0) continue;
    auto& to = send[nodes_->rank_of(to_row)];
    to.push_back(static_cast<double>(to_row)), to.push_back(site.region);
    to.insert(to.end(), at.stress[i].data(), at.stress[i].data() + 6);
    to.push_back(at.von_mises[i]), to.push_back(at.error[i]);
  }
  const auto count = static_cast<size_t>(nodes_->count());
  std::vector<double> region(count, -1.0), stress(6 * count, 0.0), vm(count, 0.0), error(count, 0.0);
  for (const auto& list : s.comm->exchange(send))
    for (size_t k = 0; k < list.size(); k += n_sent) {
      const auto i = static_cast<size_t>(static_cast<std::int64_t>(list[k]) - nodes_->first());
      if (region[i] >= 0 && region[i] <= list[k + 1]) continue;
      region[i] = list[k + 1];
      std::copy_n(list.data() + k + 2, 6, stress.data() + 6 * i);
      vm[i] = list[k + 8], error[i] = list[k + 9];
    }
  if (setup_.wants("stress")) write_piece(*nodes_, group + "/stress", stress, 6, "Pa", "Cauchy stress xx yy zz yz xz xy");
  if (setup_.wants("stress_error"))
    write_piece(*nodes_, group + "/stress_error", error, 1, "Pa", "von Mises stress of what recovery changes");
  if (!setup_.wants("von_mises")) return;
  write_piece(*nodes_, group + "/von_mises", vm, 1, "Pa", "von Mises stress");
  if (!setup_.skin)
    write_piece(*cells_, group + "/cell_von_mises", cells_->collect(at.cell, 1), 1, "Pa",
                "von Mises stress, mean over the integration points");
}

}  // namespace hilo
