// SPDX-License-Identifier: GPL-3.0-or-later
// Too little memory ends in exit 4 within seconds and says so; what --dry-run tells is what a run takes.
#include <cmath>

#include "faults.hpp"

using namespace hilo::test;

namespace {

/// A bar of some thousand unknowns, for which BLAS is needed: tags.h5 and linear.h5.
const Workplace& bar() {
  static const Workplace place;
  static const bool once = [] {
    place.write("bar.geo", R"(SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 0.1, 0.1};
Physical Volume("bar") = {1};
Physical Surface("root") = Surface In BoundingBox {-0.01, -0.01, -0.01, 0.01, 0.11, 0.11};
)");
    place.write("scene.toml", R"(material.steel = {E = 205e9, nu = 0.29, density = 7850}
region.bar = {material = "steel"}
joint = [{kind = "fixed", name = "wall", b = "root", at = [0, 0.05, 0.05]}]
time = {end = 5e-4, step = 1e-4}
)");
    EXPECT_EQ(place.run("hilo-import bar.geo --size 0.025 -o mesh.h5").exit, 0);
    EXPECT_EQ(place.run("hilo-tag mesh.h5 --nonlinear bar -o tags.h5").exit, 0);
    EXPECT_EQ(place.run("hilo-tag mesh.h5 --linear bar -o linear.h5").exit, 0);
    return true;
  }();
  static_cast<void>(once);
  return place;
}

Ran limited(int megabytes, const std::string& command) {
  return bar().run("rm -f out.*; export OPENBLAS_NUM_THREADS=1; ulimit -v " + std::to_string(megabytes << 10) +
                   "; exec timeout -s KILL 60 " + command);
}

}  // namespace

// OpenBLAS, refused its buffer, asks for it again for ever.
TEST(Resources, ALimitOfMemoryIsExit4) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer itself takes more addresses than any limit";
#endif
  int refused = 0;
  for (const char* command :
       {"hilo-solve scene.toml tags.h5 -o out.h5", "hilo-solve scene.toml tags.h5 --set 'solver.kind=\"umfpack\"' -o out.h5",
        "hilo-solve scene.toml tags.h5 --set 'solver.kind=\"direct\"' -o out.h5", "hilo-reduce scene.toml linear.h5 -o out.h5",
        "hilo-import bar.geo --size 0.01 -o out.h5"})
    for (int megabytes = 120; megabytes <= 220; megabytes += 20) {
      const Ran ran = limited(megabytes, std::string(command) + " --quiet");
      if (ran.exit == 0 || ran.exit == 127) continue;  // enough; too little for the system to load the program
      EXPECT_EQ(ran.exit, 4) << command << " with " << megabytes << " MB: " << ran.err;
      EXPECT_TRUE(ran.err.find("memory") != std::string::npos) << ran.err;
      EXPECT_EQ(ran.err.find("crash"), std::string::npos) << ran.err;
      EXPECT_EQ(ran.err.find('\n'), ran.err.size() - 1) << ran.err;
      EXPECT_FALSE(std::filesystem::exists(bar().path() / "out.h5"));
      ++refused;
    }
  EXPECT_GT(refused, 10);
}

TEST(Resources, ADryRunTellsWhatTheRunTakes) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer itself takes memory";
#endif
  for (const char* size : {"0.025", "0.012"}) {
    ASSERT_EQ(
        bar()
            .run(std::string("hilo-import bar.geo --quiet --size ") + size + " -o m.h5 && hilo-tag --quiet m.h5 --nonlinear bar -o t.h5")
            .exit,
        0);
    const Ran told = bar().run("hilo-solve --dry-run scene.toml t.h5");
    double memory = 0, disk = 0;
    const auto at = told.err.find("needs ");
    ASSERT_NE(at, std::string::npos) << told.err;
    ASSERT_EQ(std::sscanf(told.err.c_str() + at, "needs %lf MB of memory (%*[^)]) and %lf MB of disk", &memory, &disk), 2) << told.err;
    ASSERT_EQ(bar().run("hilo-solve --quiet scene.toml t.h5 -o run.h5").exit, 0);
    const std::string report = text_of(bar().path() / "run.json");
    const std::string key = "\"peak_memory_bytes\": ";
    const double peak = std::stod(report.substr(report.find(key) + key.size())) / 1e6;
    const double file = static_cast<double>(std::filesystem::file_size(bar().path() / "run.h5")) / 1e6;
    EXPECT_LT(std::abs(std::log2(memory / peak)), 1) << memory << " MB told, " << peak << " MB taken";
    EXPECT_LT(std::abs(std::log2(disk / file)), 1) << disk << " MB told, " << file << " MB taken";
  }
}

// As of a full disk: the system would end the program by a signal without a word.
TEST(Resources, ALimitOfTheLengthOfFilesIsExit4) {
  int refused = 0;
  for (const int kilobytes : {1, 20, 60, 100})
    for (const char* command : {"hilo-solve scene.toml tags.h5 --quiet -o long.h5", "hilo-reduce scene.toml linear.h5 --quiet -o long.h5",
                                "hilo-import bar.geo --size 0.03 --quiet -o long.h5"}) {
      const Ran ran = bar().run("rm -f long.*; ulimit -f " + std::to_string(kilobytes) + "; exec timeout -s KILL 60 " + command);
      if (ran.exit == 0) continue;  // short enough
      EXPECT_EQ(ran.exit, 4) << command << " with " << kilobytes << " kB: " << ran.err;
      EXPECT_NE(ran.err.find("File too large"), std::string::npos) << ran.err;
      EXPECT_EQ(ran.err.find('\n'), ran.err.size() - 1) << ran.err;
      ++refused;
    }
  EXPECT_GT(refused, 7);
}
