// SPDX-License-Identifier: GPL-3.0-or-later
#include "tag/savings.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "model/mesh_tags.hpp"

namespace hilo {

std::vector<Fidelity> all_tagged(const Mesh& mesh, const std::vector<ThinRegion>& thin_regions,
                                 const std::vector<std::optional<Fidelity>>& tags) {
  std::vector<Fidelity> fidelity;
  std::vector<std::string> untagged;
  for (size_t r = 0; r < tags.size(); ++r) {
    const bool thin = !thin_regions.empty() && thin_regions[r].any();
    if (thin && tags[r] && *tags[r] != Fidelity::rigid)
      throw Error("",
                  fmt::format("region \"{}\" has shells or beams: there is no element of them, it can be rigid alone, not {}",
                              mesh.region_name[r], word(*tags[r])),
                  fmt::format("--rigid '{}'", mesh.region_name[r]));
    fidelity.push_back(tags[r].value_or(thin ? Fidelity::rigid : Fidelity::nonlinear));
    if (!tags[r] && thin && !is_quiet())
      fmt::print(stderr, "{}: region \"{}\" has shells or beams, so it is rigid\n", tool_name(), mesh.region_name[r]);
    else if (!tags[r])
      untagged.push_back(mesh.region_name[r]);
  }
  if (!untagged.empty() && !is_quiet()) {
    const size_t shown = std::min<size_t>(untagged.size(), 8);
    fmt::print(stderr, "{}: {} of {} regions not tagged, so nonlinear: {}{}\n", tool_name(), untagged.size(), tags.size(),
               fmt::join(untagged.begin(), untagged.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
               shown < untagged.size() ? ", ..." : "");
  }
  return fidelity;
}

Savings savings(const Mesh& mesh, const std::vector<Fidelity>& fidelity) {
  const size_t n = fidelity.size();
  const auto body = body_of_region(mesh, fidelity);
  std::vector<std::int64_t> cells(n, 0), nodes(n, 0), before(n, 0), after(n, 0);
  std::vector<int> first(mesh.X.size(), -1), first_flexible(mesh.X.size(), -1), seen(mesh.X.size(), -1);
  std::vector<char> follows(mesh.X.size(), 0);  // a rigid or linear region
  std::vector<std::vector<std::int64_t>> cells_of(n);
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c) cells_of[mesh.region[c]].push_back(c);
  for (size_t r = 0; r < n; ++r) {
    const int region = static_cast<int>(r);
    cells[r] = static_cast<std::int64_t>(cells_of[r].size());
    for (const auto c : cells_of[r])
      for (const auto a : mesh.cell(c)) {
        if (seen[a] != region) seen[a] = region, ++nodes[r];
        if (first[a] < 0) first[a] = region;
        if (fidelity[r] != Fidelity::nonlinear)
          follows[a] = 1;
        else if (first_flexible[a] < 0)
          first_flexible[a] = region;
      }
  }
  for (size_t a = 0; a < mesh.X.size(); ++a) {
    if (first[a] >= 0) before[first[a]] += 3;
    if (first_flexible[a] >= 0 && !follows[a]) after[first_flexible[a]] += 3;
  }
  Savings s{{{"region", "cells", "nodes", "fidelity", "body", "before", "after"}, {}}};
  std::vector<char> counted(n, 0);
  for (size_t r = 0; r < n; ++r) {
    if (body[r] >= 0 && cells[r] > 0 && !counted[body[r]]) after[r] = 6, counted[body[r]] = 1, ++s.bodies;
    if (fidelity[r] == Fidelity::linear && cells[r] > 0) after[r] = 6, ++s.linear;
    s.before += before[r], s.after += after[r];
    s.regions.rows.push_back({mesh.region_name[r], fmt::format("{}", cells[r]), fmt::format("{}", nodes[r]), std::string(word(fidelity[r])),
                              body[r] < 0 ? "-" : fmt::format("{}", body[r] + 1), fmt::format("{}", before[r]),
                              fmt::format("{}", after[r])});
  }
  return s;
}

std::string savings_text(const Savings& s) {
  const std::string linear =
      s.linear ? fmt::format("; {} linear region{}, whose modes come on top", s.linear, s.linear == 1 ? "" : "s") : "";
  return fmt::format("{}\nunknowns: {} if all were nonlinear, {} as tagged ({:.1f} %); {} rigid bod{}{}\n", s.regions.text(), s.before,
                     s.after, s.before ? 100. * static_cast<double>(s.after) / static_cast<double>(s.before) : 100., s.bodies,
                     s.bodies == 1 ? "y" : "ies", linear);
}

std::string savings_json(const Savings& s, const std::string& output) {
  Json out = Json::object(Json::In::lines);
  out.add("output", output.empty() ? Json(nullptr) : output);
  out.add("unknowns", {{"before", s.before}, {"after", s.after}});
  out.add("bodies", s.bodies);
  out.add("regions", s.regions.json());
  return out.text() + "\n";
}

}  // namespace hilo
