// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/spread.hpp"

#include <algorithm>
#include <limits>

namespace hilo {

std::vector<double> Spread::gather(const std::vector<double>& local, int width) const {
  std::int64_t most = 0;
  for (const std::int64_t n : number_) most = std::max(most, n + 1);
  const auto n_all = static_cast<size_t>(comm_->max(static_cast<double>(most)));  // below 2^53
  std::vector<double> all(comm_->rank == 0 ? n_all * width : 0, std::numeric_limits<double>::quiet_NaN());
  const auto put = [&](std::int64_t number, const double* from) { std::copy_n(from, width, all.data() + number * width); };
  if (comm_->size == 1) {
    for (size_t i = 0; i < number_.size(); ++i) put(number_[i], local.data() + i * width);
    return all;
  }
  std::vector<std::vector<double>> to(comm_->size);
  for (size_t i = 0; i < number_.size(); ++i) {
    to[0].push_back(static_cast<double>(number_[i]));
    to[0].insert(to[0].end(), local.begin() + i * width, local.begin() + (i + 1) * width);
  }
  for (const auto& list : comm_->exchange(to))
    for (size_t k = 0; k < list.size(); k += width + 1) put(static_cast<std::int64_t>(list[k]), list.data() + k + 1);
  return all;
}

std::vector<double> Spread::pick(const std::vector<double>& all, int width) const {
  std::vector<double> everyones = all, local;
  everyones.resize(static_cast<size_t>(comm_->max(static_cast<double>(all.size()))));
  comm_->copy(everyones, 0);
  local.reserve(number_.size() * width);
  for (const std::int64_t n : number_)
    for (int k = 0; k < width; ++k) {
      const size_t at = n * width + k;
      local.push_back(at < everyones.size() ? everyones[at] : std::numeric_limits<double>::quiet_NaN());
    }
  return local;
}

}  // namespace hilo
