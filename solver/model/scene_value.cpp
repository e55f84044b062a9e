// SPDX-License-Identifier: GPL-3.0-or-later
// One value of the scene: type, range, length and unit.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "model/scene_read.hpp"

namespace hilo {
namespace {

/// Everything a message about a value needs.
struct Reading {
  std::string_view section;
  const Param& param;
  const Item& item;
  const std::string& label;
  const Surroundings& around;
  const Surroundings::Known& known;

  [[noreturn]] void fail(const Place& place, const std::string& what, const std::string& hint = "") const {
    throw Error(place.text(), label.empty() ? what : label + ": " + what, hint);
  }
  [[noreturn]] void wrong_type(const toml::node& node, std::string_view expected) const {
    std::string hint(param.meaning);
    if (!param.unit.empty() && param.unit != "1") hint = fmt::format("in {} of the system {}, without the unit", param.unit, around.units);
    fail(node.source().path ? place_of_node(node) : item.place, fmt::format("{} is {}, not {}", item.key, type_word(node), expected), hint);
  }
};

bool is_whole(const Param& p) { return p.key == "steps" || p.key == "iterations" || p.key == "cuts" || p.key == "subdomains"; }

/// Sizes whose squares and products a double still holds.  What must be positive is not below the lower one; anything else may be next to
/// zero.
constexpr double largest = 1e30, smallest = 1e-30;

double read_number(const Reading& r, const toml::node& node) {
  const auto x = node.value<double>();
  if (!x || !node.is_number()) r.wrong_type(node, "a number");
  const double si = *x * *r.known.factor;
  if (!std::isfinite(si)) r.fail(place_of_node(node), fmt::format("{} = {} is not finite", r.item.key, *x));
  if (!r.param.range.contains(si)) {
    const Range& range = r.param.range;
    const bool interval = std::isfinite(range.low) && std::isfinite(range.high);
    r.fail(place_of_node(node), fmt::format("{} = {} {} {}", r.item.key, *x, interval ? "is not in" : "is not", range.text()));
  }
  if (std::abs(si) > largest || (r.param.range.low == 0 && r.param.range.low_open && si < smallest))
    r.fail(place_of_node(node), fmt::format("{} = {} is beyond what can be computed with", r.item.key, *x),
           fmt::format("sizes from {:g} to {:g}{}", smallest, largest,
                       r.param.unit.empty() || r.param.unit == "1" ? "" : fmt::format(" {}, in SI units", r.param.unit)));
  if (is_whole(r.param) && si != std::floor(si)) r.fail(place_of_node(node), fmt::format("{} = {} is not a whole number", r.item.key, *x));
  return si;
}

/// How many numbers a list may hold; empty where any number will do.
std::vector<size_t> lengths_of(const Param& p) {
  std::vector<size_t> out;
  for (const unsigned char n : p.counts)
    if (n > 0) out.push_back(n);
  return out;
}

std::vector<double> list_of_numbers(const Reading& r, const std::vector<size_t>& lengths) {
  const auto* list = r.item.node->as_array();
  if (!list) r.wrong_type(*r.item.node, lengths == std::vector<size_t>{3} ? "a list of 3 numbers" : "a list of numbers");
  if (!lengths.empty() && std::find(lengths.begin(), lengths.end(), list->size()) == lengths.end())
    r.fail(r.item.place,
           fmt::format("{} has {} number{}, not {}", r.item.key, list->size(), list->size() == 1 ? "" : "s", fmt::join(lengths, " or ")),
           std::string(r.param.meaning));
  std::vector<double> values;
  for (const auto& x : *list) {
    const size_t per_row = r.param.key == "points" ? 3 : r.param.key == "fibres" ? 2 : 0;  // points may be rows
    const auto* row = per_row > 0 ? x.as_array() : nullptr;
    if (row && row->size() != per_row) r.fail(place_of_node(x), fmt::format("a point of {} numbers, not {}", row->size(), per_row));
    if (per_row == 2 && !row) r.fail(place_of_node(x), "a point is a row of 2 numbers", "fibres = [[0.05, 0.1], [-0.05, 0.1]]");
    for (size_t k = 0; row && k < per_row; ++k) values.push_back(read_number(r, (*row)[k]));
    if (!row) values.push_back(read_number(r, x));
  }
  return values;
}

std::string word(const Reading& r, const toml::node& node) {
  const auto s = node.value<std::string>();
  if (!s || !node.is_string()) r.wrong_type(node, "text");
  const auto& allowed = r.known.choices;
  if (!allowed.empty() && std::find(allowed.begin(), allowed.end(), *s) == allowed.end()) {
    const std::string hint = suggest(*s, allowed);
    r.fail(place_of_node(node), fmt::format("{} = \"{}\" is not known", r.item.key, *s),
           hint.empty() ? fmt::format("one of: {}", fmt::join(allowed, ", ")) : hint);
  }
  return *s;
}

History factor(const Reading& r) {
  const toml::node& node = *r.item.node;
  if (node.is_number()) return {{0}, {read_number(r, node)}};
  if (const auto name = node.value<std::string>(); name && node.is_string()) {
    if (const auto h = r.around.histories.find(*name); h != r.around.histories.end()) return h->second;
    std::vector<std::string> names;
    for (const auto& [key, h] : r.around.histories) names.push_back(key);
    std::string hint = suggest(*name, names);
    if (hint.empty())
      hint = names.empty() ? fmt::format("write [history.{}]", *name) : fmt::format("there are: {}", fmt::join(names, ", "));
    r.fail(r.item.place, fmt::format("no history \"{}\"", *name), hint);
  }
  if (const auto* table = node.as_table()) {
    const std::string owner = r.label + ": history";
    const Place there = place_of_node(node);
    History h = history_of(read_entry("history", *table, "", there, r.around, owner), owner, r.around);
    if (const auto unit = r.around.value_units.find(there.text()); unit != r.around.value_units.end())
      r.around.value_units[r.item.place.text()] = unit->second;
    return h;
  }
  r.wrong_type(node, "a history: a name, a number or a table");
}

}  // namespace

Value read_value(std::string_view section, const Param& param, const Item& item, const std::string& label, const Surroundings& around) {
  Surroundings::Known& known = around.known[&param];
  if (!known.factor) known.factor = to_si(param.unit, around.units), known.choices = choices(section, param.key);
  const Reading r{section, param, item, label, around, known};
  Value v;
  v.place = item.place;
  switch (param.type) {
    case Type::number:
      v.numbers = {read_number(r, *item.node)};
      break;
    case Type::vector3:
      v.numbers = list_of_numbers(r, {3});
      break;
    case Type::numbers:
      if (const auto n = lengths_of(param); item.node->is_number() && std::find(n.begin(), n.end(), 1u) != n.end())
        v.numbers = {read_number(r, *item.node)};
      else
        v.numbers = list_of_numbers(r, n);
      break;
    case Type::text:
      v.texts = {word(r, *item.node)};
      break;
    case Type::boolean:
      if (!item.node->is_boolean()) r.wrong_type(*item.node, "true or false");
      v.boolean = item.node->value<bool>();
      break;
    case Type::texts:
      if (const auto* list = item.node->as_array())
        for (const auto& x : *list) v.texts.push_back(word(r, x));
      else
        v.texts = {word(r, *item.node)};
      if (v.texts.empty()) r.fail(item.place, fmt::format("{} is an empty list", item.key), std::string(param.meaning));
      break;
    case Type::history:
      v.history = factor(r);
      if (item.node->is_string()) v.texts = {*item.node->value<std::string>()};
      break;
  }
  return v;
}

Value default_value(const Param& param) {
  Value v;
  if (param.type == Type::text) {
    v.texts = {std::string(param.fallback)};
  } else {
    const toml::table t = toml::parse(fmt::format("x = {}", param.fallback), std::string_view("default"));
    v = read_value("", param, {std::string(param.key), {"default", 0, 0}, t.get("x")}, "", {});
  }
  v.given = false;
  return v;
}

}  // namespace hilo
