// SPDX-License-Identifier: GPL-3.0-or-later
// Progress on stderr: one line that rewrites itself on a terminal, key=value lines otherwise.
#pragma once
#include <string>

namespace hilo {

class Progress {
 public:
  Progress(bool quiet, double start, double end);
  /// At most ten times a second on a terminal, every ten seconds otherwise.
  void show(double t, long step, int iterations, bool force = false);
  void done();

 private:
  bool quiet_, terminal_;
  double start_, end_, began_, last_;
  bool open_ = false;
};

}  // namespace hilo
