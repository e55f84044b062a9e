// SPDX-License-Identifier: GPL-3.0-or-later
// One run as it is drawn: what is shown of it, its skins on a stage, moved from instant to instant.
#pragma once
#include <vtkRenderer.h>

#include <memory>
#include <string>
#include <vector>

#include "post/run/marker.hpp"
#include "post/run/playback.hpp"
#include "post/scene/annotations.hpp"
#include "post/scene/frame_options.hpp"
#include "post/scene/shown_field.hpp"
#include "post/scene/stage.hpp"
#include "post/scene/view.hpp"
#include "post/surface/cut.hpp"
#include "post/surface/iso_surface.hpp"
#include "post/surface/skin.hpp"

namespace hilo {

/// Least and largest of values; empty until the first is added.
struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double x) { low = std::min(low, x), high = std::max(high, x); }
  void add(const Extent& e) { low = std::min(low, e.low), high = std::max(high, e.high); }
  bool empty() const { return !(high >= low); }
};

class RunView {
 public:
  RunView(const FrameOptions& o, const std::string& path);

  RunFile& run() { return run_; }
  Playback& playback() { return *playback_; }
  const Playback& playback() const { return *playback_; }
  const MeshFile& file() const { return file_; }
  const std::vector<bool>& shown() const { return shown_; }
  const ShownField& field() const { return field_; }
  const NamedCells& named() const { return named_; }
  bool has_values() const;   // of the field: false where all that is shown is rigid and the field is a stress
  bool has_neutral() const;  // something shown has no value
  void close_files();
  void open_files();

  Annotations* annotations() { return annotations_.get(); }
  /// True positions are taken to drawn ones by the inverse of this: what the camera moves with.
  const Pose& drawn() const { return drawn_; }

  /// Range of the values drawn at a time, in the stored unit, and the nodes that frame the picture.
  Extent survey(double t, const Fit& axes, std::vector<Vec3>& extremes);
  void stage(vtkRenderer* stage, const Look& look, double scale, double height, const std::vector<double>& iso_levels);
  /// Move to a time; values times `factor` are shown.  The range of what is drawn, in the shown unit.
  Extent show(double t, double factor);

 private:
  void make_skins();
  void find_framed(const std::vector<Facet>& outside);
  void find_parts();
  void enlarge(std::vector<Vec3>& x) const;
  size_t region_of(std::int64_t cell) const { return static_cast<size_t>(mesh_.region[static_cast<size_t>(cell)]); }
  std::vector<Vec3> positions(double t);
  std::vector<double> values(double t);
  Extent bounds(const std::vector<double>& value) const;

  const FrameOptions& o_;
  RunFile run_;
  std::unique_ptr<RunFile> minus_;
  const MeshFile& file_;
  const Mesh& mesh_;
  std::unique_ptr<Playback> playback_, minus_playback_;
  std::vector<bool> shown_, zoomed_, valued_;  // per region
  std::vector<bool> counted_;                  // per node: in the range of the colours
  std::vector<std::int64_t> framed_;           // nodes that the picture must hold
  std::unique_ptr<Skin> coloured_, toned_;
  std::unique_ptr<IsoSurface> iso_;
  std::vector<std::int64_t> solid_;  // cells that have values and a volume
  std::unique_ptr<Annotations> annotations_;
  std::unique_ptr<Marker> leader_;  // of the camera
  std::vector<int> part_;           // connected part of each node, where deformations are enlarged
  std::vector<Vec3> rest_;          // of an analysis of modes: there the whole shape is
  Pose drawn_;
  ShownField field_;
  NamedCells named_;
};

}  // namespace hilo
