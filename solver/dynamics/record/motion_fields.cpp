#include "dynamics/record/fields.hpp"

namespace hilo {
namespace {

class MotionFields final : public FieldSource {
 public:
  explicit MotionFields(const System& system) : X_(system.X) {}
  std::vector<Field> fields() const override {
    return {{.name = "displacement", .label = "displacement"},
            {.name = "velocity", .label = "velocity"},
            {.name = "acceleration", .label = "acceleration"}};
  }
  void write(const Snapshot& at, FieldWriter& to) override {
    put(to, "displacement", [&](size_t i) { return Vec3(at.q.x[i] - X_[i]); });
    put(to, "velocity", [&](size_t i) { return at.v.x[i]; });
    put(to, "acceleration", [&](size_t i) { return at.a.x[i]; });
  }

 private:
  template <class Value>
  void put(FieldWriter& to, const char* name, Value value) const {
    if (!to.wants(name)) return;
    std::vector<double> local;
    local.reserve(3 * X_.size());
    for (size_t i = 0; i < X_.size(); ++i) {
      const Vec3 v = value(i);
      local.insert(local.end(), v.data(), v.data() + 3);
    }
    to.nodes(name, local, 3);
  }
  const std::vector<Vec3>& X_;
};

}  // namespace

std::unique_ptr<FieldSource> motion_fields(const System& system, const std::vector<std::int64_t>&) {
  return std::make_unique<MotionFields>(system);
}

}  // namespace hilo
