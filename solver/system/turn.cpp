// How far bodies and cells turn from one configuration to another.
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "system/system.hpp"

namespace hilo {
namespace {

/// cos^2(angle/2) of a rotation: R0^T R1 has the trace 1 + 2 cos(angle).
double half_cosine2(const Mat3& R0, const Mat3& R1) { return (R0.cwiseProduct(R1).sum() + 1) / 4; }

/// The same of a cell whose edges at one corner go from D0 to D1: det((D0 + D1)/2)/sqrt(det D0 det D1) is cos^2(angle/2) of a rotation,
/// and larger where the cell is stretched besides.  Of a bar, by its direction.
double half_cosine2(const Eigen::Matrix3d& D0, const Eigen::Matrix3d& D1, int dimension) {
  if (dimension == 1) return (1 + D0.col(0).dot(D1.col(0)) / std::sqrt(D0.col(0).squaredNorm() * D1.col(0).squaredNorm())) / 2;
  const double both = D0.determinant() * D1.determinant();
  return both > 0 ? ((D0 + D1) / 2).determinant() / std::sqrt(both) : 1;
}

}  // namespace

System::Turn System::largest_turn(const Config& q0, const Config& q1) const {
  Turn out;
  double least = 1;
  const auto look = [&](double c2, int body, int region) {
    if (!(c2 >= -1)) c2 = -1;  // not finite
    if (c2 < least) least = c2, out.body = body, out.region = region;
  };
  for (size_t b = 0; b < bodies.size(); ++b)
    if (!bodies[b].ground) look(half_cosine2(q0.R[b], q1.R[b]), static_cast<int>(b), -1);
  for (const SolidBatch& batch : batches) {
    const ShapeInfo& shape = info(batch.shape);
    for (size_t e = 0; e < batch.cells.size(); ++e) {
      const int* nodes = batch.nodes.data() + e * static_cast<size_t>(shape.n_nodes);
      Mat3 D0 = Mat3::Zero(), D1 = Mat3::Zero();
      for (size_t k = 0; k < shape.edges.size(); ++k) {
        const int far = nodes[shape.edges[k]];
        D0.col(k) = q0.x[far] - q0.x[nodes[0]], D1.col(k) = q1.x[far] - q1.x[nodes[0]];
      }
      look(half_cosine2(D0, D1, shape.dimension), -1, batch.region);
    }
  }
  const double worst = -comm->max(-least);
  if (comm->size > 1) {
    out.body = static_cast<int>(comm->max(least == worst ? out.body : -1));
    out.region = static_cast<int>(comm->max(least == worst ? out.region : -1));
  }
  out.angle = 2 * std::acos(std::sqrt(std::clamp(worst, 0.0, 1.0)));
  return out;
}

std::string System::name(const Turn& turn) const {
  if (turn.body >= 0) return "body \"" + bodies[turn.body].name + "\"";
  return turn.region >= 0 ? "a cell of region \"" + mesh->mesh.region_name[turn.region] + "\"" : "";
}

std::string System::inside_out(const LeastDet& least) const {
  return fmt::format("a cell of region \"{}\" is {}turned inside out (det F = {:.2g})", mesh->mesh.region_name[least.region],
                     least.det > 0 ? "all but " : "", least.det);
}

}  // namespace hilo
