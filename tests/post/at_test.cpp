// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post at: fields that the shape functions hold exactly, at points of all kinds of cells; what is refused.
#include <algorithm>
#include <array>
#include <random>
#include <sstream>

#include "base/error.hpp"
#include "moving_run.hpp"
#include "post/files/csv.hpp"
#include "post/run/locate.hpp"
#include "post/run/times.hpp"
#include "sample_run.hpp"
#include "succeeded.hpp"

namespace hilo::test::at_test {
namespace {

using Points = std::vector<Vec3>;

struct Case {
  Shape shape;
  Points corners;
  std::vector<std::array<int, 2>> edges;  // with a node in the middle
};

std::vector<Case> all_cells() {
  const Points tet{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Points wedge{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  const Points hex{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const std::vector<std::array<int, 2>> tet_edges{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  const std::vector<std::array<int, 2>> wedge_edges{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}};
  const std::vector<std::array<int, 2>> hex_edges{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                                  {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  return {{Shape::tet4, tet, {}}, {Shape::tet10, tet, tet_edges}, {Shape::wedge6, wedge, {}},     {Shape::wedge15, wedge, wedge_edges},
          {Shape::hex8, hex, {}}, {Shape::hex20, hex, hex_edges}, {Shape::hex20r, hex, hex_edges}};
}

/// One cell: its corners skewed, and moved apart and its edges curved by up to `distortion`.
Mesh one_cell(const Case& c, double distortion, std::mt19937& random) {
  std::uniform_real_distribution<double> some(-distortion, distortion);
  const auto moved = [&](const Vec3& x) { return Vec3(x + Vec3(some(random), some(random), some(random))); };
  Mesh mesh;
  mesh.region_name = {"cell"};
  mesh.region_data.resize(1);
  const Mat3 skew = (Mat3() << 0.02, 0.005, -0.003, 0.001, 0.05, 0.01, 0, -0.004, 0.03).finished();
  for (const Vec3& x : c.corners) mesh.X.push_back(moved(x));
  for (const auto& [a, b] : c.edges) mesh.X.push_back(moved((mesh.X[static_cast<size_t>(a)] + mesh.X[static_cast<size_t>(b)]) / 2));
  std::vector<std::int64_t> nodes;
  for (Vec3& x : mesh.X) x = skew * x + Vec3(3, -2, 1), nodes.push_back(static_cast<std::int64_t>(nodes.size())), mesh.node_id.push_back(0);
  mesh.add_cell(c.shape, nodes, 0, 1);
  return mesh;
}

/// A point inside: a mean of the corners, each with a weight.
Vec3 inside(const Mesh& mesh, size_t n_corners, std::mt19937& random) {
  std::uniform_real_distribution<double> weight(0.4, 1);
  Vec3 X = Vec3::Zero();
  double sum = 0;
  for (size_t a = 0; a < n_corners; ++a) {
    const double w = weight(random);
    X += w * mesh.X[a], sum += w;
  }
  return X / sum;
}

template <class F>
double at(const Located& place, const Mesh& mesh, const F& f) {
  double value = 0;
  for (size_t a = 0; a < place.nodes.size(); ++a) value += place.N[a] * f(mesh.X[static_cast<size_t>(place.nodes[a])]);
  return value;
}

// Shape functions hold every linear field, whatever the cell looks like: at the point found they give the point itself.
TEST(At, LinearFieldsAreExactInDistortedCellsOfAllKinds) {
  std::mt19937 random(7);
  for (const Case& c : all_cells())
    for (int k = 0; k < 200; ++k) {
      const Mesh mesh = one_cell(c, 0.06, random);
      const Vec3 X = inside(mesh, c.corners.size(), random);
      const Located place = locate(mesh, {true}, X);
      ASSERT_EQ(place.cell, 0) << info(c.shape).name;
      const auto f = [](const Vec3& p) { return 1 + 2 * p.x() - 3 * p.y() + 5 * p.z(); };
      EXPECT_NEAR(at(place, mesh, f), f(X), 1e-12) << info(c.shape).name;
      EXPECT_EQ(locate(mesh, {false}, X).cell, -1);
    }
}

// And the quadratic ones every quadratic field where their edges are straight; linear cells do not.
TEST(At, QuadraticFieldsAreExactInQuadraticCells) {
  std::mt19937 random(8);
  for (const Case& c : all_cells()) {
    double worst = 0;
    for (int k = 0; k < 50; ++k) {
      const Mesh mesh = one_cell(c, 0, random);
      const Vec3 X = inside(mesh, c.corners.size(), random);
      const auto f = [](const Vec3& p) {
        const Vec3 d = (p - Vec3(3, -2, 1)) / 0.05;
        return d.x() * d.x() - 2 * d.y() * d.z() + 3 * d.z() * d.z() + d.x() * d.y() + d.x();
      };
      worst = std::max(worst, std::abs(at(locate(mesh, {true}, X), mesh, f) - f(X)));
    }
    if (c.edges.empty()) {
      EXPECT_GT(worst, 1e-2) << info(c.shape).name;
    } else {
      EXPECT_LT(worst, 1e-12) << info(c.shape).name;
    }
  }
}

TEST(At, PointsOutsideAreInNoCell) {
  std::mt19937 random(9);
  for (const Case& c : all_cells()) {
    const Mesh mesh = one_cell(c, 0, random);
    const Vec3 middle = inside(mesh, c.corners.size(), random);
    for (const Facet f : {Facet{0, 0}, Facet{0, 1}, Facet{0, 2}, Facet{0, 3}}) {
      Vec3 on = Vec3::Zero();
      const auto nodes = mesh.facet_nodes(f);
      const size_t n = nodes.size() % 3 == 0 ? 3 : 4;
      for (size_t a = 0; a < n; ++a) on += mesh.X[static_cast<size_t>(nodes[a])] / static_cast<double>(n);
      EXPECT_EQ(locate(mesh, {true}, on).cell, 0) << info(c.shape).name;
      const Vec3 out = on + 0.002 * (on - middle), normal = facet_area(mesh, f).normalized();
      EXPECT_EQ(locate(mesh, {true}, out).cell, -1) << info(c.shape).name;
      EXPECT_NEAR(nearest_region(mesh, {true}, out).distance, normal.dot(out - on), 1e-12) << info(c.shape).name;
    }
  }
}

/// Stress 2X + 3Y + Z in MPa at all times; the arm moves by (t X, 0, t Y).
std::string run_of_blocks(const Workplace& place) {
  return write_moving_run(
      place, [](const Vec3& X, double t) { return Vec3(X + Vec3(t * X.x(), 0, t * X.y())); }, 3);
}

TEST(At, APointInTimeAsTableCsvAndJson) {
  const Workplace place;
  run_of_blocks(place);
  const Ran table = succeeded(place.run("hilo-post at run.h5 displacement --point 2.3,0.1,0.2 --unit mm"));
  std::istringstream lines(table.out);
  std::string header, skip;
  std::getline(lines, header);
  EXPECT_NE(header.find("displacement.x [mm]"), std::string::npos) << header;
  for (int t = 0; t <= 3; ++t) {
    double time = -1, x = 0, y = 0, z = 0, size = 0;
    lines >> time >> x >> y >> z >> size;
    EXPECT_EQ(time, t);
    EXPECT_NEAR(x, 2300. * t, 1e-3);
    EXPECT_EQ(y, 0);
    EXPECT_NEAR(z, 100. * t, 1e-3);
    EXPECT_NEAR(size, t * std::hypot(2300., 100.), 0.1);  // the size of the mean, not the mean of the sizes
  }
  ASSERT_EQ(place.run("hilo-post at run.h5 displacement.z --point 2.3,0.1,0.2 --unit m --times 2 -o a.csv").exit, 0);
  const CsvTable csv = read_csv(place / "a.csv");
  ASSERT_EQ(csv.rows(), 1u);
  EXPECT_NEAR(csv.numbers(csv.find("displacement.z [m]")).front(), 0.2, 1e-14);
  const Ran json = place.run("hilo-post at run.h5 von_mises --node 0 --unit Pa --steps last --json");
  EXPECT_NE(json.out.find("\"von_mises [Pa]\": 0"), std::string::npos) << json.out;
}

// The blocks lie at x in [0, 1] and [2, 4]; between them is nothing.
TEST(At, ALineHasNoValuesInAGap) {
  const Workplace place;
  run_of_blocks(place);
  const Ran ran =
      succeeded(place.run("hilo-post at run.h5 von_mises --line 0.1,0.3,0.3 3.7,0.3,0.3 -n 37 --steps last --unit Pa -o line.csv"));
  EXPECT_NE(ran.err.find("of 37 points lie in no cell"), std::string::npos) << ran.err;
  const CsvTable csv = read_csv(place / "line.csv");
  ASSERT_EQ(csv.rows(), 37u);
  const auto s = csv.numbers(csv.find("s")), X = csv.numbers(csv.find("X")), v = csv.numbers(csv.find("von_mises"));
  for (size_t i = 0; i < 37; ++i) {
    EXPECT_NEAR(X[i], 0.1 + s[i], 1e-12);
    if (X[i] > 1.001 && X[i] < 1.999) {
      EXPECT_TRUE(std::isnan(v[i])) << X[i];
    } else {
      EXPECT_NEAR(v[i], 1e6 * (2 * X[i] + 1.2), 1e-5) << X[i];
    }
  }
  EXPECT_EQ(place.run("hilo-post at run.h5 von_mises --line 1.2,0,0 1.8,0,0").exit, 2);
}

// A bar pulled along x: u = F X/(E A) on its faces, whose cells have nodes inside the bar as well.
TEST(At, PlacesOnTheSurfaceAreInARunOfTheSkin) {
  const Workplace place;
  const Mesh mesh = two_blocks(3);
  write_mesh(place / "mesh.h5", mesh, {"test"});
  const auto box = [](const char* name, double low, double high) {
    return fmt::format("[set.{}]\nkind = \"box\"\nlow = [{}, -1, -1]\nhigh = [{}, 2, 2]\n", name, low, high);
  };
  place.write("scene.toml", solid(1e6, 0, 1000) + box("foot", -1, 1e-6) + box("end", 0.999, 1.001) + held("foot") + held("arm") +
                                push("end", Vec3(10, 0, 0)) + in_steps(1) + "[output]\nnodes = \"skin\"\n");
  succeeded(place.run("hilo-solve --quiet scene.toml mesh.h5 -o run.h5"));
  const auto at = [&](const std::string& where) {
    return place.run("hilo-post at run.h5 displacement.x --unit m --steps last " + where + " -o out.csv");
  };
  for (const char* where : {"0.5,0.5,0", "0.5,0.5,1", "0.5,0.2,0", "0.5,0,0.45"}) {
    succeeded(at(std::string("--point ") + where), where);
    EXPECT_NEAR(read_csv(place / "out.csv").numbers(1).front(), 0.5e-5, 1e-8) << where;
  }
  succeeded(at("--line 0.1,0.5,1 0.9,0.5,1 -n 9"));
  expect_end(at("--point 0.5,0.5,0.5"), 2, "the place lies inside");
}

TEST(At, RefusesWhatItCannotAnswer) {
  const Workplace place;
  run_of_blocks(place);
  expect_end(place.run("hilo-post at run.h5 von_mises --point 1.9,0.25,0.25"), 2, "lies in no cell (region \"arm\" is 0.1 m away)");
  expect_end(place.run("hilo-post at run.h5 von_mises --point 2.5,0.25,0.25 --hide arm"), 2, "in region \"arm\"");
  const Ran node = place.run("hilo-post at run.h5 von_mises --node 54");
  EXPECT_NE(node.err.find("has 0 to 53"), std::string::npos) << node.err;
  EXPECT_EQ(node.exit, 1);
  for (const char* wrong : {"von_mises", "von_mises --point 1,2", "von_mises --point 1,2,nan", "von_mises --node 1 --point 0,0,0",
                            "von_mises --line 0,0,0 1,0,0 -n 1", "region --node 0", "von_mise --node 0"})
    EXPECT_NE(place.run(std::string("hilo-post at run.h5 ") + wrong).exit, 0) << wrong;
  EXPECT_EQ(place.run("hilo-post at run.h5 stress --node 0").exit, 2);  // the run has none
}

TEST(At, StressIsThatOfFlexibleRegions) {
  const Workplace place;
  sample::write_run(place.path(), sample::machine(), 2);
  expect_end(place.run("hilo-post at run.h5 von_mises --point -0.5,0,0"), 2, "rigid");
  EXPECT_EQ(place.run("hilo-post at run.h5 displacement --point -0.5,0,0").exit, 0);
}

// Words of --steps and --times against the instants that they stand for, at even and uneven steps.
TEST(Instants, AreThoseThatWordsAskFor) {
  const std::vector<double> even{0, 0.01, 0.02, 0.03, 0.04, 0.05}, uneven{0, 1e-3, 0.1, 0.4};
  const auto chosen = [](const std::vector<double>& t, const char* steps, const char* times) {
    return choose_instants(t, steps, times, "run.h5", "step");
  };
  using Rows = std::vector<size_t>;
  EXPECT_EQ(chosen(even, "all", ""), (Rows{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(chosen(even, "first", ""), (Rows{0}));
  EXPECT_EQ(chosen(even, "last", ""), (Rows{5}));
  EXPECT_EQ(chosen(even, "4,0,2:3", ""), (Rows{4, 0, 2, 3}));
  EXPECT_EQ(chosen(even, "all", "0.02"), (Rows{2})) << "times go before numbers";
  EXPECT_EQ(chosen(even, "all", "0.031,0.008"), (Rows{3, 1})) << "the nearest ones, in the order asked for";
  EXPECT_EQ(chosen(even, "all", "0.054,-0.004"), (Rows{5, 0})) << "up to half a step beyond the ends";
  EXPECT_EQ(chosen(even, "last", "0.01:0.03"), (Rows{1, 2, 3})) << "ends included";
  EXPECT_EQ(chosen(even, "last", "0.035:"), (Rows{4, 5}));
  EXPECT_EQ(chosen(even, "last", ":0.015"), (Rows{0, 1}));
  EXPECT_EQ(chosen(uneven, "all", "0.06,0.049,0.54"), (Rows{2, 1, 3}));
  EXPECT_EQ(chosen({0.3}, "all", "0.3"), (Rows{0})) << "one instant";
  struct Refused {
    const char *steps, *times, *words;
    Exit exit;
  };
  for (const Refused& r :
       {Refused{"all", "0.056", "no step near t = 0.056 s", Exit::input}, Refused{"all", "soon", "\"soon\" is no number", Exit::usage},
        Refused{"all", "nan", "\"nan\" is no number", Exit::usage}, Refused{"all", "0.01,,0.02", "\"\" is no number", Exit::usage},
        Refused{"all", "0.1:0.2", "0.1:0.2 is not within the run", Exit::input},
        Refused{"all", "0.03:0.01", "\"0.03:0.01\" is no span of time", Exit::usage},
        Refused{"all", "0.012:0.018", "0.012:0.018 holds no step of the run", Exit::input}, Refused{"6", "", "no step 6", Exit::input},
        Refused{"-1", "", "no step -1", Exit::input}, Refused{"1.5", "", "no step 1.5", Exit::input},
        Refused{"nan", "", "\"nan\" is no number", Exit::usage}, Refused{"3:1", "", "\"3:1\" goes backwards", Exit::usage}}) {
    try {
      (void)chosen(even, r.steps, r.times);
      ADD_FAILURE() << r.steps << ' ' << r.times << " is taken";
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(r.words), std::string::npos) << e.what();
      EXPECT_EQ(static_cast<int>(e.exit), static_cast<int>(r.exit)) << e.what();
    }
  }
}

// One block that shakes beside a beam, an output at every step: histories and fields have the same instants, 0, 0.01 ... 0.05 s.
// --times chooses the same ones of them in every command, and refuses the same.
TEST(Instants, OfTimesAreThoseOfEveryCommand) {
  const Workplace place;
  write_mesh(place / "mesh.h5", sample::cube(1), {"test"});
  write_tags(place / "tags.h5", place / "mesh.h5", {Fidelity::nonlinear}, {"test"});
  place.write("scene.toml",
              "gravity = [0, 0, -9.81]\n[material.m]\nE = 1e8\nnu = 0.3\ndensity = 1000\n[region.cube]\nmaterial = \"m\"\n"
              "[section.s]\nkind = \"circle\"\ndiameter = 0.1\n[beam.one]\npoints = [[5, 0, 0], [7, 0, 0]]\nsection = \"s\"\n"
              "material = \"m\"\na = \"ground\"\n[time]\nend = 0.05\nstep = 0.01\n[output]\ninterval = 0.01\n");
  succeeded(place.run("hilo-solve --quiet scene.toml tags.h5"));
  for (const std::string command : {"series run.h5 energy", "beam run.h5 one", "at run.h5 displacement --node 0"}) {
    for (const auto& [times, expected] : {std::pair{"0.031,0.008", std::vector{0.03, 0.01}}, {"0.01:0.03", {0.01, 0.02, 0.03}}}) {
      SCOPED_TRACE(command + " --times " + times);
      succeeded(place.run("hilo-post " + command + " --times " + times + " -o out.csv"));
      std::vector<double> t = read_csv(place / "out.csv").numbers(0);
      t.erase(std::unique(t.begin(), t.end()), t.end());  // beam: a row for each place
      ASSERT_EQ(t.size(), expected.size());
      for (size_t k = 0; k < t.size(); ++k) EXPECT_NEAR(t[k], expected[k], 1e-12);
    }
    const Ran ran = place.run("hilo-post " + command + " --times 0.06 -o no.csv");
    EXPECT_EQ(ran.exit, 2) << command;
    EXPECT_NE(ran.err.find(" near t = 0.06 s (there are 0 to 0.05 s)"), std::string::npos) << ran.err;
    EXPECT_FALSE(std::filesystem::exists(place / "no.csv"));
  }
}

}  // namespace
}  // namespace hilo::test::at_test
