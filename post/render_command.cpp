// hilo-post render: frames of a run, coloured by a field or by names.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vtkCamera.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/args.hpp"
#include "base/error.hpp"
#include "post/commands.hpp"
#include "post/overlay.hpp"
#include "post/picture.hpp"
#include "post/shown_field.hpp"
#include "post/skin.hpp"
#include "post/stage.hpp"
#include "post/ticks.hpp"
#include "post/view.hpp"

namespace hilo {
namespace {

struct Options {
  std::string run, output, field = "von_mises", steps = "last", times, camera = "iso", range, size = "1280x720", edges = "feature", unit,
                           title, colours = "viridis";
  std::vector<std::string> show, hide, zoom;
  double scale = 1;
};

std::pair<double, double> parse_range(const std::string& text) {
  double low = 0, high = 0;
  char comma = 0, rest = 0;
  if (std::sscanf(text.c_str(), "%lf%c%lf%c", &low, &comma, &high, &rest) != 3 || comma != ',' || !(low < high))
    throw Error("--range", fmt::format("\"{}\" is no range", text), "write LOW,HIGH in the shown unit, such as 0,250", Exit::usage);
  return {low, high};
}

/// All that is needed to draw one run: read once, moved frame by frame.
class Renderer {
 public:
  explicit Renderer(const Options& o) : o_(o), run_(o.run), file_(run_.mesh_file()), mesh_(file_.mesh) {
    steps_ = run_.select_steps(o.steps, o.times);
    shown_ = shown_regions(mesh_, o.show, o.hide);
    zoomed_ = o.zoom.empty() ? shown_ : shown_regions(mesh_, o.zoom, o.hide);
    valued_ = shown_;
    if (is_named_field(o.field))
      named_ = named_cells(file_, o.field, shown_, run_.path);
    else
      field_ = shown_field(o.field, run_.fields(steps_.front()));
    for (size_t r = 0; r < shown_.size(); ++r)
      if (field_.flexible_only && file_.fidelity[r] == Fidelity::rigid) valued_[r] = false;
    if (std::none_of(valued_.begin(), valued_.end(), [](bool b) { return b; }))
      throw Error(run_.path, fmt::format("all regions shown are rigid: they have no {}", field_.label), "try --field acceleration");
    make_skins();
    survey();
  }

  void write_frames() {
    const auto [width, height] = parse_size(o_.size);
    const bool by_names = is_named_field(o_.field);
    const Frame frame = frame_of(width, height, by_names ? 230 : 158, true);
    Picture picture(width, height);
    vtkRenderer* stage = picture.layer(frame.model);
    light(stage);
    Fit fit(parse_view(o_.camera), frame.model.w / frame.model.h);
    for (const Vec3& x : extremes_) fit.add(x);
    fit.aim(stage->GetActiveCamera());
    const double s = picture_scale(width, height);
    Look look;
    look.bar_width = 5 * s;
    look.map = o_.colours == "cividis" ? ColourMap::cividis : ColourMap::viridis;
    look.by = by_names ? Look::By::cells : Look::By::values;
    look.low = bar_.low, look.high = bar_.high;
    add_skin(stage, *coloured_, look);
    if (!toned_->empty()) {
      look.by = Look::By::colour;
      add_skin(stage, *toned_, look);
    }
    for (const Skin* skin : {coloured_.get(), toned_.get()}) {
      if (o_.edges == "all") add_grid(stage, *skin, s, 0.35, pixels_per_metre(stage, frame.model.h));
      if (o_.edges != "none") add_lines(stage, skin->feature_edges(), {0.1, 0.1, 0.12}, 1.3 * s, 0.8);
    }
    for (const Step& step : steps_) {
      update(step);
      stage->ResetCameraClippingRange();
      picture.paint([&](Painter& p) { surround(p, frame, fit, step); });
      const std::string path = frame_path(step);
      picture.write(path);
      fmt::print("{}\n", path);
    }
  }

 private:
  void make_skins() {
    std::vector<Facet> coloured, toned;
    for (const Facet& f : boundary_facets(mesh_, shown_)) (valued_[region_of(f.cell)] ? coloured : toned).push_back(f);
    std::vector<std::int64_t> coloured_bars, toned_bars;
    for (std::int64_t c = 0; c < mesh_.n_cells(); ++c)
      if (info(mesh_.shape[static_cast<size_t>(c)]).dimension == 1 && shown_[region_of(c)])
        (valued_[region_of(c)] ? coloured_bars : toned_bars).push_back(c);
    coloured_ = std::make_unique<Skin>(mesh_, coloured, coloured_bars);
    toned_ = std::make_unique<Skin>(mesh_, toned, toned_bars);
    counted_.assign(static_cast<size_t>(mesh_.n_nodes()), false);
    framed_ = counted_;
    for (std::int64_t c = 0; c < mesh_.n_cells(); ++c)
      for (const std::int64_t n : mesh_.cell(c)) {
        if (valued_[region_of(c)]) counted_[static_cast<size_t>(n)] = true;
        if (zoomed_[region_of(c)]) framed_[static_cast<size_t>(n)] = true;
      }
    if (!is_named_field(o_.field)) return;
    std::vector<std::array<std::uint8_t, 3>> colour(static_cast<size_t>(mesh_.n_cells()));
    for (size_t c = 0; c < colour.size(); ++c) colour[c] = bytes(named_.colours[static_cast<size_t>(named_.name_of[c])]);
    coloured_->set_cell_colours(colour);
  }

  size_t region_of(std::int64_t cell) const { return static_cast<size_t>(mesh_.region[static_cast<size_t>(cell)]); }

  std::vector<Vec3> positions(const Step& step) const {
    std::vector<Vec3> x = mesh_.X;
    if (!run_.store().has("/field/" + step.key + "/displacement")) return x;
    const auto u = run_.field(step, "displacement").value;
    if (u.size() != 3 * x.size())
      throw Error(run_.path, fmt::format("displacements of step {} are not those of the mesh", step.key),
                  "the mesh was changed after the run");
    for (size_t n = 0; n < x.size(); ++n) x[n] += o_.scale * Vec3(u[3 * n], u[3 * n + 1], u[3 * n + 2]);
    return x;
  }

  std::pair<double, double> bounds(const std::vector<double>& value) const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (size_t n = 0; n < value.size(); ++n)
      if (counted_[n]) low = std::min(low, value[n]), high = std::max(high, value[n]);
    return {low, high};
  }

  /// One pass over the steps: the range of the colours and what the camera must see.
  void survey() {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Step& step : steps_) {
      const auto x = positions(step);
      keep_extremes(x);
      if (is_named_field(o_.field)) continue;
      const auto [least, most] = bounds(nodal_values(run_, step, field_, mesh_.n_nodes()));
      low = std::min(low, least), high = std::max(high, most);
    }
    if (is_named_field(o_.field)) return;
    const ShownUnit unit =
        o_.unit.empty() ? handy_unit(field_.unit, std::max(std::abs(low), std::abs(high))) : wanted_unit(field_.unit, o_.unit);
    factor_ = unit.factor;
    bar_.quantity = field_.label;
    bar_.unit = unit.name;
    bar_.map = o_.colours == "cividis" ? ColourMap::cividis : ColourMap::viridis;
    bar_.low = field_.from_zero ? 0 : low * factor_;
    bar_.high = high * factor_;
    if (!o_.range.empty()) std::tie(bar_.low, bar_.high) = parse_range(o_.range);
    if (!(bar_.high > bar_.low)) bar_.high = bar_.low + (bar_.low == 0 ? 1 : std::abs(bar_.low));
    if (!toned_->empty()) bar_.neutral = "rigid";
  }

  /// Nodes extreme in many directions stand for all of them: enough to frame the picture, whatever the number of steps.
  void keep_extremes(const std::vector<Vec3>& x) {
    const Fit axes(parse_view(o_.camera), 1);
    constexpr int n = 48;
    std::array<double, 3 * n> best;
    std::array<const Vec3*, 3 * n> who{};
    best.fill(-std::numeric_limits<double>::infinity());
    std::array<Vec3, 3 * n> direction;
    for (int k = 0; k < n; ++k) {
      const double a = 2 * M_PI * k / n;
      for (int tilt = -1; tilt <= 1; ++tilt)
        direction[static_cast<size_t>(3 * k + tilt + 1)] = std::cos(a) * axes.right() + std::sin(a) * axes.up() + 0.2 * tilt * axes.back();
    }
    for (size_t node = 0; node < x.size(); ++node) {
      if (!framed_[node]) continue;
      for (size_t k = 0; k < direction.size(); ++k)
        if (const double d = direction[k].dot(x[node]); d > best[k]) best[k] = d, who[k] = &x[node];
    }
    for (const Vec3* w : who)
      if (w) extremes_.push_back(*w);
  }

  void update(const Step& step) {
    const auto x = positions(step);
    coloured_->move(x);
    toned_->move(x);
    if (is_named_field(o_.field)) return;
    auto value = nodal_values(run_, step, field_, mesh_.n_nodes());
    for (double& v : value) v *= factor_;
    std::tie(bar_.least, bar_.most) = bounds(value);
    coloured_->set_values(value);
  }

  void surround(Painter& p, const Frame& frame, const Fit& fit, const Step& step) const {
    std::string line = is_named_field(o_.field) ? named_.title : field_.label;
    line[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(line[0])));
    if (field_.label.starts_with("von")) line[0] = 'v';
    const double end = run_.steps.back().t;
    line += end < 1 ? fmt::format(", t = {:.3f} ms", 1e3 * step.t) : fmt::format(", t = {:.4f} s", step.t);
    if (o_.scale != 1) line += fmt::format(", displacements \u00d7 {:g}", o_.scale);
    draw_title(p, o_.title.empty() ? run_.title : o_.title, line);
    draw_axes_cross(p, fit.right(), fit.up(), fit.back());
    if (!is_named_field(o_.field)) return draw_colour_bar(p, frame.side, bar_);
    std::vector<LegendEntry> entries;
    for (size_t i = 0; i < named_.names.size(); ++i) entries.push_back({named_.names[i], named_.colours[i], nullptr});
    draw_legend(p, frame.side, named_.title, entries);
  }

  std::string frame_path(const Step& step) const {
    const bool png = o_.output.ends_with(".png");
    if (png && steps_.size() == 1) return o_.output;
    return fmt::format("{}-{}.png", png ? o_.output.substr(0, o_.output.size() - 4) : o_.output, step.key);
  }

  const Options& o_;
  RunFile run_;
  const MeshFile& file_;
  const Mesh& mesh_;
  std::vector<Step> steps_;
  std::vector<bool> shown_, zoomed_, valued_;  // per region
  std::vector<bool> counted_, framed_;         // per node: in the range; in the frame
  std::vector<Vec3> extremes_;
  std::unique_ptr<Skin> coloured_, toned_;
  ShownField field_;
  NamedCells named_;
  ColourBar bar_;
  double factor_ = 1;
};

}  // namespace

Command render_command(CLI::App& app) {
  auto* sub = app.add_subcommand("render", "PNG frames of a run, coloured by a field");
  const auto o = std::make_shared<Options>();
  sub->add_option("run", o->run, "run.h5 of hilo-solve")->required();
  sub->add_option("-o,--output", o->output, "PNG file of a single step, or start of the names: out/frame gives out/frame-000012.png")
      ->required();
  sub->add_option("--field", o->field,
                  "von_mises, acceleration, displacement, velocity (or .x .y .z of these), stress.xx, region, fidelity, partition")
      ->capture_default_str();
  sub->add_option("--steps", o->steps, "all, first, last or numbers: 0,5,10")->capture_default_str();
  sub->add_option("--times", o->times, "times in s, instead of --steps: the nearest ones are drawn");
  sub->add_option("--camera", o->camera, fmt::format("{}, or x,y,z towards the camera", fmt::join(view_names(), ", ")))
      ->capture_default_str();
  sub->add_option("--scale", o->scale, "factor on the displacements")->capture_default_str();
  sub->add_option("--range", o->range, "LOW,HIGH of the colours in the shown unit; the range over all drawn steps by default");
  sub->add_option("--unit", o->unit, "unit shown: MPa, mm, g, ...; a handy one by default");
  sub->add_option("--colours", o->colours, "viridis or cividis")->check(CLI::IsMember({"viridis", "cividis"}))->capture_default_str();
  sub->add_option("--size", o->size, "size of the picture, WIDTHxHEIGHT")->capture_default_str();
  sub->add_option("--edges", o->edges, "none, feature or all")->check(CLI::IsMember({"none", "feature", "all"}))->capture_default_str();
  sub->add_option("--show", o->show, "regions to draw, by name or glob; all by default")->allow_extra_args(false);
  sub->add_option("--hide", o->hide, "regions not to draw")->allow_extra_args(false);
  sub->add_option("--zoom", o->zoom, "regions that fill the picture")->allow_extra_args(false);
  sub->add_option("--title", o->title, "title instead of the scene's");
  example(*sub, "  hilo-post render run.h5 --field von_mises --steps last --camera iso -o stress.png");
  return {sub, [o] { Renderer(*o).write_frames(); }};
}

}  // namespace hilo
