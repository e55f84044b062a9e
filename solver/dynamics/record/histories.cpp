// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/record/histories.hpp"

#include <fmt/format.h>

#include <map>

#include "dynamics/record/run_output.hpp"

namespace hilo {
namespace {

constexpr size_t most_apart = 256;  // histories of a group, each an array of its own; more become one table

const std::string times = "/history/t", iterations = "/history/newton";

/// Columns of the histories in an output's group by the schema; 0 where it leaves them open.
std::int64_t schema_width(const Output& output) {
  const auto shape = row_shape(run_array("/history/" + output.group + "/any"));
  return shape.empty() ? 1 : shape[0];
}

}  // namespace

Histories::Histories(const System& system) : system_(system) {
  outputs_ = {{.group = "", .name = "energy", .n_end = 6},
              {.group = "", .name = "momentum", .n_end = 6},
              {.group = "", .name = "constraint", .n_end = 1}};
  for (const Observer* part : system.all<Observer>())
    for (Output& output : part->outputs()) outputs_.push_back(std::move(output));
  std::map<std::pair<std::string, std::int64_t>, size_t> alike;  // of a group, as wide
  std::map<std::string, std::int64_t> widths;                    // of groups, by the schema; 0: as many as a history has
  const auto width_of = [&](const Output& o) {
    const auto found = widths.find(o.group);
    const std::int64_t width = found != widths.end() ? found->second : widths[o.group] = schema_width(o);
    return width > 0 ? width : o.n_end + o.n_mid;
  };
  const auto kind_of = [&](const Output& o) { return std::pair{o.group, width_of(o)}; };
  std::map<std::string, size_t> in_group;
  for (const Output& output : outputs_)
    if (!output.group.empty()) ++alike[kind_of(output)], ++in_group[output.group];
  std::map<std::string, int> made;
  for (const Output& output : outputs_) {
    n_mid_ += static_cast<size_t>(output.n_mid);
    const std::string group = "/history/" + output.group, link = to_link_name(output.name);
    int& table = table_of_.emplace_back(-1);
    if (!output.group.empty() && in_group[output.group] > most_apart && alike[kind_of(output)] == in_group[output.group]) {
      const auto [at, is_new] = made.emplace(output.group, static_cast<int>(tables_.size()));
      if (is_new) tables_.push_back({group, {}, static_cast<size_t>(width_of(output))});
      table = at->second;
      tables_[table].members.push_back(link), arrays_.emplace_back();
    } else {
      arrays_.push_back(output.group.empty() ? "/history/" + output.name : group + "/" + link);
    }
  }
}

Histories::Numbers Histories::numbers(double t, const Config& q, const Config& v, const Ledger& ledger, const Moment* step) const {
  const Energy& e = ledger.energy;
  Numbers out;
  std::vector<double>& end = out.end;
  end = {e.kinetic, e.elastic, e.gravity, ledger.work, ledger.dissipated, ledger.balance};
  end.insert(end.end(), e.momentum.data(), e.momentum.data() + 3);
  end.insert(end.end(), e.angular.data(), e.angular.data() + 3);
  end.push_back(ledger.rows.worst());
  for (Observer* part : system_.all<Observer>()) part->observe({t, q, v, step, end, out.mid});
  return out;
}

void Histories::declare(Store& f) {
  start_array<double>(f, times);
  start_array<std::int32_t>(f, iterations, times);
  for (size_t k = 0; k < arrays_.size(); ++k)
    if (table_of_[k] < 0) start_array<double>(f, arrays_[k], times, outputs_[k].n_end + outputs_[k].n_mid);
  for (const Table& table : tables_) {
    const ArraySchema& of = run_array(table.group + "/any");
    f.start_table<double>(table.group, table.members, static_cast<std::int64_t>(table.width), std::string(of.unit), std::string(of.meaning),
                          times);
  }
}

void Histories::hold(std::vector<double>& mid, std::span<const std::vector<double>* const> all) const {
  size_t first = 0;
  for (const Output& output : outputs_) {
    const auto n = static_cast<Eigen::Index>(output.n_mid);
    const auto of = [&](const std::vector<double>& values) { return Eigen::Map<const Eigen::VectorXd>(values.data() + first, n); };
    if (output.only_presses) {
      const Eigen::VectorXd nearest = of(*all[0]);
      const bool was_open = std::ranges::any_of(all, [&](const auto* values) { return of(*values).isZero(0); });
      if (was_open || of(mid).dot(nearest) < nearest.squaredNorm() / 2) Eigen::Map<Eigen::VectorXd>(mid.data() + first, n) = nearest;
    }
    first += static_cast<size_t>(n);
  }
}

void Histories::take_apart(size_t table) {
  for (size_t k = 0; k < arrays_.size(); ++k)
    if (table_of_[k] == static_cast<int>(table)) {
      table_of_[k] = -1, arrays_[k] = tables_[table].group + "/" + to_link_name(outputs_[k].name);
    } else if (table_of_[k] > static_cast<int>(table)) {
      --table_of_[k];
    }
  tables_.erase(tables_.begin() + static_cast<std::ptrdiff_t>(table));
}

void Histories::go_on(Store& f, std::int64_t n_rows) {
  for (size_t k = tables_.size(); k-- > 0;)
    if (!f.is_table(tables_[k].group)) take_apart(k);
  std::vector<std::string> arrays{times, iterations};
  for (const std::string& array : arrays_)
    if (!array.empty()) arrays.push_back(array);
  for (const std::string& array : arrays)
    if (const std::int64_t had = f.has(array) ? f.shape(array)[0] : 0; had < n_rows)
      throw Error(f.path(), fmt::format("{} has {} rows, wanted {} to go on from", array, had, n_rows));
  declare(f);
  for (const std::string& array : arrays) f.keep_rows(array, n_rows);
  for (const Table& table : tables_) f.keep_rows(table.group, n_rows);
}

void Histories::append(Store& f, double t, int newton, const std::vector<double>& end, const std::vector<double>& mid) const {
  f.append<double>(times, {&t, 1});
  const std::int32_t n = newton;
  f.append<std::int32_t>(iterations, {&n, 1});
  const double *e = end.data(), *m = mid.data();
  std::vector<double> row;
  std::vector<std::vector<double>> together(tables_.size());
  for (size_t k = 0; k < outputs_.size(); ++k) {
    const Output& output = outputs_[k];
    if (output.row) {
      output.row(e, m, row);
    } else {
      row.assign(e, e + output.n_end);
      row.insert(row.end(), m, m + output.n_mid);
    }
    if (table_of_[k] < 0)
      f.append<double>(arrays_[k], row);
    else
      together[table_of_[k]].insert(together[table_of_[k]].end(), row.begin(), row.end());
    e += output.n_end, m += output.n_mid;
  }
  for (size_t k = 0; k < tables_.size(); ++k) f.append_table<double>(tables_[k].group, together[k]);
}

}  // namespace hilo
