#include "dynamics/integrator_kinds.hpp"

#include "dynamics/integrator.hpp"

namespace hilo {

Registry<IntegratorKind>& integrator_kinds() {
  static auto kinds = []<class... M>(Methods<M...>) {
    return Registry<IntegratorKind>("integrator", {integrator_kind_of<M>()...});
  }(Integrators{});
  return kinds;
}

const IntegratorKind& integrator_kind(const Entry& time) {
  return integrator_kinds().at(time.text("integrator"), time.where("integrator"));
}

std::unique_ptr<Integrator> make_integrator(const Entry& time) { return integrator_kind(time).make(time); }

}  // namespace hilo
