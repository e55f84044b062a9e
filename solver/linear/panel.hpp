// SPDX-License-Identifier: GPL-3.0-or-later
// Triangular solves with one supernode of a factor and one right-hand side: each column is read once, with what lies below it, in the order
// of memory and at its speed, which a triangular solve and a product by the BLAS do not reach for columns as short as these.
#pragma once

namespace hilo::supernodal {

/// L: (rows x m) by columns `stride` apart, lower triangle in its first m rows.
/// y[0..m) := L^-1 y, y[m..rows) -= L_below y[0..m)
void forward_panel(int m, int rows, const float* L, int stride, float* y);
void forward_panel(int m, int rows, const double* L, int stride, double* y);
/// y[0..m) := L^-T (y[0..m) - L_below^T y[m..rows))
void backward_panel(int m, int rows, const float* L, int stride, float* y);
void backward_panel(int m, int rows, const double* L, int stride, double* y);

}  // namespace hilo::supernodal
