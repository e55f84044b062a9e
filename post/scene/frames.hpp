// SPDX-License-Identifier: GPL-3.0-or-later
// Frames of one run, or of several side by side at the same instants, camera and colours.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "post/picture/picture.hpp"
#include "post/scene/overlay.hpp"
#include "post/scene/run_view.hpp"

namespace hilo {

class Frames {
 public:
  /// Opens the runs; Error for what cannot be drawn.
  explicit Frames(const FrameOptions& o);

  RunFile& run() { return views_.front()->run(); }
  /// Times that all runs have: the latest start and the earliest end  [s].
  std::pair<double, double> common_times();
  /// Colours and camera from what is seen at these times.
  void survey(const std::vector<double>& times);
  /// Make the stage, in the process that draws.  A line under the title says `remark` after the time.
  void open(const std::string& remark = "");
  /// Files are closed before the process divides, and opened again in each.
  void close_files();
  void open_files();
  void draw(double t);
  Picture& picture() { return *picture_; }

 private:
  bool by_names() const;
  std::vector<Box> boxes() const;
  void choose_colours(const Extent& range);
  void surround(Painter& p, double t) const;
  void annotate(Painter& p, double t) const;

  FrameOptions o_;
  std::vector<std::unique_ptr<RunView>> views_;
  std::vector<std::string> captions_;
  std::string title_, difference_;  // "soft minus stiff"
  std::unique_ptr<Picture> picture_;
  Frame frame_;
  std::vector<Box> boxes_;            // one per run
  std::vector<vtkRenderer*> stages_;  // owned by the picture
  std::vector<Vec3> extremes_;
  std::unique_ptr<Fit> fit_;
  ColourBar bar_;
  std::vector<Extent> seen_;  // of each run in this frame, in the shown unit
  std::vector<double> iso_;   // levels, in the shown unit
  double largest_force_ = 0;  // [N]
  double factor_ = 1;
  std::string remark_;
};

}  // namespace hilo
