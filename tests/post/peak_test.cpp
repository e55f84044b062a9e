// SPDX-License-Identifier: GPL-3.0-or-later
#include <sstream>

#include "sample_run.hpp"
#include "succeeded.hpp"

namespace hilo::test::peak_test {
namespace {

TEST(Peak, is_the_largest_value_of_each_flexible_region_with_its_place_and_time) {
  const Workplace place;
  const Mesh mesh = sample::machine();
  sample::write_run(place.path(), mesh, 5);
  const Ran ran = succeeded(place.run("hilo-post peak run.h5 --unit MPa --show barrel"));
  std::istringstream lines(ran.out);
  std::string header, region, more;
  double value = 0, t = 0, node = 0, x = 0;
  std::getline(lines, header);
  lines >> region >> value >> t >> node >> x;
  EXPECT_EQ(region, "barrel");
  EXPECT_NEAR(value, 200, 1e-3);  // the sample's stress at the front at the end
  EXPECT_NEAR(x, sample::front(mesh), 1e-4 * sample::front(mesh));
  EXPECT_NE(header.find("von_mises [MPa]"), std::string::npos);
  const Ran first = place.run("hilo-post peak run.h5 --unit MPa --show barrel --steps first");
  std::istringstream at_first(first.out);
  std::getline(at_first, header);
  ASSERT_TRUE(at_first >> region >> value) << first.out;
  EXPECT_EQ(value, 0) << "unloaded at the start";
}

TEST(Peak, of_rigid_regions_has_no_stress_but_a_displacement) {
  const Workplace place;
  sample::write_run(place.path(), sample::machine(), 2);
  EXPECT_EQ(place.run("hilo-post peak run.h5 --show hull").exit, 2);
  EXPECT_EQ(place.run("hilo-post peak run.h5 --show hull --field displacement").exit, 0);
  EXPECT_EQ(place.run("hilo-post peak run.h5 --field partition").exit, 1);
}

// Truth: the sample's histories end at 0.1 s, as its fields do; a row more is 0.5 ms later.
// Truth: the sample's cells have 1 MPa for each step.
TEST(Peak, of_cells_is_found_too) {
  const Workplace place;
  sample::write_run(place.path(), sample::cube(1), 3);
  EXPECT_EQ(succeeded(place.run("hilo-post peak run.h5 --field cell_von_mises --unit MPa --json")).out,
            "[\n  {\"region\": \"cube\", \"cell_von_mises [MPa]\": 3, \"t [s]\": 0.1, \"cell\": 0, \"X [m]\": 0.5, \"Y [m]\": 0.5, \"Z "
            "[m]\": 0.5}\n]\n");
  EXPECT_EQ(place.run("hilo-post peak run.h5 --field cell_acceleration").exit, 2);
}

TEST(Judged, a_run_that_stopped_says_so) {
  const Workplace place;
  place.write("ask.toml", "[[quantity]]\nkind = \"peak\"\nname = \"q\"\nstress = \"cube\"\n[time]\nend = 0.1\nstep = 5e-4\n");
  const std::string run = sample::write_run(place.path(), sample::cube(2), 2, false);
  const std::vector<std::string> all{"peak run.h5",
                                     "at run.h5 displacement --node 0",
                                     "render run.h5 --size 320x240 -o a.png",
                                     "export run.h5 --steps last -o a.vtu",
                                     "quantity run.h5 --scene ask.toml",
                                     "series run.h5 energy -o a.csv",
                                     "gload run.h5",
                                     "injury run.h5",
                                     "compare run.h5 run.h5 -y energy"};
  const auto count = [&](const std::string& command, const std::string& words) {
    const std::string err = succeeded(place.run("hilo-post " + command)).err;
    size_t n = 0;
    for (size_t at = err.find(words); at != err.npos; at = err.find(words, at + 1)) ++n;
    return n;
  };
  const std::string stopped = "run.h5: the run is not complete: in progress or stopped, it has come to t = 0.1 s";
  for (const std::string& command : all) EXPECT_EQ(count(command, stopped), command.starts_with("compare") ? 2 : 1) << command;
}

TEST(Chart, reads_a_pipe) {
  const Workplace place;
  succeeded(place.run("printf 't [s],x [m]\\n0,0\\n1,2\\n' | hilo-post chart - -o a.png"));
  EXPECT_TRUE(std::filesystem::exists(place / "a.png"));
  expect_end(place.run("printf 't [s],x [m]\\n0\\n' | hilo-post chart - -o b.png"), 2, "<stdin>:2");
}

}  // namespace
}  // namespace hilo::test::peak_test
