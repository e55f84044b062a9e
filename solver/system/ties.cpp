// SPDX-License-Identifier: GPL-3.0-or-later
#include <numeric>

#include "system/contribution.hpp"

namespace hilo {

Ties::Ties(int n_bodies) : parent_(n_bodies), freedoms_(n_bodies, 0), excluded_(n_bodies, 0) {
  std::iota(parent_.begin(), parent_.end(), 0);
}

int Ties::root(int b) const {
  while (parent_[b] != b) b = parent_[b] = parent_[parent_[b]];
  return b;
}

void Ties::connect(int a, int b) { parent_[root(a)] = root(b); }

Traits& Traits::operator|=(const Traits& o) {
  deforms |= o.deforms, constrains |= o.constrains, has_rates |= o.has_rates;
  is_pressed |= o.is_pressed, is_driven |= o.is_driven, remembers |= o.remembers, searches |= o.searches;
  is_thin |= o.is_thin, lumps_masses |= o.lumps_masses, slides |= o.slides, reaches |= o.reaches;
  return *this;
}

}  // namespace hilo
