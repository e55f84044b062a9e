// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers between those of two entries of one kind; all else is of the first.
#pragma once
#include <cmath>
#include <map>

#include "base/entry_values.hpp"

namespace hilo {

class ValuesBetween final : public EntryValues {
 public:
  /// share: 0 at a, 1 at b.
  ValuesBetween(const EntryValues& a, const EntryValues& b, double share) : a_(a), b_(b), share_(share) {}
  bool has(std::string_view key) const override { return a_.has(key); }
  bool given(std::string_view key) const override { return a_.given(key); }
  double number(std::string_view key) const override { return std::lerp(a_.number(key), b_.number(key), share_); }
  Vec3 vector3(std::string_view key) const override { return (1 - share_) * a_.vector3(key) + share_ * b_.vector3(key); }
  const std::vector<double>& numbers(std::string_view key) const override {
    std::vector<double>& out = numbers_[std::string(key)];
    out.clear();
    for (size_t i = 0; i < a_.numbers(key).size(); ++i) out.push_back(std::lerp(a_.numbers(key)[i], b_.numbers(key).at(i), share_));
    return out;
  }
  const std::string& text(std::string_view key) const override { return a_.text(key); }
  const std::vector<std::string>& texts(std::string_view key) const override { return a_.texts(key); }
  bool boolean(std::string_view key) const override { return a_.boolean(key); }
  const History& history(std::string_view key) const override { return a_.history(key); }
  std::string where(std::string_view key) const override { return a_.where(key); }
  std::string label() const override { return a_.label(); }

 private:
  const EntryValues &a_, &b_;
  double share_;
  mutable std::map<std::string, std::vector<double>> numbers_;
};

}  // namespace hilo
