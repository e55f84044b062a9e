// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/record/histories.hpp"

#include "dynamics/record/run_output.hpp"

namespace hilo {
namespace {

const std::string times = "/history/t", iterations = "/history/newton";

}  // namespace

Histories::Histories(const System& system) : system_(system) {
  outputs_ = {{.group = "", .name = "energy", .n_end = 6},
              {.group = "", .name = "momentum", .n_end = 6},
              {.group = "", .name = "constraint", .n_end = 1}};
  for (const Observer* part : system.all<Observer>())
    for (Output& output : part->outputs()) outputs_.push_back(std::move(output));
  for (const Output& output : outputs_) {
    arrays_.push_back("/history/" + (output.group.empty() ? output.name : output.group + "/" + to_link_name(output.name)));
    n_mid_ += static_cast<size_t>(output.n_mid);
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
  for (size_t k = 0; k < arrays_.size(); ++k) start_array<double>(f, arrays_[k], times, outputs_[k].n_end + outputs_[k].n_mid);
}

void Histories::shorten(Store& f, std::int64_t n_rows) const {
  f.keep_rows(times, n_rows), f.keep_rows(iterations, n_rows);
  for (const std::string& array : arrays_) f.keep_rows(array, n_rows);
}

void Histories::append(Store& f, double t, int newton, const std::vector<double>& end, const std::vector<double>& mid) const {
  f.append<double>(times, {&t, 1});
  const std::int32_t n = newton;
  f.append<std::int32_t>(iterations, {&n, 1});
  const double *e = end.data(), *m = mid.data();
  std::vector<double> row;
  for (size_t k = 0; k < outputs_.size(); ++k) {
    const Output& output = outputs_[k];
    if (output.row) {
      output.row(e, m, row);
    } else {
      row.assign(e, e + output.n_end);
      row.insert(row.end(), m, m + output.n_mid);
    }
    f.append<double>(arrays_[k], row);
    e += output.n_end, m += output.n_mid;
  }
}

}  // namespace hilo
