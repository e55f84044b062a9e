// SPDX-License-Identifier: GPL-3.0-or-later
// The table of what was imported.
#include "base/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "base/outside_shapes.hpp"
#include "import/imported.hpp"
#include "model/scaled_jacobian.hpp"

namespace hilo {
namespace {

struct RegionRow {
  std::int64_t cells = 0;
  std::array<std::int64_t, most_shapes> by_shape{};
  double volume = 0, length = 0, area = 0, worst = std::numeric_limits<double>::infinity(), sum = 0;
  std::int64_t judged = 0;  // cells with a Jacobian: not the bars
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
};

std::vector<RegionRow> rows_of(const Mesh& m) {
  std::vector<RegionRow> rows(m.region_name.size());
  for (std::int64_t c = 0; c < m.n_cells(); ++c) {
    auto& r = rows[m.region[c]];
    ++r.cells;
    ++r.by_shape[m.shape[c]];
    const auto q = quality(m, c);
    if (info(m.shape[c]).dimension == 3) {
      r.volume += q.volume;
      const double j = scaled_jacobian(m, c);
      r.worst = std::min(r.worst, j);
      r.sum += j;
      ++r.judged;
    } else if (info(m.shape[c]).dimension == 2)
      r.area += q.volume;
    else
      r.length += q.volume;
    for (const auto a : m.cell(c)) r.low = r.low.cwiseMin(m.X[a]), r.high = r.high.cwiseMax(m.X[a]);
  }
  return rows;
}

std::string shapes(const RegionRow& r) {
  std::string s;
  for (int i = 0; i < most_shapes; ++i)
    if (r.by_shape[i]) s += fmt::format("{}{} {}", s.empty() ? "" : ", ", r.by_shape[i], info(static_cast<Shape>(i)).name);
  return s;
}

struct SetRow {
  std::string name, kind;
  size_t count;
};
std::vector<SetRow> sets_of(const Mesh& m) {
  std::vector<SetRow> rows;
  for (const auto& [name, s] : m.cell_sets) rows.push_back({name, "cells", s.size()});
  for (const auto& [name, s] : m.facet_sets) rows.push_back({name, "facets", s.size()});
  for (const auto& [name, s] : m.node_sets) rows.push_back({name, "nodes", s.size()});
  return rows;
}

}  // namespace

std::string import_table(const Imported& in, const std::vector<std::string>& scenes) {
  const Mesh& m = in.mesh;
  const auto rows = rows_of(m);
  Table lines{{"region", "cells", "volume [m^3]", "x from [m]", "to", "y from", "to", "z from", "to", "quality min", "mean", "shapes"}, {}};
  double volume = 0;
  const auto g = [](double x) { return fmt::format("{:.5g}", x == 0 ? 0.0 : x); };
  for (size_t i = 0; i < rows.size(); ++i) {
    const auto& r = rows[i];
    const double thin = in.thin_regions.empty() ? 0 : in.thin_regions[i].volume();
    volume += r.volume + thin;
    const bool bars = r.judged == 0;
    lines.rows.push_back({m.region_name[i], fmt::format("{}", r.cells),
                          thin > 0 || !bars ? g(r.volume + thin) : fmt::format("{} m", g(r.length)), g(r.low.x()), g(r.high.x()),
                          g(r.low.y()), g(r.high.y()), g(r.low.z()), g(r.high.z()), bars ? "-" : fmt::format("{:.3f}", r.worst),
                          bars ? "-" : fmt::format("{:.3f}", r.sum / static_cast<double>(r.judged)), shapes(r)});
  }
  std::string text = lines.text();
  text += fmt::format("{} regions, {} cells, {} nodes, volume {} m^3 (quality: scaled Jacobian, 1 for a regular cell)\n", rows.size(),
                      m.n_cells(), m.n_nodes(), g(volume));
  const auto sets = sets_of(m);
  if (!sets.empty()) {
    Table l{{"set", "of", "count"}, {}};
    for (const auto& s : sets) l.rows.push_back({s.name, s.kind, fmt::format("{}", s.count)});
    text += '\n';
    text += l.text();
  }
  if (!in.cases.empty()) {
    Table l{{"subcase", "scene", "loads", "motions", "left out", "title"}, {}};
    for (size_t i = 0; i < in.cases.size(); ++i) {
      const DeckCase& c = in.cases[i];
      const auto lost = std::ranges::count_if(c.not_read, [](const NotRead& n) { return !loss_of(n).empty(); });
      l.rows.push_back({fmt::format("{}", c.number), i < scenes.size() && !scenes[i].empty() ? scenes[i] : "-",
                        fmt::format("{}", c.scene.count("load")), fmt::format("{}", c.scene.count("motion")), fmt::format("{}", lost),
                        c.title});
    }
    text += '\n';
    text += l.text();
  }
  return text;
}

std::string import_json(const Imported& in, const std::string& file, const std::string& output, const std::vector<std::string>& scenes) {
  const Mesh& m = in.mesh;
  constexpr auto lines = Json::In::lines;
  Json out = Json::object(lines), regions = Json::list(lines), cases = Json::list(lines);
  const auto rows = rows_of(m);
  for (size_t i = 0; i < rows.size(); ++i) {
    const auto& r = rows[i];
    Json by = Json::object();
    for (int k = 0; k < most_shapes; ++k)
      if (r.by_shape[k]) by.add(info(static_cast<Shape>(k)).name, r.by_shape[k]);
    regions.append({{"name", m.region_name[i]},
                    {"cells", r.cells},
                    {"shapes", std::move(by)},
                    {"volume", r.volume},
                    {"length", r.length},
                    {"box", Json::list_of(std::array{r.low, r.high}, [](const Vec3& x) { return Json::list_of(x); })},
                    {"quality_min", r.judged ? Json(r.worst) : nullptr},
                    {"quality_mean", r.judged ? Json(r.sum / static_cast<double>(r.judged)) : nullptr}});
  }
  for (size_t i = 0; i < in.cases.size(); ++i)
    cases.append({{"number", in.cases[i].number},
                  {"title", in.cases[i].title},
                  {"scene", i < scenes.size() && !scenes[i].empty() ? Json(scenes[i]) : nullptr}});
  out.add("file", file), out.add("mesh", output), out.add("nodes", m.n_nodes()), out.add("cells", m.n_cells());
  out.add("regions", std::move(regions));
  out.add("sets", Json::list_of(
                      sets_of(m),
                      [](const auto& s) -> Json {
                        return {{"name", s.name}, {"kind", s.kind}, {"count", s.count}};
                      },
                      lines));
  if (!in.cases.empty()) out.add("subcases", std::move(cases));
  out.add("notes", Json::list_of(in.notes, {}, lines));
  out.add("not_read", Json::list_of(
                          in.not_read,
                          [](const NotRead& n) -> Json {
                            return {{"what", n.what}, {"count", n.count}, {"place", n.place}, {"output", n.output}, {"loss", loss_of(n)}};
                          },
                          lines));
  return out.text() + "\n";
}

}  // namespace hilo
