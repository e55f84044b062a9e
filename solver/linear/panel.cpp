// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/panel.hpp"

#include <cstring>

#include "base/wide.hpp"

namespace hilo::supernodal {
namespace {

// One column after the other: the factor is read in the order in which it lies in memory, which the processor fetches ahead.
template <class T>
[[gnu::always_inline]] inline void forward(int m, int rows, const T* L, int stride, T* __restrict y) {
  for (int c = 0; c < m; ++c, L += stride) {
    const T x = y[c] /= L[c];
    for (int r = c + 1; r < rows; ++r) y[r] -= L[r] * x;
  }
}

template <class T>
[[gnu::always_inline]] inline void backward(int m, int rows, const T* L, int stride, T* y) {
  typedef T V __attribute__((vector_size(64)));
  constexpr int W = 64 / sizeof(T), n = 4;
  for (int c = m; c-- > 0;) {
    const T* column = L + static_cast<long>(c) * stride;
    V part[n] = {};
    int r = rows;
    for (; r - n * W > c; r -= n * W)
      for (int k = 0; k < n; ++k) {
        V l, v;
        std::memcpy(&l, column + r - (k + 1) * W, sizeof(V)), std::memcpy(&v, y + r - (k + 1) * W, sizeof(V));
        part[k] += l * v;
      }
    for (; r - W > c; r -= W) {
      V l, v;
      std::memcpy(&l, column + r - W, sizeof(V)), std::memcpy(&v, y + r - W, sizeof(V));
      part[0] += l * v;
    }
    part[0] += part[1] + (part[2] + part[3]);
    T sum = 0;
    for (int k = c + 1; k < r; ++k) sum += column[k] * y[k];
    for (int k = 0; k < W; ++k) sum += part[0][k];
    y[c] = (y[c] - sum) / column[c];
  }
}

}  // namespace

HILO_WIDE void forward_panel(int m, int rows, const float* L, int stride, float* y) { forward(m, rows, L, stride, y); }
HILO_WIDE void forward_panel(int m, int rows, const double* L, int stride, double* y) { forward(m, rows, L, stride, y); }
HILO_WIDE void backward_panel(int m, int rows, const float* L, int stride, float* y) { backward(m, rows, L, stride, y); }
HILO_WIDE void backward_panel(int m, int rows, const double* L, int stride, double* y) { backward(m, rows, L, stride, y); }

}  // namespace hilo::supernodal
