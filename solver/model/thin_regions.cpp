// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/thin_regions.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "model/mesh_source.hpp"

namespace hilo {

Mat3 ThinRegion::second() const {
  const auto& t = moments;
  Mat3 S;
  S << t[4], t[9], t[8], t[9], t[5], t[7], t[8], t[7], t[6];
  return S;
}

std::vector<ThinRegion> read_thin_regions(const std::string& path) {
  const Store given = Store::open(path);
  const std::string target = holder(given, "mesh");
  const Store mesh = Store::open(target);
  if (!mesh.has("/mesh/regions/thin")) return {};
  const auto thin = mesh.read<double>("/mesh/regions/thin"), thickness = mesh.read<double>("/mesh/regions/thickness"),
             area = mesh.read<double>("/mesh/regions/area");
  const size_t n = mesh.read_strings("/mesh/regions/name").size();
  if (thin.size() != 10 * n || thickness.size() != n || area.size() != n)
    throw Error(target, fmt::format("damaged: /mesh/regions/thin has {} entries for {} regions", thin.size(), n));
  std::vector<ThinRegion> regions(n);
  for (size_t r = 0; r < n; ++r) {
    regions[r].thickness = thickness[r], regions[r].area = area[r];
    for (size_t k = 0; k < 10; ++k) regions[r].moments[k] = thin[10 * r + k];
  }
  return regions;
}

void write_thin_regions(Store& mesh, const std::vector<ThinRegion>& regions) {
  std::vector<double> thin, thickness, area;
  for (const ThinRegion& r : regions) {
    thin.insert(thin.end(), r.moments.begin(), r.moments.end());
    thickness.push_back(r.thickness), area.push_back(r.area);
  }
  const auto n = static_cast<std::int64_t>(regions.size());
  mesh.write<double>("/mesh/regions/thin", thin, {n, 10});
  mesh.write<double>("/mesh/regions/thickness", thickness, {n});
  mesh.write<double>("/mesh/regions/area", area, {n});
}

}  // namespace hilo
