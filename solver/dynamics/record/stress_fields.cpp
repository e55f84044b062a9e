// SPDX-License-Identifier: GPL-3.0-or-later
// Stress of nodes and cells in the result: recovered by the ranks, brought together where the rows are written.
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>

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

  /// A node's stress is that of its first flexible region (first: lowest number) over all ranks; that of others has rows of its own.
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
    write_borders(at, to, shells);
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
  /// Sites of other regions than the first of their node, on all ranks.
  struct Borders {
    std::optional<Slabs> rows;
    std::vector<std::int64_t> row, region;  // the node's, of each; the same on all ranks
  };

  void find_borders(const Slabs& nodes) {
    const Comm& comm = *system_.comm;
    const auto& sites = recovery_->sites();
    using Key = std::pair<std::int64_t, std::int64_t>;  // row, what a site calls its region
    std::vector<std::vector<std::int64_t>> send(comm.size);
    for (const auto& site : sites)
      if (const std::int64_t row = node_row_[site.node]; row >= 0) {
        auto& list = send[nodes.rank_of(row)];
        list.push_back(row), list.push_back(site.region);
      }
    std::set<Key> met;
    for (const auto& list : comm.exchange(send))
      for (size_t k = 0; k < list.size(); k += 2) met.insert({list[k], list[k + 1]});
    std::vector<std::int64_t> mine;
    Key last{-1, -1};
    for (const Key& key : met) {
      if (key.first == last.first && key.second / 2 == last.second / 2) continue;  // bars beside cells of the same region
      if (key.first == last.first) mine.push_back(key.first), mine.push_back(key.second);
      last = key;
    }
    std::map<Key, std::int64_t> number;
    borders_.emplace();
    for (const auto& list : comm.exchange(std::vector<std::vector<std::int64_t>>(comm.size, mine)))
      for (size_t k = 0; k < list.size(); k += 2) {
        number.emplace(Key{list[k], list[k + 1]}, std::ssize(borders_->row));
        borders_->row.push_back(list[k]), borders_->region.push_back(list[k + 1] / 2);
      }
    std::vector<std::int64_t> of_site;
    for (const auto& site : sites) {
      const auto at = number.find({node_row_[site.node], site.region});
      of_site.push_back(at == number.end() ? -1 : at->second);
    }
    borders_->rows.emplace(comm, std::move(of_site), std::ssize(borders_->row));
  }

  void write_borders(const StressRecovery::Result& at, FieldWriter& to, bool shells) {
    if (!to.keeps()) return;
    if (!borders_) {
      find_borders(to.node_rows());
      if (!borders_->row.empty()) to.list("/border/row", borders_->row), to.list("/border/region", borders_->region);
    }
    if (borders_->row.empty()) return;
    const auto flat = [](const auto& list, const auto& values) {
      std::vector<double> out;
      for (const auto& one : list) {
        const auto its = values(one);
        out.insert(out.end(), its.begin(), its.end());
      }
      return out;
    };
    const Slabs& rows = *borders_->rows;
    if (to.wants("stress")) to.border(rows, "stress", flat(at.stress, [](const Vec6& s) { return s; }), 6);
    if (to.wants("von_mises")) to.border(rows, "von_mises", at.von_mises, 1);
    if (to.wants("stress_error")) to.border(rows, "stress_error", at.error, 1);
    if (to.wants("plastic_strain") && system_.traits().remembers) to.border(rows, "plastic_strain", at.plastic, 1);
    if (!shells) return;
    using Shell = StressRecovery::ShellValues;
    to.border(rows, shell_array[0], flat(at.shell, [](const Shell& s) { return std::span(s.force); }), shell_width[0]);
    to.border(rows, shell_array[1], flat(at.shell, [](const Shell& s) { return std::span(s.moment); }), shell_width[1]);
    to.border(rows, shell_array[2], flat(at.shell, [](const Shell& s) { return std::span(s.stress); }), shell_width[2]);
    to.border(rows, shell_array[3], flat(at.shell, [](const Shell& s) { return s.axis; }), shell_width[3]);
  }

  const System& system_;
  const std::vector<std::int64_t>& node_row_;
  std::optional<Borders> borders_;
  std::optional<StressRecovery> recovery_;  // made with the first field that needs it
};

}  // namespace

std::unique_ptr<FieldSource> stress_fields(const System& system, const std::vector<std::int64_t>& node_row) {
  return std::make_unique<StressFields>(system, node_row);
}

}  // namespace hilo
