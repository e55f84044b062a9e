// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/scene/frames.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vtkCamera.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "base/error.hpp"
#include "post/charts/ticks.hpp"
#include "post/run/run_beams.hpp"

namespace hilo {
namespace {

constexpr double caption_height = 30;  // above each of several runs  [unit of text]

std::vector<double> parse_levels(const std::string& text) {
  std::vector<double> levels;
  std::stringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) {
    double x = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), x);
    if (error != std::errc() || end != part.data() + part.size())
      throw Error("--iso", fmt::format("\"{}\" is no number", part), "write values in the shown unit, such as 50,100", Exit::usage);
    levels.push_back(x);
  }
  return levels;
}

/// n boxes in a row or in a column.
std::vector<Box> divided(const Box& whole, size_t n, bool row, double gap, double caption) {
  std::vector<Box> boxes;
  const auto k = static_cast<double>(n);
  for (size_t i = 0; i < n; ++i) {
    const auto at = static_cast<double>(i);
    Box b = whole;
    if (row) {
      b.w = (whole.w - (k - 1) * gap) / k;
      b.x = whole.x + at * (b.w + gap);
    } else {
      b.h = (whole.h - (k - 1) * gap) / k;
      b.y = whole.y + (k - 1 - at) * (b.h + gap);  // the first on top
    }
    b.h -= caption;
    boxes.push_back({std::round(b.x), std::round(b.y), std::round(b.w), std::round(b.h)});
  }
  return boxes;
}

}  // namespace

Frames::Frames(const FrameOptions& o) : o_(o) {
  const RunFile first(o.run);
  const auto shows_stress = [](const RunBeam& b) { return b.shows_stress(); };
  if (o_.field == "von_mises" && !first.has_mesh() && std::none_of(first.beams().begin(), first.beams().end(), shows_stress)) {
    warn(o.run, "bodies without a mesh have no stress: drawn by their names");
    o_.field = "region";
  }
  check(o_);
  std::vector<std::string> paths{o.run};
  paths.insert(paths.end(), o.beside.begin(), o.beside.end());
  for (const auto& path : paths) views_.push_back(std::make_unique<RunView>(o_, path));
  title_ = views_.front()->run().title;
  captions_ = distinct_names(paths);
  std::copy(o.label.begin(), o.label.end(), captions_.begin());
  if (!o.minus.empty()) {
    const auto names = distinct_names({o.run, o.minus});
    difference_ = names[0] + " minus " + names[1];
  }
  if (!by_names() && std::none_of(views_.begin(), views_.end(), [](const auto& v) { return v->has_values(); }))
    throw o_.field == "axial_stress"
        ? Error(o.run, "nothing that is shown has axial stress",
                "it is of beams whose section has a kind with a shape; try --field von_mises")
        : Error(o.run, fmt::format("all regions shown are rigid: they have no {}", views_.front()->field().label),
                "try --field acceleration");
}

bool Frames::by_names() const { return is_named_field(o_.field); }

std::pair<double, double> Frames::common_times() {
  double from = -std::numeric_limits<double>::infinity(), to = -from;
  for (const auto& v : views_) from = std::max(from, v->playback().first()), to = std::min(to, v->playback().last());
  if (from > to) throw Error(o_.run, "the runs have no time in common", "see hilo-show for their outputs");
  return {from, to};
}

void Frames::survey(const std::vector<double>& times) {
  const Fit axes(parse_view(o_.camera), 1);
  Extent range;
  extremes_.clear();
  for (const auto& v : views_)
    for (const double t : times) range.add(v->survey(t, axes, extremes_));
  for (const auto& v : views_) {
    if (v->annotations()) largest_force_ = std::max(largest_force_, v->annotations()->largest_force(times));
  }
  if (!by_names()) choose_colours(range);
}

void Frames::choose_colours(const Extent& range) {
  const ShownField& field = views_.front()->field();
  const double largest = std::max(std::abs(range.low), std::abs(range.high));
  const ShownUnit unit = o_.unit.empty() ? handy_unit(field.unit, largest) : wanted_unit(field.unit, o_.unit);
  factor_ = unit.factor;
  bar_.quantity = field.label;
  bar_.unit = unit.name;
  const bool both_signs = !field.from_zero && (range.low < 0 && range.high > 0);
  bar_.map = o_.colours == "viridis"                                                            ? ColourMap::viridis
             : o_.colours == "cividis"                                                          ? ColourMap::cividis
             : o_.colours == "diverging" || both_signs || (o_.minus.size() && !field.from_zero) ? ColourMap::diverging
                                                                                                : ColourMap::viridis;
  bar_.low = field.from_zero ? 0 : range.low * factor_;
  bar_.high = range.high * factor_;
  if (bar_.map == ColourMap::diverging) bar_.high = largest * factor_, bar_.low = -bar_.high;  // white is zero
  if (!o_.range.empty()) std::tie(bar_.low, bar_.high) = parse_range(o_.range);
  if (!(bar_.high > bar_.low)) {
    const double room = bar_.low == 0 ? 1 : std::abs(bar_.low);
    if (bar_.map == ColourMap::diverging) bar_.low -= room;
    bar_.high += room;
  }
  for (const auto& v : views_)
    if (v->has_neutral()) bar_.neutral = v->run().beams().empty() ? "rigid" : "no value";
  if (o_.iso.empty()) return;
  iso_ = parse_levels(o_.iso);
  bar_.marks = iso_;
  if (std::none_of(iso_.begin(), iso_.end(), [&](double v) { return v >= range.low * factor_ && v <= range.high * factor_; }))
    throw Error("--iso", "no value is reached",
                fmt::format("there are {:.4g} to {:.4g} {}", range.low * factor_, range.high * factor_, unit.name));
}

std::vector<Box> Frames::boxes() const {
  if (views_.size() == 1) return {frame_.model};
  // In a row or in a column, whichever shows the runs larger.
  const double s = picture_scale(picture_->width, picture_->height);
  std::vector<Box> best;
  double largest = 0;
  for (const bool row : {true, false}) {
    Box whole = frame_.model;
    if (!row) whole.y += 60 * s, whole.h -= 60 * s;  // room for the cross of axes
    const auto boxes = divided(whole, views_.size(), row, 14 * s, caption_height * s);
    Fit fit(parse_view(o_.camera), boxes.front().w / boxes.front().h);
    for (const Vec3& x : extremes_) fit.add(x);
    const auto stage = vtkSmartPointer<vtkRenderer>::New();
    fit.aim(stage->GetActiveCamera());
    if (const double scale = pixels_per_metre(stage, boxes.front().h); scale > largest) largest = scale, best = boxes;
  }
  return best;
}

void Frames::close_files() {
  for (const auto& v : views_) v->close_files();
}

void Frames::open_files() {
  for (const auto& v : views_) v->open_files();
}

void Frames::open(const std::string& remark) {
  remark_ = remark;
  const auto [width, height] = parse_size(o_.size);
  frame_ = frame_of(width, height, by_names() ? 230 : 158, true);
  picture_ = std::make_unique<Picture>(width, height);
  boxes_ = boxes();
  fit_ = std::make_unique<Fit>(parse_view(o_.camera), boxes_.front().w / boxes_.front().h);
  for (const Vec3& x : extremes_) fit_->add(x);
  const double s = picture_scale(width, height);
  Look look;
  look.bar_width = 5 * s;
  look.map = bar_.map;
  look.by = by_names() ? Look::By::cells : Look::By::values;
  look.low = bar_.low, look.high = bar_.high;
  stages_.clear();
  for (size_t i = 0; i < views_.size(); ++i) {
    stages_.push_back(picture_->layer(boxes_[i]));
    light(stages_[i]);
    fit_->aim(stages_[i]->GetActiveCamera());
    views_[i]->stage(stages_[i], look, s, boxes_[i].h, iso_);
  }
}

void Frames::draw(double t) {
  seen_.clear();
  for (size_t i = 0; i < views_.size(); ++i) {
    seen_.push_back(views_[i]->show(t, factor_));
    stages_[i]->ResetCameraClippingRange();
  }
  picture_->paint([this, t](Painter& p) { surround(p, t); });
}

void Frames::surround(Painter& p, double t) const {
  const RunView& first = *views_.front();
  std::string line = by_names() ? first.named().title : first.field().label;
  line[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(line[0])));
  if (first.field().label.starts_with("von")) line[0] = 'v';
  if (!o_.minus.empty()) line += fmt::format(": {}", difference_);
  line += ", " + first.playback().caption(t);
  if (o_.scale != 1) line += fmt::format(", displacements \u00d7 {:g}", o_.scale);
  if (o_.deformed != 1) line += fmt::format(", deformation \u00d7 {:g}", o_.deformed);
  if (!iso_.empty()) line += fmt::format(", surfaces of {} {}", fmt::join(iso_, ", "), bar_.unit);
  draw_title(p, o_.title.empty() ? title_ : o_.title, line + remark_);
  const Mat3& R = first.drawn().R;  // a camera that rides along sees the axes turn
  draw_axes_cross(p, R * fit_->right(), R * fit_->up(), R * fit_->back());
  annotate(p, t);
  for (size_t i = 0; i < views_.size() && views_.size() > 1; ++i) {
    const Box& b = boxes_[i];
    const double y = b.y + b.h + 0.5 * caption_height * p.scale;
    p.text({b.x + 8 * p.scale, y}, captions_[i], 16, Across::left, Up::middle, ink, true);
    if (by_names() || seen_[i].empty()) continue;
    const double after = p.extent(captions_[i] + "   ", 16, true).x();
    const Extent& e = seen_[i];
    const std::string told = bar_.low < 0 ? fmt::format("{} to {} {}", short_number(e.low), short_number(e.high), bar_.unit)
                                          : fmt::format("max {} {}", short_number(e.high), bar_.unit);
    p.text({b.x + 8 * p.scale + after, y}, told, 16, Across::left, Up::middle, {0.33, 0.34, 0.36});
  }
  if (!by_names()) {
    ColourBar bar = bar_;
    Extent all;
    for (const Extent& e : seen_) all.add(e);
    bar.least = all.low, bar.most = all.high;
    return draw_colour_bar(p, frame_.side, bar);
  }
  std::vector<LegendEntry> entries;
  const NamedCells& named = first.named();
  for (size_t i = 0; i < named.names.size(); ++i) entries.push_back({named.names[i], named.colours[i], nullptr});
  draw_legend(p, frame_.side, named.title, entries);
}

void Frames::annotate(Painter& p, double t) const {
  const double tenth = 0.1 * p.height, most = largest_force_;
  double newtons = o_.force_scale > 0 ? o_.force_scale : most > 0 ? most / 2 : 1;  // of an arrow of `tenth`
  for (size_t i = 0; i < views_.size(); ++i) {
    Annotations* notes = views_[i]->annotations();
    if (!notes) continue;
    const double metres = tenth / pixels_per_metre(stages_[i], boxes_[i].h) / newtons;
    p.clip(boxes_[i]);
    notes->draw(p, Projection(stages_[i], boxes_[i]), boxes_[i], t, views_[i]->playback(), views_[i]->drawn(), metres);
    p.unclip();
  }
  if (!(most > 0)) return;
  const double shown = round_below(newtons * 1.5), length = tenth * shown / newtons;  // the scale of the arrows
  const Vec2 from(150 * p.scale, 34 * p.scale), to = from + Vec2(length, 0);
  draw_arrow(p, from, to, ink, 3.4);
  p.text(to + Vec2(10 * p.scale, 0), force_text(shown) + ", force on b", 15);
}

}  // namespace hilo
