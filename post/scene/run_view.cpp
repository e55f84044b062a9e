// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/scene/run_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "model/mesh_pieces.hpp"

namespace hilo {
namespace {

/// The fields of two runs can be subtracted only node by node.
void same_mesh(const Mesh& a, const Mesh& b, const std::string& path_a, const std::string& path_b) {
  const char* hint = "--minus needs two runs on one mesh; --beside draws any two";
  if (a.n_nodes() != b.n_nodes() || a.n_cells() != b.n_cells())
    throw Error(path_b,
                fmt::format("{} nodes and {} cells, but {} has {} and {}", b.n_nodes(), b.n_cells(), path_a, a.n_nodes(), a.n_cells()),
                hint);
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const Vec3& x : a.X) low = low.cwiseMin(x), high = high.cwiseMax(x);
  const double near = 1e-9 * (high - low).norm();
  for (size_t n = 0; n < a.X.size(); ++n)
    if ((a.X[n] - b.X[n]).norm() > near) throw Error(path_b, fmt::format("node {} is elsewhere than in {}", a.node_id[n], path_a), hint);
  if (a.nodes != b.nodes || a.offset != b.offset)
    throw Error(path_b, fmt::format("its cells join other nodes than those of {}", path_a), hint);
}

RunFile opened(const std::string& path) {
  RunFile run = judged_run(path);
  run.stand_in_bodies();
  run.draw_beams();
  return run;
}

}  // namespace

RunView::RunView(const FrameOptions& o, const std::string& path)
    : o_(o), run_(opened(path)), file_(run_.mesh_file()), mesh_(file_.mesh), playback_(std::make_unique<Playback>(run_)) {
  for (const auto& [asked, option] : {std::pair{!o.cut.empty(), "--cut"}, {!o.iso.empty(), "--iso"}})
    if (asked && run_.is_skin())
      throw Error(run_.path, fmt::format("holds the skin of its regions alone: nothing to draw inside ({})", option),
                  "solve with output.nodes = \"all\"");
  shown_ = shown_regions(mesh_, o.show, o.hide);
  zoomed_ = o.zoom.empty() ? shown_ : shown_regions(mesh_, o.zoom, o.hide);
  valued_ = shown_;
  if (is_named_field(o.field)) {
    named_ = named_cells(file_, o.field, shown_, run_.path);
  } else {
    field_ = shown_field(o.field, run_.fields(run_.steps.front()));
  }
  for (size_t r = 0; r < shown_.size(); ++r)
    if ((field_.flexible_only && file_.fidelity[r] == Fidelity::rigid) || !run_.gives(r, field_.array)) valued_[r] = false;
  if (!o.minus.empty()) {
    minus_ = std::make_unique<RunFile>(opened(o.minus));
    same_mesh(mesh_, minus_->mesh(), run_.path, minus_->path);
    for (size_t r = 0; r < shown_.size(); ++r)
      if (field_.flexible_only && minus_->mesh_file().fidelity[r] == Fidelity::rigid) valued_[r] = false;
    minus_playback_ = std::make_unique<Playback>(*minus_);
    field_.from_zero = field_.component < 0 && field_.unit != "Pa";  // the size of a difference
    field_.label += ", difference";
  }
  make_skins();
  if (o.deformed != 1) run_.shapes.empty() ? find_parts() : void(rest_ = playback_->positions(run_.steps.front().t));
  const bool enlarged = o.scale != 1 || o.deformed != 1;
  if (const std::string& name = o.track.empty() ? o.ride : o.track; !name.empty()) {
    leader_ = std::make_unique<Marker>(run_, name, o.track.empty() ? "--ride" : "--track");
    if (enlarged && !leader_->of_nodes())
      throw Error("--track", fmt::format("\"{}\" has no nodes to enlarge with", name), "track a region or set", Exit::usage);
  }
  if (!o.trace.empty() || !o.forces.empty()) annotations_ = std::make_unique<Annotations>(o, run_);
}

bool RunView::has_values() const { return std::find(valued_.begin(), valued_.end(), true) != valued_.end(); }
bool RunView::has_neutral() const { return !toned_->empty(); }

void RunView::close_files() {
  run_.close();
  if (minus_) minus_->close();
}

void RunView::open_files() {
  run_.open();
  if (minus_) minus_->open();
}

void RunView::make_skins() {
  std::vector<Facet> coloured, toned;
  const std::vector<Facet> outside = boundary_facets(mesh_, shown_);
  for (const Facet& f : outside) (valued_[region_of(f.cell)] ? coloured : toned).push_back(f);
  std::vector<std::int64_t> coloured_bars, toned_bars, toned_solid;
  for (std::int64_t c = 0; c < mesh_.n_cells(); ++c) {
    if (!shown_[region_of(c)]) continue;
    const bool bar = info(mesh_.shape[static_cast<size_t>(c)]).dimension == 1, valued = valued_[region_of(c)];
    if (bar) (valued ? coloured_bars : toned_bars).push_back(c);
    if (!bar && (!o_.cut.empty() || !o_.iso.empty())) (valued ? solid_ : toned_solid).push_back(c);
  }
  Plane plane;
  if (!o_.cut.empty()) plane = parse_cut(o_.cut, parse_view(o_.camera).towards);
  const Plane* cut = o_.cut.empty() ? nullptr : &plane;
  coloured_ = std::make_unique<Skin>(mesh_, coloured, coloured_bars, cut, solid_);
  toned_ = std::make_unique<Skin>(mesh_, toned, toned_bars, cut, toned_solid);
  if (coloured_->empty() && toned_->empty()) throw Error("--cut", "removes all that is shown", "see the box that hilo-show prints");
  counted_.assign(static_cast<size_t>(mesh_.n_nodes()), false);
  for (std::int64_t c = 0; c < mesh_.n_cells(); ++c)
    if (valued_[region_of(c)])
      for (const std::int64_t n : mesh_.cell(c)) counted_[static_cast<size_t>(n)] = run_.holds(n) && (!minus_ || minus_->holds(n));
  find_framed(outside);
  if (!is_named_field(o_.field)) return;
  std::vector<std::array<std::uint8_t, 3>> colour(static_cast<size_t>(mesh_.n_cells()));
  for (size_t c = 0; c < colour.size(); ++c) colour[c] = bytes(named_.colours[static_cast<size_t>(named_.name_of[c])]);
  coloured_->set_cell_colours(colour);
}

void RunView::find_framed(const std::vector<Facet>& outside) {
  std::vector<bool> in(static_cast<size_t>(mesh_.n_nodes()), false);
  const auto take = [&](std::int64_t n) {
    if (!in[static_cast<size_t>(n)]) in[static_cast<size_t>(n)] = true, framed_.push_back(n);
  };
  for (const Facet& f : outside)
    if (zoomed_[region_of(f.cell)])
      for (const int a : info(mesh_.shape[static_cast<size_t>(f.cell)]).facets[static_cast<size_t>(f.facet)])
        take(mesh_.cell(f.cell)[static_cast<size_t>(a)]);
  const bool none = framed_.empty();
  for (std::int64_t c = 0; c < mesh_.n_cells(); ++c)  // bars, and a region that lies within others
    if (zoomed_[region_of(c)] && (info(mesh_.shape[static_cast<size_t>(c)]).dimension == 1 || none))
      for (const std::int64_t n : mesh_.cell(c)) take(n);
}

void RunView::find_parts() {
  const std::vector<std::int64_t> piece = pieces_of(mesh_);
  std::vector<int> number(piece.size(), -1);
  int count = 0;
  for (const auto p : piece) {
    int& k = number[static_cast<size_t>(p)];
    if (k < 0) k = count++;
    part_.push_back(k);
  }
}

void RunView::enlarge(std::vector<Vec3>& x) const {
  if (!rest_.empty()) {  // motion and deformation of the parts of a shape belong together
    for (size_t n = 0; n < x.size(); ++n) x[n] = rest_[n] + o_.deformed * (x[n] - rest_[n]);
    return;
  }
  std::vector<std::vector<std::int64_t>> nodes;
  for (size_t n = 0; n < x.size(); ++n) {
    const auto k = static_cast<size_t>(part_[n]);
    if (k >= nodes.size()) nodes.resize(k + 1);
    nodes[k].push_back(static_cast<std::int64_t>(n));
  }
  std::vector<Vec3> before, now;
  for (const auto& part : nodes) {
    before.clear(), now.clear();
    for (const auto n : part)
      if (run_.holds(n)) before.push_back(mesh_.X[static_cast<size_t>(n)]), now.push_back(x[static_cast<size_t>(n)]);
    if (before.empty()) continue;
    const Pose rigid = best_pose(before, now);
    for (const auto n : part) {
      const Vec3 y = rigid(mesh_.X[static_cast<size_t>(n)]);
      x[static_cast<size_t>(n)] = y + o_.deformed * (x[static_cast<size_t>(n)] - y);
    }
  }
}

std::vector<Vec3> RunView::positions(double t) {
  std::vector<Vec3> x = playback_->positions(t);
  if (o_.scale != 1)
    for (size_t n = 0; n < x.size(); ++n) x[n] = mesh_.X[n] + o_.scale * (x[n] - mesh_.X[n]);
  if (o_.deformed != 1) enlarge(x);
  if (!leader_) return x;
  drawn_ = leader_->pose(t, x);
  if (!o_.track.empty()) drawn_.R = Mat3::Identity();
  for (Vec3& p : x) p = drawn_.back(p);
  return x;
}

std::vector<double> RunView::values(double t) {
  RunFile::Field raw = playback_->field(t, field_.array);
  if (minus_) {
    const RunFile::Field other = minus_playback_->field(t, field_.array);
    for (size_t i = 0; i < raw.value.size(); ++i) raw.value[i] -= other.value[i];
  }
  return reduced(std::move(raw), field_, run_.path);
}

Extent RunView::bounds(const std::vector<double>& value) const {
  Extent e;
  for (size_t n = 0; n < value.size(); ++n)
    if (counted_[n]) e.add(value[n]);
  return e;
}

Extent RunView::survey(double t, const Fit& axes, std::vector<Vec3>& extremes) {
  // Nodes extreme in many directions stand for all of them: enough to frame the picture, whatever the number of instants.
  const auto x = positions(t);
  constexpr size_t n = 32;
  std::array<double, 3 * n> best;
  std::array<const Vec3*, 3 * n> who{};
  best.fill(-std::numeric_limits<double>::infinity());
  std::array<Vec3, 3 * n> direction;
  for (size_t k = 0; k < n; ++k) {
    const double a = 2 * M_PI * static_cast<double>(k) / n;
    for (size_t tilt = 0; tilt < 3; ++tilt)
      direction[3 * k + tilt] = std::cos(a) * axes.right() + std::sin(a) * axes.up() + 0.2 * (static_cast<double>(tilt) - 1) * axes.back();
  }
  for (const std::int64_t framed : framed_) {
    const auto node = static_cast<size_t>(framed);
    for (size_t k = 0; k < direction.size(); ++k)
      if (const double d = direction[k].dot(x[node]); d > best[k]) best[k] = d, who[k] = &x[node];
  }
  for (const Vec3* w : who)
    if (w) extremes.push_back(*w);
  if (annotations_ && o_.zoom.empty()) annotations_->frame(t, *playback_, drawn_, extremes);
  return is_named_field(o_.field) || !has_values() ? Extent() : bounds(values(t));
}

void RunView::stage(vtkRenderer* stage, const Look& look, double scale, double height, const std::vector<double>& iso_levels) {
  Look own = look;
  const bool glass = !iso_levels.empty();
  if (glass) {
    iso_ = std::make_unique<IsoSurface>(mesh_, solid_, iso_levels);
    add_values(stage, iso_->surface(), look);
    own.by = Look::By::colour, own.opacity = 0.2;
  }
  if (!coloured_->empty()) add_skin(stage, *coloured_, own);
  own.by = Look::By::colour;
  if (!toned_->empty()) add_skin(stage, *toned_, own);
  for (const Skin* skin : {coloured_.get(), toned_.get()}) {
    if (o_.edges == "all") add_grid(stage, *skin, scale, 0.35, pixels_per_metre(stage, height));
    if (o_.edges != "none" && run_.has_mesh()) add_lines(stage, skin->feature_edges(), {0.1, 0.1, 0.12}, 1.3 * scale, glass ? 0.35 : 0.8);
  }
}

Extent RunView::show(double t, double factor) {
  const auto x = positions(t);
  coloured_->move(x);
  toned_->move(x);
  if (is_named_field(o_.field) || !has_values()) return {};
  auto value = values(t);
  for (double& v : value) v *= factor;
  coloured_->set_values(value);
  if (iso_) iso_->update(value, x);
  return bounds(value);
}

}  // namespace hilo
