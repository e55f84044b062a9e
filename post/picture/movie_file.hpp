// SPDX-License-Identifier: GPL-3.0-or-later
// An H.264 movie in MP4 (4:2:0, BT.709, even sizes: what every player shows), made in memory so that no half of it is ever on disk.
#pragma once
#include <cstddef>
#include <memory>
#include <string>

namespace hilo {

class MovieFile {
 public:
  /// `frames` is the number to come: the table of contents is written in front of them, as a browser wants it.  Error (exit 4) where the
  /// machine has no H.264 encoder.
  MovieFile(int width, int height, double fps, size_t frames, int threads);
  ~MovieFile();
  MovieFile(const MovieFile&) = delete;
  /// Rows of red, green, blue from the top.
  void add(const std::string& pixels);
  /// The bytes of the file.
  std::string finish();

 private:
  struct Encoder;
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace hilo
