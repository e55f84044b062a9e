// SPDX-License-Identifier: GPL-3.0-or-later
#include "part/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace hilo {
namespace {

int sum(const std::vector<int>& list) { return std::accumulate(list.begin(), list.end(), 0); }

Table table_of(const PartReport& r) {
  Table t{{"part", "cells", "nonlinear", "nonlinear work", "other work", "pieces"}, {}, 0};
  for (size_t p = 0; p < r.cells.size(); ++p) {
    std::vector<std::string> row{std::to_string(p)};
    for (const auto* list : {&r.cells, &r.nonlinear_cells, &r.nonlinear_work, &r.other_work}) row.push_back(std::to_string((*list)[p]));
    row.push_back(std::to_string(r.pieces[p]));
    t.rows.push_back(std::move(row));
  }
  return t;
}

std::string line(const std::string& weights, const PartReport& r) {
  return fmt::format(
      "{}: largest divided by mean: {:.3f} nonlinear work, {:.3f} other work (rigid and linear cells); cut {} facets, {} between nonlinear "
      "cells; {} pieces, {} of nonlinear cells\n",
      weights, r.nonlinear_balance, r.other_balance, r.cut, r.nonlinear_cut, sum(r.pieces), sum(r.nonlinear_pieces));
}

Json json_of(const PartReport& r) {
  return {{"nonlinear_balance", {r.nonlinear_balance, 7}},
          {"other_balance", {r.other_balance, 7}},
          {"cut", r.cut},
          {"nonlinear_cut", r.nonlinear_cut},
          {"speed_up", {r.speed_up, 5}},
          {"pieces", sum(r.pieces)},
          {"nonlinear_pieces", sum(r.nonlinear_pieces)}};
}

std::string other_name(const Division& d) { return d.weights == "weighted" ? "uniform" : "weighted"; }

}  // namespace

std::string division_text(const Division& d, const CellGraph& graph) {
  std::string out = table_of(d.report).text() + "\n" + line(d.weights, d.report);
  if (d.other) out += line(other_name(d), *d.other);
  if (graph.joints) out += fmt::format("{} joints and springs weighed in\n", graph.joints);
  return out;
}

std::string division_json(const Division& d, const CellGraph& graph, const std::string& output) {
  Json out = Json::object(Json::In::lines);
  out.add("output", output);
  out.add("n_parts", d.report.cells.size());
  out.add("weights", d.weights);
  out.add("joints", graph.joints);
  out.add(d.weights, json_of(d.report));
  if (d.other) out.add(other_name(d), json_of(*d.other));
  out.add("parts", table_of(d.report).json());
  return out.text() + "\n";
}

Table comparison(const CellGraph& graph, const Mesh& mesh, int most) {
  Table t{{"parts", "uniform work", "uniform speed-up", "weighted work", "weighted speed-up", "other work", "pieces", "nonlinear pieces",
           "cut", "nonlinear cut"},
          {},
          0};
  const auto nonlinear = std::ranges::count(graph.is_nonlinear, 1);
  for (int n = 2; n <= most && n <= (nonlinear ? nonlinear : graph.n()); n *= 2) {
    const PartReport u = report(graph, partition(graph, mesh, n, false), n), w = report(graph, partition(graph, mesh, n, true), n);
    t.rows.push_back({std::to_string(n), fmt::format("{:.3f}", u.nonlinear_balance), fmt::format("{:.2f}", u.speed_up),
                      fmt::format("{:.3f}", w.nonlinear_balance), fmt::format("{:.2f}", w.speed_up), fmt::format("{:.3f}", w.other_balance),
                      std::to_string(sum(w.pieces)), std::to_string(sum(w.nonlinear_pieces)), std::to_string(w.cut),
                      std::to_string(w.nonlinear_cut)});
  }
  return t;
}

std::string csv(const Table& t) {
  std::string out;
  const auto line = [&](const std::vector<std::string>& cells) {
    for (size_t i = 0; i < cells.size(); ++i) out += (i ? "," : "") + cells[i];
    out += '\n';
  };
  line(t.header);
  for (const auto& row : t.rows) line(row);
  return out;
}

std::vector<std::string> doubts(const Division& d) {
  std::vector<std::string> out;
  const auto empty = std::ranges::count(d.report.cells, 0);
  if (empty) out.push_back(fmt::format("{} parts are empty", empty));
  if (d.weights == "weighted" && d.report.nonlinear_balance > 1.3)
    out.push_back(fmt::format("the heaviest part has {:.2f} times the mean nonlinear work; fewer parts would serve as well",
                              d.report.nonlinear_balance));
  return out;
}

}  // namespace hilo
