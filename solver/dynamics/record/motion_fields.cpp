// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/record/fields.hpp"

namespace hilo {
namespace {

class MotionFields final : public FieldSource {
 public:
  explicit MotionFields(const System& system) : system_(system) {}
  std::vector<Field> fields() const override {
    return {{.name = "displacement", .label = "displacement"},
            {.name = "velocity", .label = "velocity"},
            {.name = "acceleration", .label = "acceleration"}};
  }
  void write(const Snapshot& at, FieldWriter& to) override {
    put(to, "displacement", at.q, true);
    put(to, "velocity", at.v, false);
    put(to, "acceleration", at.a, false);
  }

 private:
  void put(FieldWriter& to, const char* name, const Config& of, bool from_reference) const {
    if (!to.wants(name)) return;
    std::vector<Vec3> values = system_.all_nodes(of);
    for (size_t i = 0; i < values.size() && from_reference; ++i) values[i] -= system_.X[i];
    std::vector<double> local;
    local.reserve(3 * values.size());
    for (const Vec3& v : values) local.insert(local.end(), v.data(), v.data() + 3);
    to.nodes(name, local, 3);
  }
  const System& system_;
};

}  // namespace

std::unique_ptr<FieldSource> motion_fields(const System& system, const std::vector<std::int64_t>&) {
  return std::make_unique<MotionFields>(system);
}

}  // namespace hilo
