#include "physics/cell_kind.hpp"

#include <deque>

#include "base/error.hpp"

namespace hilo {
namespace {

std::deque<CellKind>& kinds() {
  static std::deque<CellKind> list;
  return list;
}

}  // namespace

void add_cell(const CellKind& kind) {
  if (static_cast<int>(kind.shape) < n_shapes || cell_from_outside(kind.shape))
    throw Error("", "two kinds of cells have the same shape", "", Exit::fault);
  kinds().push_back(kind);
}

const CellKind* cell_from_outside(Shape shape) {
  for (const CellKind& k : kinds())
    if (k.shape == shape) return &k;
  return nullptr;
}

}  // namespace hilo
