// SPDX-License-Identifier: GPL-3.0-or-later
// A field of results: the kinetic energy of a unit of mass at each node.  A FieldSource, and one call that adds it with its word of
// output.fields and its array.
#include "dynamics/record/fields.hpp"
#include "outside.hpp"

namespace outside {
namespace {

using namespace hilo;

class Liveliness final : public FieldSource {
 public:
  explicit Liveliness(const System& system) : system_(system) {}
  std::vector<Field> fields() const override { return {{.name = "liveliness", .label = "kinetic energy of a unit of mass [J/kg]"}}; }
  void write(const Snapshot& at, FieldWriter& to) override {
    std::vector<double> local;
    for (const Vec3& v : system_.all_nodes(at.v)) local.push_back(v.squaredNorm() / 2);
    to.nodes("liveliness", local, 1);
  }

 private:
  const System& system_;
};

}  // namespace

void add_output_field() {
  add_field({"liveliness",
             [](const System& system, const std::vector<std::int64_t>&) -> std::unique_ptr<FieldSource> {
               return std::make_unique<Liveliness>(system);
             }},
            {"liveliness"}, {{"run.h5", "/field/<step>/liveliness", "f8", "(n_nodes)", "J/kg", "half the square of the velocity"}});
}

namespace {

// Exact: of a rigid bar that turns at w about an axis through its end, w^2 r^2/2.
TEST(OutsideField, IsWrittenWhereItIsAskedFor) {
  const test::Workplace place;
  test::BlockOptions o;
  o.n[0] = 4;
  o.high = Vec3(1, 0.1, 0.1);
  const Mesh mesh = test::block_mesh(o);
  write_mesh(place / "mesh.h5", mesh, {"test"});
  write_tags(place / "tags.h5", place / "mesh.h5", {Fidelity::rigid}, {"test"});
  const std::string scene = "[material.m]\ndensity = 1000\n[region.\"*\"]\nmaterial = \"m\"\n" +
                            axial("revolute", "pin", "ground", "block", Vec3::Zero(), {0, 0, 1}) +
                            initial("block", "spin = [0, 0, 3]\nabout = [0, 0, 0]") + in_time(0.1, 0.01) +
                            "[output]\nfields = [\"displacement\", \"liveliness\"]\n";
  const auto r = run_scene(place, scene, "tags.h5");
  for (const std::string& step : r.steps()) {
    const auto field = r.table("/field/" + step + "/liveliness");
    ASSERT_EQ(field.rows(), mesh.n_nodes());
    for (Eigen::Index i = 0; i < field.rows(); ++i)
      EXPECT_NEAR(field(i, 0), 4.5 * mesh.X[static_cast<size_t>(i)].head<2>().squaredNorm(), 1e-6) << step;
    EXPECT_FALSE(r.file().has("/field/" + step + "/velocity"));
  }
  EXPECT_EQ(r.file().text_attribute("/field/000000/liveliness", "unit").value_or(""), "J/kg");
  const auto without = run_scene(place, scene.substr(0, scene.find("[output]")), "tags.h5");
  EXPECT_FALSE(without.file().has("/field/000000/liveliness"));
}

}  // namespace
}  // namespace outside
