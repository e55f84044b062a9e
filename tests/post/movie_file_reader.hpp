// SPDX-License-Identifier: GPL-3.0-or-later
// Reads back what hilo-post movie wrote: the header by the boxes of [iso-14496-12], the pictures by libavcodec.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace hilo::test {

/// What the boxes of an MP4 say.
struct MovieHeader {
  std::vector<std::string> top;  // names of the boxes of the file, in order
  std::string codec;             // "avc1"
  double duration = 0;           // [s]
  int width = 0, height = 0;
  std::uint32_t frames = 0;
};
MovieHeader movie_header(const std::string& bytes);

/// A decoded picture, rows of red, green, blue from the top.
struct DecodedFrame {
  int width = 0, height = 0;
  double t = 0;  // [s] of the movie
  std::string rgb;
  std::array<int, 3> at(int x, int y) const {
    const auto* p = reinterpret_cast<const unsigned char*>(rgb.data()) +
                    3 * (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x));
    return {p[0], p[1], p[2]};
  }
};
std::vector<DecodedFrame> decoded(const std::string& path);

}  // namespace hilo::test
