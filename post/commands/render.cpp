// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post render: frames of a run, coloured by a field or by names.
#include <fmt/format.h>

#include <memory>

#include "base/args.hpp"
#include "base/error.hpp"
#include "post/commands/commands.hpp"
#include "post/files/output.hpp"
#include "post/picture/workers.hpp"
#include "post/scene/frames.hpp"

namespace hilo {
namespace {

struct RenderOptions : FrameOptions {
  std::string output, steps = "last", times;
  int jobs = 0;
};

std::string path_of(const RenderOptions& o, const Step& step, size_t n) {
  if (o.output == "-" && n == 1) return o.output;
  const bool png = o.output.ends_with(".png");
  if (png && n == 1) return o.output;
  return fmt::format("{}-{}.png", png ? o.output.substr(0, o.output.size() - 4) : o.output, step.key);
}

void run(const RenderOptions& o) {
  Frames frames(o);
  const std::vector<Step> steps = frames.run().select_steps(o.steps, o.times);
  std::vector<double> times;
  for (const Step& s : steps) times.push_back(s.t);
  frames.survey(times);
  frames.close_files();
  const auto start = [&] {
    frames.open_files();
    frames.open();
    return [&](size_t k) {
      frames.draw(times[k]);
      return frames.picture().png();
    };
  };
  in_processes(steps.size(), o.jobs > 0 ? o.jobs : default_jobs(steps.size()), start, [&](size_t k, const std::string& png) {
    const std::string path = path_of(o, steps[k], steps.size());
    write_out(path, png);
    if (path != "-" && !is_quiet()) fmt::print("{}\n", path);
  });
}

}  // namespace

Command render_command(CLI::App& app) {
  auto* sub = app.add_subcommand("render", "PNG frames of a run, coloured by a field");
  const auto o = std::make_shared<RenderOptions>();
  add_frame_options(*sub, *o);
  sub->add_option("-o,--output", o->output,
                  "PNG file of a single step (- for standard output), or start of the names: out/frame gives out/frame-000012.png")
      ->required();
  sub->add_option("--steps", o->steps, "all, first, last or numbers: 0,5,10:20")->capture_default_str();
  sub->add_option("--times", o->times, "times in s, or FROM:TO, instead of --steps: the nearest ones are drawn");
  sub->add_option("--jobs", o->jobs, "processes that draw frames at the same time; one per core by default")->check(CLI::Range(1, 64));
  example(*sub,
          "  hilo-post render run.h5 --field von_mises --steps last --camera iso -o stress.png\n"
          "  hilo-post render run.h5 --field velocity --cut y=0 --forces hinge --trace wheel_2 -o inside.png");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
