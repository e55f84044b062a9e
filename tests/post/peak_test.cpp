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

TEST(Chart, reads_a_pipe) {
  const Workplace place;
  succeeded(place.run("printf 't [s],x [m]\\n0,0\\n1,2\\n' | hilo-post chart - -o a.png"));
  EXPECT_TRUE(std::filesystem::exists(place / "a.png"));
  expect_end(place.run("printf 't [s],x [m]\\n0\\n' | hilo-post chart - -o b.png"), 2, "<stdin>:2");
}

}  // namespace
}  // namespace hilo::test::peak_test
