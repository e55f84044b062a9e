// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/integrator_kinds.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "base/error.hpp"
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

void warn_of_idle_keys(const Entry& time) {
  const IntegratorWords& method = integrator_words().at(time.text("integrator"), time.where("integrator"));
  const auto has = [](const IntegratorWords& m, std::string_view key) {
    return std::any_of(m.keys.begin(), m.keys.end(), [&](const Param& p) { return p.key == key; });
  };
  std::map<std::string_view, std::vector<std::string_view>> idle;  // by key: the methods that it is for
  for (const IntegratorWords& other : integrator_words())
    for (const Param& p : other.keys)
      if (time.given(p.key) && !has(method, p.key)) idle[p.key].push_back(other.name);
  for (const auto& [key, who] : idle)
    warn(time.where(key), fmt::format("{} has no effect with {}, it is for {}", key, method.name, fmt::join(who, ", ")));
}

std::unique_ptr<Integrator> make_integrator(const Entry& time) { return integrator_kind(time).make(time); }

}  // namespace hilo
