// SPDX-License-Identifier: GPL-3.0-or-later
// What a frame of a run shows and how: the options that render and movie share.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace hilo {

struct FrameOptions {
  std::string run, field = "von_mises", camera = "iso", range, size = "1280x720", edges = "feature", unit, title, colours = "auto", minus,
                   cut, iso, track, ride;
  std::vector<std::string> beside, label, show, hide, zoom, trace, forces;
  double scale = 1, deformed = 1, force_scale = 0;
};
void add_frame_options(CLI::App& sub, FrameOptions& o);
/// Error (exit 1) for options that contradict each other.
void check(const FrameOptions& o);

/// "low,high" with low < high; Error (exit 1) otherwise.
std::pair<double, double> parse_range(const std::string& text);
/// Short names that tell paths apart: the file's stem, or the folders where stems are alike.
std::vector<std::string> distinct_names(const std::vector<std::string>& paths);

}  // namespace hilo
