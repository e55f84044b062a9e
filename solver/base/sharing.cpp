// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/sharing.hpp"

#include <algorithm>
#include <unordered_map>

namespace hilo {

Sharing::Sharing(const Comm& comm, const std::vector<std::int64_t>& key) : comm_(&comm), to_(comm.size), from_(comm.size) {
  if (comm.size == 1) return;
  // a rank chosen by the number alone hears of every thing, and combines those that more than one rank has told it of
  const auto place = [&](std::int64_t k) { return static_cast<int>(static_cast<std::uint64_t>(k) * 0x9E3779B97F4A7C15u % comm.size); };
  std::vector<std::vector<std::int64_t>> ask(comm.size), thing(comm.size);
  for (size_t i = 0; i < key.size(); ++i)
    ask[place(key[i])].push_back(key[i]), thing[place(key[i])].push_back(static_cast<std::int64_t>(i));
  const auto asked = comm.exchange(ask);
  std::unordered_map<std::int64_t, int> holders;
  for (const auto& list : asked)
    for (const std::int64_t k : list) ++holders[k];
  std::unordered_map<std::int64_t, std::int64_t> combined;
  std::vector<std::vector<std::int64_t>> answer(comm.size);
  for (int r = 0; r < comm.size; ++r)
    for (const std::int64_t k : asked[r]) {
      const bool several = holders[k] > 1;
      answer[r].push_back(several);
      if (several) from_[r].push_back(combined.try_emplace(k, static_cast<std::int64_t>(combined.size())).first->second);
    }
  n_combined_ = static_cast<std::int64_t>(combined.size());
  const auto answered = comm.exchange(answer);
  for (int r = 0; r < comm.size; ++r)
    for (size_t i = 0; i < thing[r].size(); ++i)
      if (answered[r][i]) to_[r].push_back(thing[r][i]);
}

void Sharing::combine(std::vector<double>& values, int width, By by) const {
  if (comm_->size == 1) return;
  std::vector<std::vector<double>> send(comm_->size);
  for (int r = 0; r < comm_->size; ++r)
    for (const std::int64_t i : to_[r]) send[r].insert(send[r].end(), values.begin() + i * width, values.begin() + (i + 1) * width);
  auto received = comm_->exchange(send);
  std::vector<double> all(n_combined_ * width);
  std::vector<char> begun(n_combined_);
  for (int r = 0; r < comm_->size; ++r)
    for (size_t k = 0; k < from_[r].size(); ++k) {
      double* to = all.data() + from_[r][k] * width;
      const double* v = received[r].data() + k * width;
      const bool first = !begun[from_[r][k]];
      begun[from_[r][k]] = 1;
      for (int c = 0; c < width; ++c) to[c] = first ? v[c] : by == By::sum ? to[c] + v[c] : std::max(to[c], v[c]);
    }
  for (int r = 0; r < comm_->size; ++r)
    for (size_t k = 0; k < from_[r].size(); ++k) std::copy_n(all.data() + from_[r][k] * width, width, received[r].data() + k * width);
  const auto back = comm_->exchange(received);
  for (int r = 0; r < comm_->size; ++r)
    for (size_t k = 0; k < to_[r].size(); ++k) std::copy_n(back[r].data() + k * width, width, values.begin() + to_[r][k] * width);
}

}  // namespace hilo
