// SPDX-License-Identifier: GPL-3.0-or-later
// Stress of nodes and cells in the result: recovered by the ranks, brought together where the rows are written.
#include <algorithm>
#include <optional>

#include "dynamics/record/fields.hpp"
#include "dynamics/stress_recovery.hpp"

namespace hilo {
namespace {

constexpr int n_shell_arrays = 4, shell_width[n_shell_arrays] = {5, 3, 6, 3}, n_shell = 17;
constexpr const char* shell_array[n_shell_arrays] = {"shell_force", "shell_moment", "shell_stress", "shell_axis"};

class StressFields final : public FieldSource {
 public:
  StressFields(const System& system, const std::vector<std::int64_t>& node_row) : system_(system), node_row_(node_row) {}
  std::vector<Field> fields() const override {
    return {{.name = "stress"},
            {.name = "von_mises", .label = "von Mises [Pa]"},
            {.name = "cell_von_mises", .key = "von_mises", .label = "cell von Mises [Pa]", .of_cells = true},
            {.name = "stress_error", .label = "stress error [Pa]"},
            {.name = "plastic_strain", .label = "plastic strain"},
            {.name = "cell_plastic_strain", .key = "plastic_strain", .label = "cell plastic strain", .of_cells = true},
            {.name = "shell_force", .key = "shell"},
            {.name = "shell_moment", .key = "shell"},
            {.name = "shell_stress", .key = "shell"},
            {.name = "shell_axis", .key = "shell", .label = "shell axis 1"}};
  }

  /// A node's stress is that of its first flexible region (first: lowest number) over all ranks.
  void write(const Snapshot& instant, FieldWriter& to) override {
    const bool shells = to.wants("shell");
    const int n_sent = shells ? 11 + n_shell : 11;  // row, region, stress, von Mises, error, plastic strain; of shells
    if (!recovery_) recovery_.emplace(system_);
    const auto at = recovery_->recover(instant.q, instant.memory, shells);
    const Slabs& rows = to.node_rows();
    std::vector<std::vector<double>> send(system_.comm->size);
    for (size_t i = 0; i < recovery_->sites().size(); ++i) {
      const auto& site = recovery_->sites()[i];
      const std::int64_t to_row = node_row_[site.node];
      if (to_row < 0) continue;
      auto& list = send[rows.rank_of(to_row)];
      list.push_back(static_cast<double>(to_row)), list.push_back(site.region);
      list.insert(list.end(), at.stress[i].data(), at.stress[i].data() + 6);
      list.push_back(at.von_mises[i]), list.push_back(at.error[i]), list.push_back(at.plastic[i]);
      if (!shells) continue;
      const auto& s = at.shell[i];
      list.insert(list.end(), std::begin(s.force), std::end(s.force)), list.insert(list.end(), std::begin(s.moment), std::end(s.moment));
      list.insert(list.end(), std::begin(s.stress), std::end(s.stress)), list.insert(list.end(), s.axis.data(), s.axis.data() + 3);
    }
    const auto count = static_cast<size_t>(rows.count());
    std::vector<double> region(count, -1.0), stress(6 * count, 0.0), vm(count, 0.0), error(count, 0.0), plastic(count, 0.0);
    std::vector<double> shell[n_shell_arrays];
    for (int a = 0; a < n_shell_arrays && shells; ++a) shell[a].assign(count * static_cast<size_t>(shell_width[a]), 0.0);
    for (const auto& list : system_.comm->exchange(send))
      for (size_t k = 0; k < list.size(); k += static_cast<size_t>(n_sent)) {
        const auto i = static_cast<size_t>(static_cast<std::int64_t>(list[k]) - rows.first());
        if (region[i] >= 0 && region[i] <= list[k + 1]) continue;
        region[i] = list[k + 1];
        std::copy_n(list.data() + k + 2, 6, stress.data() + 6 * i);
        vm[i] = list[k + 8], error[i] = list[k + 9], plastic[i] = list[k + 10];
        const double* from = list.data() + k + 11;
        for (int a = 0; a < n_shell_arrays && shells; from += shell_width[a++])
          std::copy_n(from, shell_width[a], shell[a].data() + i * static_cast<size_t>(shell_width[a]));
      }
    for (int a = 0; a < n_shell_arrays && shells; ++a) to.piece(shell_array[a], shell[a]);
    if (to.wants("plastic_strain") && system_.traits().remembers) {
      to.piece("plastic_strain", plastic);
      to.cells("cell_plastic_strain", at.cell_plastic, 1);
    }
    if (to.wants("stress")) to.piece("stress", stress);
    if (to.wants("stress_error")) to.piece("stress_error", error);
    if (!to.wants("von_mises")) return;
    to.piece("von_mises", vm);
    to.cells("cell_von_mises", at.cell, 1);
  }

 private:
  const System& system_;
  const std::vector<std::int64_t>& node_row_;
  std::optional<StressRecovery> recovery_;  // made with the first field that needs it
};

}  // namespace

std::unique_ptr<FieldSource> stress_fields(const System& system, const std::vector<std::int64_t>& node_row) {
  return std::make_unique<StressFields>(system, node_row);
}

}  // namespace hilo
