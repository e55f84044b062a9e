// SPDX-License-Identifier: GPL-3.0-or-later
// The gmsh library, kept quiet.
#pragma once
#include <array>
#include <string>

#include "import/imported.hpp"

namespace hilo {

/// gmsh as long as this lives.  OpenCASCADE writes to stdout, which is data: what it says there is kept apart.
class GmshSession {
 public:
  explicit GmshSession(const ImportOptions& options);
  ~GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;
  /// The first six lines that gmsh marked as errors, once each, and how many more; "" without one.
  static std::string errors();
  /// What was written to stdout so far.
  std::string printed();

 private:
  int stdout_;
  std::array<int, 2> said_{-1, -1};  // a pipe
  std::string printed_;
};

}  // namespace hilo
