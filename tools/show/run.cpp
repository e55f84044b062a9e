// SPDX-License-Identifier: GPL-3.0-or-later
// Results in a summary.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "show/summary.hpp"

namespace hilo {
namespace {

Table bodies(const Store& store) {
  Table t{{"body", "mass [kg]", "J1 [kg m^2]", "J2 [kg m^2]", "J3 [kg m^2]", "x [m]", "y [m]", "z [m]", "nodes"}, {}, 1, 6};
  if (!store.has("/body/name")) return t;
  const auto names = store.read_strings("/body/name");
  const auto mass = store.read<double>("/body/mass"), inertia = store.read<double>("/body/inertia");
  std::vector<double> points;  // the first of four is the centre of mass
  if (store.has("/body/points")) points = store.read<double>("/body/points");
  std::vector<std::int64_t> followers(names.size(), 0);
  if (store.has("/body/follower_body"))
    for (const auto b : store.read<std::int32_t>("/body/follower_body"))
      if (b >= 0 && b < static_cast<std::int32_t>(names.size())) ++followers[b];
  for (size_t b = 0; b < names.size() && b < mass.size() && 3 * b + 2 < inertia.size(); ++b) {
    std::vector<std::string> row{names[b], fmt::format("{}", mass[b])};
    for (size_t k = 0; k < 3; ++k) row.push_back(fmt::format("{}", inertia[3 * b + k]));
    for (size_t k = 0; k < 3; ++k) row.push_back(12 * b + k < points.size() ? fmt::format("{}", points[12 * b + k]) : "-");
    row.push_back(std::to_string(followers[b]));
    t.rows.push_back(std::move(row));
  }
  return t;
}

void add_history(Table& t, const Store& store, const std::string& array, const std::string& name) {
  const auto shape = store.shape(array);
  double largest = 0;
  std::int64_t columns = 1;
  for (size_t k = 1; k < shape.size(); ++k) columns *= shape[k];
  for (std::int64_t at = 0, step = std::max<std::int64_t>(1, 1000000 / std::max<std::int64_t>(1, columns)); at < shape[0]; at += step)
    for (const double x : store.read_rows<double>(array, at, std::min(step, shape[0] - at))) largest = std::max(largest, std::abs(x));
  t.rows.push_back({name, std::to_string(shape[0]), std::to_string(columns), fmt::format("{:.6g}", largest),
                    store.text_attribute(array, "unit").value_or("")});
}

Table histories(const Store& store) {
  Table t{{"history", "rows", "columns", "largest", "unit"}, {}};
  for (const auto& name : store.list("/history")) {
    const std::string path = "/history/" + name;
    if (store.is_array(path))
      add_history(t, store, path, name);
    else
      for (const auto& link : store.list(path)) add_history(t, store, path + "/" + link, name + " " + from_link_name(link));
  }
  return t;
}

Table fields(const Store& store, const std::vector<std::string>& steps) {
  Table t{{"field", "rows", "columns", "unit"}, {}};
  if (steps.empty()) return t;
  const std::string group = "/field/" + steps.back();
  for (const auto& name : store.list(group)) {
    const auto shape = store.shape(group + "/" + name);
    t.rows.push_back({name, std::to_string(shape.empty() ? 1 : shape[0]), std::to_string(shape.size() > 1 ? shape[1] : 1),
                      store.text_attribute(group + "/" + name, "unit").value_or("")});
  }
  return t;
}

}  // namespace

void add_run(Summary& s, const Store& store) {
  const auto steps = store.list("/field");
  s.count("field outputs", static_cast<std::int64_t>(steps.size()));
  if (!steps.empty())
    if (const auto a = store.number_attribute("/field/" + steps.front(), "t"), b = store.number_attribute("/field/" + steps.back(), "t");
        a && b)
      s.measure("first field at t [s]", *a), s.measure("last field at t [s]", *b);
  if (store.has("/history/t"))
    if (const auto n = store.shape("/history/t")[0]; n > 0) {
      s.count("history rows", n);
      s.measure("history begins at t [s]", store.read_rows<double>("/history/t", 0, 1)[0]);
      s.measure("history ends at t [s]", store.read_rows<double>("/history/t", n - 1, 1)[0]);
    }
  if (store.has("/scene")) s.count("scene lines", std::ranges::count(store.read_text("/scene"), '\n'));
  s.list("bodies", bodies(store));
  s.list("fields", fields(store, steps));
  s.list("histories", histories(store));
}

}  // namespace hilo
