// Compressions beyond which a law or a cell is no longer what it stands for, told once for a region, at the state that reaches them.
//
// St. Venant-Kirchhoff: a bar of stretch l carries S l = Y l (l^2 - 1)/2, which falls from l = 1/sqrt 3 on: it softens, and inverts without
// resistance.  Cells of one or eight points: modes that they do not see turn up from stretches of .55 to .5 on (docs/elements.md).
#include <fmt/format.h>

#include <algorithm>

#include "physics/stretch.hpp"
#include "system/system.hpp"

namespace hilo {
namespace {

constexpr double soft = 0.58, folded = 0.55;

bool sees_less(Shape s) { return s == Shape::hex8 || s == Shape::hex20r; }
double limit(const SolidBatch& b) { return b.law == Law::stvk ? soft : sees_less(b.shape) ? folded : 0; }

}  // namespace

void System::watch_strain(const Config& q) {
  if (!mesh || !flexible) return;
  const auto& names = mesh->mesh.region_name;
  strain_told_.resize(names.size(), 0);
  std::vector<double> beyond(2 * names.size(), 0.0);  // by region: how far below the limit, of the law and of the cells
  std::vector<Vec3> from, to;
  for (const SolidBatch& b : batches) {
    const double floor = limit(b);
    if (floor == 0 || strain_told_[b.region]) continue;
    const auto n = static_cast<size_t>(info(b.shape).n_nodes);
    from.resize(n), to.resize(n);
    double& worst = beyond[2 * b.region + (b.law == Law::stvk ? 0 : 1)];
    for (size_t e = 0; e < b.cells.size(); ++e) {
      for (size_t a = 0; a < n; ++a) from[a] = X[b.nodes[e * n + a]], to[a] = q.x[b.nodes[e * n + a]];
      worst = std::max(worst, floor - least_stretch(b.shape, from, to, floor));
    }
  }
  if (!(comm->max(*std::max_element(beyond.begin(), beyond.end())) > 0)) return;
  for (double& v : beyond) v = comm->max(v);
  for (size_t r = 0; r < names.size(); ++r) {
    const double law = beyond[2 * r], cells = beyond[2 * r + 1];
    if (!(law > 0 || cells > 0)) continue;
    strain_told_[r] = 1;
    if (comm->rank != 0) continue;
    if (law > 0)
      warn(names[r],
           fmt::format("compressed to {:.2g} of a length: below 0.58 a St. Venant-Kirchhoff material softens and turns inside out "
                       "without resistance (kind = \"neo-hookean\" stiffens)",
                       soft - law));
    else
      warn(names[r],
           fmt::format("compressed to {:.2g} of a length: below 0.55 hex8 and hex20r may fold in modes that their points do not see "
                       "(C3D20 or tet10 do not)",
                       folded - cells));
  }
}

}  // namespace hilo
