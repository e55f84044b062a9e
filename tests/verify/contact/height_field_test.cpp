// SPDX-License-Identifier: GPL-3.0-or-later
// Obstacles of kind height-field: what is flat is a plane, what rolls and swings does so as in closed form, and energy is kept on a road.
#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>

#include "dynamics/kept_run.hpp"
#include "succeeded.hpp"
#include "verify/block_mesh.hpp"
#include "verify/contact/collision.hpp"
#include "verify/verify.hpp"

namespace hilo::test::height_field_test {
namespace {

constexpr double g = 9.81, pi = std::numbers::pi;
using Function = std::function<double(double, double)>;

/// A grid of heights: half widths, number of points along x and along y.
void write_grid(const std::filesystem::path& path, double a, double b, int nx, int ny, const Function& f) {
  std::ofstream out(path);
  out << "y\\x";
  for (int i = 0; i < nx; ++i) out << fmt::format(",{:.17g}", -a + 2 * a * i / (nx - 1));
  for (int j = 0; j < ny; ++j) {
    const double y = -b + 2 * b * j / (ny - 1);
    out << fmt::format("\n{:.17g}", y);
    for (int i = 0; i < nx; ++i) out << fmt::format(",{:.17g}", f(-a + 2 * a * i / (nx - 1), y));
  }
  out << "\n";
}

const std::string field = "kind = \"height-field\"\nfile = \"road.csv\"";

/// A ball of 1 kg with a skin of `radius`, over an obstacle.
std::string ball(const std::string& obstacle, const Vec3& at, const Vec3& v, double radius, const std::string& contact,
                 const std::string& time) {
  const double J = 0.4 * radius * radius;
  return fmt::format(
      "gravity = [0, 0, -9.81]\n[[body]]\nname = \"ball\"\nmass = 1\ncom = [{0:.17g}, {1:.17g}, {2:.17g}]\ninertia = [{3:.17g}, {3:.17g}, "
      "{3:.17g}]\n[[obstacle]]\n{4}\nname = \"ground\"\n[[obstacle]]\nkind = \"sphere\"\nname = \"skin\"\non = \"ball\"\nradius = "
      "{5}\nat = [{0:.17g}, {1:.17g}, {2:.17g}]\n[[contact]]\nname = \"c\"\na = \"ground\"\nb = \"skin\"\n{6}\n[[initial]]\non = "
      "[\"ball\"]\nvelocity = [{7}, {8}, {9}]\n[[probe]]\nname = \"p\"\non = \"ball\"\n[solver]\ntolerance = 1e-12\n[time]\n{10}\n",
      at[0], at[1], at[2], J, obstacle, radius, contact, v[0], v[1], v[2], time);
}

struct Road : Case {
  Road() : Case("contact") {}
  Results run(const std::string& scene, const std::string& options = "") const {
    std::ofstream(*this / "scene.toml") << scene;
    succeeded(Case::run("hilo-solve --quiet scene.toml " + options + " -o run.h5"));
    return Results(*this / "run.h5");
  }
};

// Truth: the run against a plane, flat or tilted, with friction, through impacts; the axes of the field turned about it.
TEST(HeightField, WhatIsFlatIsAPlane) {
  const Road c;
  const Function heights[] = {[](double, double) { return 0; }, [](double x, double y) { return 0.3 * x - 0.2 * y; }};
  for (const int tilted : {0, 1}) {
    write_grid(c / "road.csv", 3, 2, 5, 4, heights[tilted]);
    const std::string contact = "friction = 0.3\nstiffness = 1e4", time = "end = 1\nstep = 0.004";
    const Vec3 at(0.3, 0.1, 0.3), v(0.5, 0.3, -1);
    const Results plane =
        c.run(ball(fmt::format("kind = \"plane\"\naxis = [{}, {}, 1]", tilted ? -0.3 : 0, tilted ? 0.2 : 0), at, v, 0.1, contact, time));
    const auto x = plane.history("probe/p"), f = plane.history("contact/c");
    ASSERT_GT((f.col(3).array() > 0).count(), 10) << "it meets";
    for (const char* turned : {"", "\nx = [0.6, 0.8, 0]"}) {
      if (tilted && *turned) continue;
      const Results r = c.run(ball(field + turned, at, v, 0.1, contact, time));
      EXPECT_LT((r.history("probe/p") - x).cwiseAbs().maxCoeff(), 1e-10) << tilted << turned;
      EXPECT_LT((r.history("contact/c") - f).cwiseAbs().maxCoeff(), 1e-6) << tilted << turned;
    }
  }
}

// Truth: heights of a paraboloid r^2/(2 a) have its curvature; the centre of a ball of radius R, deep d, goes about the bottom as a
// pendulum of length a - R + d, and with 7/5 of the inertia where it rolls.  An amplitude A changes the period by about (A/a)^2.
TEST(HeightField, ABallSwingsInAParabolicBowl) {
  const Road c;
  const double a = 1, R = 0.2, k = 1e6, d = g / k, A = 0.004;
  write_grid(c / "road.csv", 0.5, 0.5, 11, 9, [&](double x, double y) { return (x * x + y * y) / (2 * a); });
  for (const bool rolls : {false, true}) {
    const double length = a - R + d, T = 2 * pi * std::sqrt((rolls ? 1.4 : 1) * length / g);
    const double z = R - d + A * A / (2 * length);
    const Results r = c.run(ball(field, {A, 0, z}, Vec3::Zero(), R, fmt::format("stiffness = {}\nfriction = {}", k, rolls ? 1 : 0),
                                 fmt::format("end = {:.17g}\nstep = {:.17g}", 2.1 * T, T / 400)));
    const auto x = r.history("probe/p");
    std::vector<double> crossings;
    for (Eigen::Index i = 1; i < x.rows(); ++i)
      if ((x(i, 0) > 0) != (x(i - 1, 0) > 0))
        crossings.push_back(r.t()[i - 1] + (r.t()[i] - r.t()[i - 1]) * x(i - 1, 0) / (x(i - 1, 0) - x(i, 0)));
    ASSERT_EQ(crossings.size(), 4u) << rolls;
    EXPECT_NEAR(crossings[3] - crossings[0], 1.5 * T, 2e-4 * T) << rolls;  // pi^2/(12) (T/400)^2-like errors of the step are 5e-6
    EXPECT_NEAR(crossings[0], T / 4, 2e-3 * T) << rolls;
  }
}

// Truth: nothing but gravity works: at any step, over crests from which the ball flies, the balance of every step closes; what friction
// takes is never given back.
TEST(HeightField, EnergyIsKeptOnASineRoad) {
  const Road c;
  write_grid(c / "road.csv", 4, 1, 65, 5,
             [](double x, double y) { return 0.05 * std::cos(3 * x) - 0.25 * x + 0.02 * y * std::sin(2 * x); });
  for (const char* friction : {"0", "0.5"})
    for (const double step : {0.002, 0.01, 0.05}) {
      const Results r = c.run(ball(field, {-3, 0, 0.85}, {1, 0.05, 0}, 0.1, fmt::format("friction = {}\nstiffness = 1e4", friction),
                                   fmt::format("end = 1.5\nstep = {}", step)));
      const Worst w = worst_of(r, 1, 1);
      EXPECT_LT(w.energy, 1e-11) << friction << " " << step;
      EXPECT_LE(w.given_back, 1e-14) << friction << " " << step;
      EXPECT_GT(w.met, 4) << friction << " " << step;
      const auto x = r.history("probe/p");
      EXPECT_GT(x(x.rows() - 1, 0) - x(0, 0), 1) << "it goes down the road";
    }
}

// Truth: two free bodies, one of which carries the field: energy and both momenta.
TEST(HeightField, OnAFreeBodyKeepsMomenta) {
  const Road c;
  write_grid(c / "road.csv", 0.6, 0.6, 9, 9, [](double x, double y) { return 0.1 * std::sin(4 * x) * std::cos(3 * y); });
  for (const double step : {0.001, 0.01, 0.03}) {
    const Results r = c.run(fmt::format(
        "[[body]]\nname = \"A\"\nmass = 2\ninertia = [0.25, 0.3, 0.35]\ncom = [0, 0, -0.1]\n[[body]]\nname = \"B\"\nmass = 1\n"
        "inertia = [0.015, 0.02, 0.025]\ncom = [0.1, 0.05, 0.5]\n[[obstacle]]\nname = \"o\"\non = \"A\"\n{}\n[[obstacle]]\nname = "
        "\"s\"\non = "
        "\"B\"\nkind = \"sphere\"\nradius = 0.15\nat = [0.12, 0.05, 0.5]\n[[contact]]\nname = \"c\"\na = \"o\"\nb = \"s\"\nfriction = 0.4\n"
        "stiffness = 2e3\n[[initial]]\non = [\"A\"]\nvelocity = [0, 0, 0.5]\nspin = [0.3, -0.2, 0.5]\n[[initial]]\non = [\"B\"]\nvelocity "
        "= "
        "[0, 0, -1]\nspin = [1.2, 0.8, -0.6]\n[solver]\ntolerance = 1e-12\n[time]\nend = 0.6\nstep = {}\n",
        field, step));
    const Worst w = worst_of(r, 1, 0.1);
    EXPECT_LT(std::max({w.energy, w.momentum, w.angular}), 1e-11) << step;
    EXPECT_LE(w.given_back, 1e-15) << step;
    EXPECT_GT(w.met, 0) << step;
  }
}

// Truth: gravity and what friction and restitution take; fields of hills and holes about as wide as the balls, thrown at at random.
TEST(HeightField, ThirtyThrowsKeepEnergy) {
  const Road c;
  int met = 0;
  for (int seed = 0; seed < 30; ++seed) {
    Dice dice(seed + 700);
    const double a = dice(0.02, 0.25), kx = dice(1, 6), ky = dice(1, 6), tilt = dice(-0.3, 0.3), k = std::pow(10, dice(3, 5));
    write_grid(c / "road.csv", 3, 3, 31, 27, [&](double x, double y) { return a * std::sin(kx * x) * std::cos(ky * y) + tilt * x; });
    const double contact = pi / std::sqrt(k), step = contact * std::pow(10, dice(-1.5, 0.3));
    const Results r = c.run(ball(
        field, {dice(-1, 1), dice(-1, 1), 0.8}, {dice(-2, 2), dice(-2, 2), dice(-3, 0)}, dice(0.05, 0.3),
        fmt::format("friction = {}\nstiffness = {}\nrestitution = {}", dice() < 0.3 ? 0 : dice(0, 1.5), k, dice() < 0.5 ? 1 : dice(0, 1)),
        fmt::format("end = {}\nstep = {}", std::min(1.5, 300 * step), step)));
    const Worst w = worst_of(r, 1, 1);
    EXPECT_LT(w.energy, 1e-11) << seed;
    EXPECT_LE(w.given_back, 1e-14) << seed;
    met += w.met > 0;
  }
  EXPECT_GT(met, 20);
}

// Truth: what one rank does; a run that is left and taken up again; a block of cells, linear or not, keeps its energy over the bumps.
TEST(HeightField, ABlockOfCellsOnRanksAndThroughARestart) {
  BlockOptions o;
  o.n[0] = 4, o.n[1] = 2, o.n[2] = 1, o.low = Vec3(-2.6, -0.3, 0.2), o.high = Vec3(-1.8, 0.3, 0.5);
  for (const Fidelity level : {Fidelity::nonlinear, Fidelity::rigid}) {
    Case c("contact");
    c.use(block_mesh(o), {level});
    write_grid(c / "road.csv", 4, 1, 33, 5, [](double x, double) { return 0.05 * std::cos(2 * x) - 0.2 * x - 0.4; });
    std::ofstream(c / "scene.toml")
        << "gravity = [0, 0, -9.81]\n[material.soft]\nE = 2e6\nnu = 0.3\ndensity = 1000\n[region.\"*\"]\nmaterial = \"soft\"\n"
           "[[obstacle]]\nname = \"ground\"\n" +
               field + "\n[[contact]]\nname = \"c\"\na = \"ground\"\nb = \"block\"\nfriction = 0.2\n"
        << (level == Fidelity::rigid ? "modulus = 2e6\nlayer = 0.1\n" : "")
        << "[[initial]]\non = [\"block\"]\nvelocity = [1, 0, -1]\n[[probe]]\nname = \"p\"\non = \"block\"\n[output]\nfields = "
           "[\"displacement\"]\n"
           "[solver]\ntolerance = 1e-13\n[time]\nend = 0.3\nstep = 0.01\n";
    const auto solved = [&](const std::string& launcher, const std::string& options, const std::string& output) {
      const Ran ran = c.run(
          "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 "
          "OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_hwloc_base_binding_policy=none OPENBLAS_NUM_THREADS=1\n" +
          launcher + "hilo-solve --quiet scene.toml tags.h5 " + options + " -o " + output);
      EXPECT_EQ(ran.exit, 0) << launcher << options << ran.err;
      return Results(c / output);
    };
    const Results one = solved("", "", "one.h5");
    const Worst w = worst_of(one, 1, 1);
    EXPECT_LT(w.energy, 1e-11) << word(level);
    EXPECT_LE(w.given_back, 1e-14) << word(level);
    EXPECT_GT(w.met, 4) << word(level);
    const auto same = [&](const Results& r, const std::string& what) {
      const auto a = one.history("probe/p"), b = r.history("probe/p");
      ASSERT_EQ(a.rows(), b.rows()) << what;
      EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-9) << what;
    };
    if (level == Fidelity::nonlinear) same(solved("timeout 60 mpirun -n 2 ", "", "run.h5"), "2 ranks");
    solved("", "--checkpoint 10steps --set time.end=0.15", "left.h5");
    same(solved("", "--restart left.h5", "left.h5"), std::string(word(level)) + " restart");
  }
}

// Truth: a ball that rolls off the border falls freely, and the run says so.
TEST(HeightField, EndsAtItsBorder) {
  const Road c;
  write_grid(c / "road.csv", 0.5, 0.5, 3, 3, [](double, double) { return 0; });
  std::ofstream(c / "scene.toml") << ball(field, {0.4, 0, 0.0999}, {1, 0, 0}, 0.1, "stiffness = 1e5", "end = 0.6\nstep = 0.005");
  const Ran ran = succeeded(c.Case::run("hilo-solve scene.toml -o run.h5"));
  const Results r(c / "run.h5");
  const auto x = r.history("probe/p"), f = r.history("contact/c"), e = r.history("energy");
  EXPECT_LT(x(x.rows() - 1, 2), -0.5);
  EXPECT_EQ(f(f.rows() - 1, 3), 0);
  EXPECT_LT((e.col(5).array() - e(0, 5)).abs().maxCoeff(), 1e-11 * 10);
  EXPECT_NE(ran.err.find("1 of 1 points have gone past the border"), std::string::npos) << ran.err;
}

TEST(HeightField, SaysWhatIsWrongWithItsFile) {
  const Road c;
  const std::string scene = ball(field, {0, 0, 1}, Vec3::Zero(), 0.1, "stiffness = 1e5", "end = 0.01\nstep = 0.005");
  std::ofstream(c / "scene.toml") << scene;
  const auto says = [&](const std::string& csv, const std::string& text) {
    std::ofstream(c / "road.csv") << csv;
    const Ran ran = c.Case::run("hilo-solve --quiet scene.toml -o run.h5");
    EXPECT_EQ(ran.exit, 2) << csv;
    EXPECT_NE(ran.err.find(text), std::string::npos) << csv << ": " << ran.err;
  };
  says("y\\x,0,1\n0,1,\n1,2,3\n", "road.csv:2:5: a hole: no height");
  says("y\\x,0,1\n0,1,nan\n1,2,3\n", "road.csv:2:5: \"nan\" is not a height");
  says("y\\x,0,1\n0,1,2\n1,2\n", "road.csv:3:3: 2 columns where the header has 3");
  says("y\\x,0,1\n0,1,2\n1,2,3,4\n", "road.csv:3:7: 4 columns where the header has 3");
  says("y\\x,0,1\n0,1,2\n", "road.csv:2:1: 1 row of heights: a field has two at least");
  says("y\\x,0\n0,1\n", "road.csv:1:1: 1 column of heights");
  says("y\\x,0,0\n0,1,2\n1,2,3\n", "road.csv:1:7: x = 0 comes after 0");
  says("y\\x,0,1\n1,1,2\n0,2,3\n", "road.csv:3:1: y = 0 comes after 1");
  says("y\\x,0,a\n1,1,2\n0,2,3\n", "road.csv:1:7: \"a\" is not a number");
  says("0,0,1\n1,1,2\n0,2,3\n", "road.csv:1:1: no header line");
  says("", "road.csv:1:1: 0 rows of heights");
  says("y\\x,0,1e-200\n0,1,1e300\n1,2,3\n", "heights or slopes of the field are too large");
  std::filesystem::remove(c / "road.csv");
  const Ran ran = c.Case::run("hilo-solve --quiet scene.toml -o run.h5");
  EXPECT_NE(ran.err.find("scene.toml:9:"), std::string::npos) << ran.err;
  EXPECT_NE(ran.err.find("no file road.csv"), std::string::npos) << ran.err;
}

/// Levels of grey, the lowest line of the picture first, as a PNG of so many bits, grey or with equal colours.
void write_image(const std::filesystem::path& path, unsigned nx, const std::vector<unsigned>& levels, int bits,
                 int colour = PNG_COLOR_TYPE_GRAY) {
  const auto ny = static_cast<unsigned>(levels.size()) / nx;
  std::FILE* file = std::fopen(path.c_str(), "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, nx, ny, bits, colour, PNG_INTERLACE_ADAM7, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  png_set_packing(png);
  std::vector<std::vector<unsigned char>> lines(ny);
  std::vector<png_bytep> rows;
  for (unsigned j = 0; j < ny; ++j) {
    for (unsigned i = 0; i < nx; ++i)
      for (int sample = 0; sample < (colour == PNG_COLOR_TYPE_RGB ? 3 : 1); ++sample) {
        const unsigned level = levels[(ny - 1 - j) * nx + i];
        if (bits == 16) lines[j].push_back(static_cast<unsigned char>(level / 256));
        lines[j].push_back(static_cast<unsigned char>(level % 256));
      }
    rows.push_back(lines[j].data());
  }
  png_write_image(png, rows.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
}

// Truth: the run over the same heights as CSV; a picture's lowest line is that of the least y, and the bowl is not that of a mirror.
TEST(HeightField, AnImageIsItsLevelsOfGrey) {
  const Road c;
  constexpr unsigned nx = 9, ny = 7;
  const double low = -0.02, high = 0.4;
  for (const int bits : {4, 8, 16}) {
    const unsigned white = (1U << bits) - 1;
    std::vector<unsigned> levels;
    std::ofstream csv(c / "road.csv");
    csv << "y\\x";
    for (unsigned i = 0; i < nx; ++i) csv << fmt::format(",{:.17g}", 1.6 * i / 8);
    for (unsigned j = 0; j < ny; ++j) {
      csv << fmt::format("\n{:.17g}", 1.2 * j / 6);
      for (unsigned i = 0; i < nx; ++i) {
        const double h = 0.04 + 0.4 * std::pow(i / 8. - 0.4, 2) + 0.7 * std::pow(j / 6. - 0.3, 2) + 0.1 * i * j / 48;
        levels.push_back(static_cast<unsigned>(white * h));
        csv << fmt::format(",{:.17g}", low + (high - low) * levels.back() / white);
      }
    }
    csv.close();
    write_image(c / "road.png", nx, levels, bits);
    const auto way = [&](const std::string& obstacle) {
      return c.run(ball(obstacle, {0.9, 0.7, 0.4}, {0.2, -0.1, 0}, 0.1, "stiffness = 1e4\nfriction = 0.2", "end = 1\nstep = 0.005"))
          .history("probe/p");
    };
    const auto x = way(field), of_image = way("kind = \"height-field\"\nfile = \"road.png\"\nsize = [1.6, 1.2]\nheights = [-0.02, 0.4]");
    EXPECT_GT((x.rowwise() - x.row(0)).cwiseAbs().maxCoeff(), 0.1) << bits;
    EXPECT_LT((x - of_image).cwiseAbs().maxCoeff(), 1e-9) << bits;
  }
}

TEST(HeightField, SaysWhatIsWrongWithItsImage) {
  const Road c;
  const std::string image = "kind = \"height-field\"\nfile = \"road.png\"\n", sizes = "size = [1, 1]\nheights = [0, 4]\n";
  const auto said = [&](const std::string& obstacle) {
    std::ofstream(c / "scene.toml") << ball(obstacle, {0.5, 0.5, 3}, Vec3::Zero(), 0.1, "stiffness = 1e5", "end = 0.01\nstep = 0.005");
    return c.Case::run("hilo-solve scene.toml -o run.h5").err;
  };
  const auto says = [&](const std::string& obstacle, const std::string& text) {
    const std::string err = said(obstacle);
    EXPECT_NE(err.find(text), std::string::npos) << text << ": " << err;
  };
  write_image(c / "road.png", 2, {0, 100, 200, 255}, 8);
  says(image + sizes, "its 8 bits tell heights in steps of 0.0157 m");
  EXPECT_EQ(said(image + "size = [1, 1]\nheights = [0, 0.1]\n").find("bits tell"), std::string::npos);
  says(image + "size = [1, 1]\n", "an image without `heights`");
  says(image + "size = [1, 0]\nheights = [0, 1]\n", "size = 0 is not > 0");
  write_image(c / "road.png", 2, {0, 100, 200, 255}, 8, PNG_COLOR_TYPE_RGB);
  says(image + sizes, "road.png: an image of colours or of holes (heights are levels of grey");
  write_image(c / "road.png", 1, {0, 1}, 16);
  says(image + sizes, "1 x 2 pixels: a field has two each way at least");
  write_image(c / "road.png", 20, std::vector<unsigned>(400, 7), 16);
  std::filesystem::resize_file(c / "road.png", std::filesystem::file_size(c / "road.png") - 20);
  says(image + sizes, "road.png: this image cannot be read: ");
  std::filesystem::resize_file(c / "road.png", 12);
  says(image + sizes, "road.png: this image cannot be read: it ends within the image");
  write_grid(c / "road.csv", 1, 1, 3, 3, [](double, double) { return 0; });
  says(field + "\n" + sizes, "`size` is of a PNG image, which road.csv is not");
}

}  // namespace
}  // namespace hilo::test::height_field_test
