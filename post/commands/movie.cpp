// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post movie: a run as an MP4.
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <memory>

#include "base/args.hpp"
#include "base/error.hpp"
#include "model/inputs.hpp"
#include "post/commands/commands.hpp"
#include "post/files/output.hpp"
#include "post/picture/movie_file.hpp"
#include "post/picture/workers.hpp"
#include "post/run/times.hpp"
#include "post/scene/frames.hpp"

namespace hilo {
namespace {

struct MovieOptions : FrameOptions {
  std::string output, times;
  double fps = 25, speed = 0;
  int jobs = 0;
  bool outputs = false;
};

std::string speed_text(double speed) {
  if (std::abs(speed - 1) < 1e-12) return "real speed";
  return speed < 1 ? fmt::format("slowed {:g} times", 1 / speed) : fmt::format("{:g} times real speed", speed);
}

/// How far it is: a line that is kept on a terminal, a line every ten seconds elsewhere.
class Progress {
 public:
  explicit Progress(size_t n) : n_(n) {}
  void show(size_t done) {
    const auto now = std::chrono::steady_clock::now();
    const auto since = [&](auto then) { return std::chrono::duration<double>(now - then).count(); };
    if (is_quiet() || since(last_) < (terminal_ ? 0.2 : 10)) return;
    last_ = now;
    const double left = since(began_) * static_cast<double>(n_ - done) / static_cast<double>(done);
    if (terminal_)
      fmt::print(stderr, "\rframe {} of {}  {:.0f} s left   ", done, n_, left);
    else
      fmt::print(stderr, "progress={:.4f} frame={} frames={} left_s={:.0f}\n", static_cast<double>(done) / static_cast<double>(n_), done,
                 n_, left);
    open_ = terminal_;
  }
  ~Progress() {
    if (open_) fmt::print(stderr, "\r\033[K");
  }

 private:
  size_t n_;
  bool terminal_ = isatty(STDERR_FILENO) != 0, open_ = false;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now(), last_ = began_;
};

void run(MovieOptions o) {
  if (!o.output.ends_with(".mp4") && o.output != "-") throw Error(o.output, "movies are MP4", "give the file the ending .mp4", Exit::usage);
  auto [width, height] = parse_size(o.size);
  width += width % 2, height += height % 2;  // 4:2:0 has colours for pairs of pixels
  o.size = fmt::format("{}x{}", width, height);
  Frames frames(o);
  if (o.output != "-") check_output(o.output);
  const auto all = frames.common_times();
  if (!(all.second > all.first)) throw Error(o.run, "has a single output: nothing moves", "see output.interval of the scene");
  const auto [from, to] = parse_times(o.times, all);
  std::vector<double> times, outputs, seen;
  const double slack = 1e-9 * (to - from), swing = 0.4;  // modes in a second
  const bool modes = !frames.run().shapes.empty();
  for (const Step& s : frames.run().steps)
    if (s.t >= from - slack && s.t <= to + slack) outputs.push_back(s.t);
  if (!frames.run().has_mesh())  // a row for each step is more than the frame of the picture needs
    for (size_t k = 0, n = outputs.size() / 400 + 1; n > 1 && k < outputs.size(); ++k)
      if (k * n < outputs.size()) seen.push_back(outputs[k * n]);
  std::string remark;
  if (o.outputs) {
    times = outputs;
  } else {
    if (o.speed == 0) o.speed = modes ? swing : handy_speed(to - from);
    const auto n = static_cast<size_t>(std::floor((to - from) * o.fps / o.speed + 1e-6)) + 1;
    if (n > 100000) throw Error("--speed", fmt::format("{} frames", n), "a higher --speed or a shorter --times", Exit::usage);
    for (size_t k = 0; k < n; ++k) times.push_back(std::min(to, from + static_cast<double>(k) * o.speed / o.fps));
    if (!modes) remark = ", " + speed_text(o.speed);
  }
  for (size_t k = 0, n = outputs.size(); modes && k < n; ++k)  // the other turning points
    if (outputs[k] + 0.5 <= to) outputs.push_back(outputs[k] + 0.5);
  if (times.empty()) throw Error("--times", "holds no output of the run", "without --outputs frames between them are made", Exit::input);
  if (!seen.empty()) outputs = seen;
  if (outputs.empty() || outputs.front() > from + slack) outputs.insert(outputs.begin(), from);
  if (outputs.back() < to - slack) outputs.push_back(to);
  frames.survey(outputs);
  frames.close_files();
  const int jobs = o.jobs > 0 ? o.jobs : default_jobs(times.size());
  MovieFile movie(width, height, o.fps, times.size(), 1);
  Progress progress(times.size());
  const auto start = [&] {
    frames.open_files();
    frames.open(remark);
    return [&](size_t k) {
      frames.draw(times[k]);
      return frames.picture().pixels();
    };
  };
  in_processes(times.size(), jobs, start, [&](size_t k, const std::string& pixels) {
    movie.add(pixels);
    progress.show(k + 1);
  });
  write_out(o.output, movie.finish());
  if (o.output != "-" && !is_quiet())
    fmt::print("{}: {} frames, {:.1f} s, {}\n", o.output, times.size(), static_cast<double>(times.size()) / o.fps,
               modes ? fmt::format("modes {} to {}", static_cast<int>(times.front()), static_cast<int>(times.back()))
                     : fmt::format("{:g} to {:g} s of the run{}", times.front(), times.back(), remark));
}

}  // namespace

Command movie_command(CLI::App& app) {
  auto* sub = app.add_subcommand("movie", "an MP4 of a run, coloured by a field");
  const auto o = std::make_shared<MovieOptions>();
  add_frame_options(*sub, *o);
  sub->add_option("-o,--output", o->output, "movie.mp4; - for standard output")->required();
  sub->add_option("--times", o->times, "FROM:TO in s; the whole run by default. Of an analysis of modes 3:4 is mode 3, which swings once");
  sub->add_option("--speed", o->speed,
                  "seconds of the run in a second of the movie: 0.01 is slowed 100 times; by default the movie lasts about 10 s. Between "
                  "outputs positions follow the cubic of positions and velocities, fields are interpolated")
      ->check(CLI::PositiveNumber);
  sub->add_option("--fps", o->fps, "frames in a second")->check(CLI::Range(1.0, 240.0))->capture_default_str();
  sub->add_flag("--outputs", o->outputs, "one frame for each output of the run, nothing between them")->excludes("--speed");
  sub->add_option("--jobs", o->jobs, "processes that draw frames at the same time; one per core by default")->check(CLI::Range(1, 64));
  example(*sub,
          "  hilo-post movie run.h5 --field displacement --speed 0.05 -o run.mp4\n"
          "  hilo-post movie run.h5 --field region --track arm --times 0.02:0.06 --size 640x360 -o arm.mp4");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
