// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces of triangles (.stl, text and binary): refused by what they are, since nothing says what is inside.
#include <cstring>

#include "base/error.hpp"
#include "import/data_line.hpp"
#include "import/imported.hpp"

namespace hilo {

Imported read_stl(const std::string& path, const ImportOptions&) {
  const std::string text = read_gz(path, "");
  std::uint32_t n = 0;
  if (text.size() >= 84) std::memcpy(&n, text.data() + 80, sizeof n);  // binary: 80 bytes of anything, the count, 50 bytes each
  std::int64_t triangles = text.size() == 84 + 50 * static_cast<size_t>(n) ? n : 0;
  if (!triangles)
    for (size_t at = 0; (at = text.find("endfacet", at)) != text.npos; ++at) ++triangles;
  if (!triangles) throw Error(path, "no triangles: is it an STL file?");
  refuse_flat(path, triangles, 0);
  return {};
}

}  // namespace hilo
