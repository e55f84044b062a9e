// SPDX-License-Identifier: GPL-3.0-or-later
// 3 x 3 blocks in single precision, packed column after column, and what four lanes make of them.
#pragma once
#include <cstring>
#include <vector>

namespace hilo::petsc {

using Lane = float __attribute__((vector_size(16)));  // three values, padded

struct FloatBlock {
  Lane c[3];  // columns; the last lane is anything
};

class FloatBlocks {
 public:
  void resize(size_t n) { values_.assign(9 * n + 3, 0.0f), values_.shrink_to_fit(); }  // the last block is read as four lanes, too
  void zero() { std::memset(values_.data(), 0, values_.size() * sizeof(float)); }
  size_t size() const { return values_.empty() ? 0 : (values_.size() - 3) / 9; }
  double bytes() const { return 4. * static_cast<double>(values_.size()); }
  /// Nine values by columns.
  float* operator[](size_t k) { return values_.data() + 9 * k; }
  const float* operator[](size_t k) const { return values_.data() + 9 * k; }
  FloatBlock load(size_t k) const {
    FloatBlock b;
    for (int c = 0; c < 3; ++c) std::memcpy(&b.c[c], values_.data() + 9 * k + 3 * c, sizeof(Lane));
    return b;
  }

 private:
  std::vector<float> values_;
};

inline Lane times(const FloatBlock& m, const Lane& v) { return m.c[0] * v[0] + m.c[1] * v[1] + m.c[2] * v[2]; }

inline Lane without_last(const Lane& v) { return __builtin_shufflevector(v, Lane{}, 0, 1, 2, 4); }

/// m^T v; the last lane of v is zero and that of the result, too.
inline Lane transposed_times(const FloatBlock& m, const Lane& v) {
  constexpr Lane zero{};
  const Lane p = m.c[0] * v, q = m.c[1] * v, r = m.c[2] * v;
  const Lane pq = __builtin_shufflevector(p, q, 0, 4, 1, 5) + __builtin_shufflevector(p, q, 2, 6, 3, 7);
  const Lane rz = __builtin_shufflevector(r, zero, 0, 4, 1, 5) + __builtin_shufflevector(r, zero, 2, 6, 3, 7);
  return __builtin_shufflevector(pq, rz, 0, 1, 4, 5) + __builtin_shufflevector(pq, rz, 2, 3, 6, 7);
}

}  // namespace hilo::petsc
