// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/contact/near_boxes.hpp"

#include <algorithm>
#include <numeric>

namespace hilo {
namespace {

class Tree {
 public:
  explicit Tree(std::span<const AxisBox> boxes) : boxes_(boxes), order_(boxes.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    if (!boxes.empty()) add(0, static_cast<int>(boxes.size()));
  }
  template <class Visit>
  void each_that_meets(const AxisBox& box, Visit&& visit) const {
    thread_local std::vector<int> open;
    open.assign(branch_.empty() ? 0 : 1, 0);
    while (!open.empty()) {
      const Branch& branch = branch_[open.back()];
      open.pop_back();
      if (!branch.box.meets(box)) continue;
      if (branch.child[0] >= 0) {
        open.insert(open.end(), branch.child, branch.child + 2);
        continue;
      }
      for (int k = branch.first; k < branch.last; ++k)
        if (boxes_[order_[k]].meets(box)) visit(order_[k]);
    }
  }

 private:
  struct Branch {
    AxisBox box;
    int first = 0, last = 0, child[2] = {-1, -1};
  };
  int add(int first, int last) {
    constexpr int few = 8;
    const auto number = static_cast<int>(branch_.size());
    branch_.push_back({.box = {}, .first = first, .last = last});
    AxisBox all, middles;
    for (int k = first; k < last; ++k) all.take(boxes_[order_[k]]), middles.take(middle(order_[k]));
    branch_[number].box = all;
    if (last - first <= few) return number;
    int axis = 0;
    (middles.high - middles.low).maxCoeff(&axis);
    const int half = (first + last) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + last, [&](int i, int j) {
      const double x = middle(i)[axis], y = middle(j)[axis];
      return x < y || (x == y && i < j);
    });
    const int low = add(first, half), high = add(half, last);
    branch_[number].child[0] = low, branch_[number].child[1] = high;
    return number;
  }
  Vec3 middle(int i) const { return (boxes_[i].low + boxes_[i].high) / 2; }

  std::span<const AxisBox> boxes_;
  std::vector<int> order_;
  std::vector<Branch> branch_;
};

}  // namespace

std::vector<std::pair<int, int>> near_boxes(std::span<const AxisBox> a, std::span<const AxisBox> b) {
  const Tree tree(b);
  std::vector<std::pair<int, int>> out;
  for (int i = 0; i < static_cast<int>(a.size()); ++i) {
    const size_t before = out.size();
    tree.each_that_meets(a[i], [&](int j) { out.emplace_back(i, j); });
    std::sort(out.begin() + static_cast<std::ptrdiff_t>(before), out.end());
  }
  return out;
}

}  // namespace hilo
