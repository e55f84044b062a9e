// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/quantity_schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "base/keys.hpp"
#include "base/units.hpp"
#include "model/scene_read.hpp"

namespace hilo {
namespace {

using enum Type;

constexpr const char* sources[] = {"joint", "stress", "sensor", "between", "formula"};

std::vector<std::string> components_of(const Entry& q) {
  if (q.has("joint")) return {"force", "moment", "Fx", "Fy", "Fz", "Mx", "My", "Mz"};
  if (q.has("sensor")) return {"resultant", "x", "y", "z"};
  return {};
}

[[noreturn]] void fail_quantity(const Entry& q, std::string_view key, const std::string& what, const std::string& hint = "") {
  throw Error(q.where(key), q.label() + ": " + what, hint);
}

void check_name(const Entry& q, std::string_view key, const std::string& name, std::string_view what,
                const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  std::string hint = suggest(name, names);
  if (hint.empty()) hint = names.empty() ? fmt::format("the scene has no {}", what) : fmt::format("there are: {}", fmt::join(names, ", "));
  fail_quantity(q, key, fmt::format("no {} \"{}\"", what, name), hint);
}

/// "label [unit] = formula": its unit, "1" without one.
std::string unit_of_formula(const Entry& q) {
  const std::string& text = q.text("formula");
  const auto equals = text.find('=');
  if (equals == text.npos) fail_quantity(q, "formula", "no = in it", "NAME [UNIT] = FORMULA, as in hilo-post series");
  const std::string unit = unit_in_heading(text.substr(0, equals));
  return unit.empty() ? "1" : unit;
}

}  // namespace

std::vector<KindSchema> quantity_schema() {
  const std::vector<Param> first{{"kind", text, "", "!", "the kind of quantity"}, keys::name};
  const Param tolerance{"tolerance", text, "", "", "how far it may be off: \"2%\" of it, or with a unit, \"50 N\""};
  const Param cfc{"cfc", number, "", "", "of a sensor: channel frequency class of its filter; absent: raw", above(0)};
  const std::vector<Param> source{
      {"joint", text, "", "", "of the reaction of this joint"},
      {"stress", text, "", "", "of the largest von Mises stress in this region, at the outputs of fields"},
      {"sensor", text, "", "", "of what this sensor felt [g]"},
      {"between", texts, "", "", "of how far the distance of two probes has changed, or that of the third from the line through two"},
      {"formula", text, "", "", "of columns of the histories, as in hilo-post series: \"pull [kN] = joint.pin.Fx/1e3\""},
      {"component", text, "", "", "of a joint force, moment, Fx .. Mz (force); of a sensor resultant, x, y, z (resultant)"},
      cfc};
  const auto kind = [&](std::string_view name, std::string_view meaning, const std::vector<Param>& more) {
    KindSchema k{"quantity", name, meaning, first};
    k.params.insert(k.params.end(), more.begin(), more.end());
    k.params.push_back(tolerance);
    return k;
  };
  std::vector<Param> at{{"t", number, "s", "!", "the time", at_least(0)}};
  at.insert(at.end(), source.begin(), source.end());
  return {kind("peak", "the value largest in size, with its sign", source),
          kind("at", "the value at a time", at),
          kind("rms", "root of the mean square during the run", source),
          kind("injury", "a measure of hilo-post injury",
               {{"sensor", text, "", "!", "what this sensor felt"},
                {"measure", text, "", "!", "DRI, HIC15, clip_3ms, peak_x and the others of hilo-post injury"},
                {"cfc", number, "", "60", "channel frequency class of the pulses", above(0)}}),
          kind("frequency", "a natural frequency, of an analysis of modes",
               {{"mode", number, "", "!", "its number, from 1 on", from_to(1, 1e6)}}),
          kind("load_factor", "a factor of the loads, of an analysis of buckling",
               {{"mode", number, "", "!", "number of the shape, from 1 on", from_to(1, 1e6)}})};
}

QuantityTolerance parse_tolerance(const std::string& text, const std::string& unit, const std::string& where) {
  const auto wrong = [&](const std::string& what) {
    return Error(where, fmt::format("tolerance \"{}\" {}", text, what),
                 unit.empty() ? "\"2%\"" : fmt::format("\"2%\", or with a unit of {}, as \"0.5 {}\"", unit, unit));
  };
  double x = 0;
  const char* end = text.data() + text.size();
  const auto [after, error] = std::from_chars(text.data(), end, x);
  if (error != std::errc() || !std::isfinite(x) || x <= 0) throw wrong("is no positive number");
  std::string word(after, end);
  word.erase(0, std::min(word.find_first_not_of(' '), word.size()));
  if (word == "%") return {x / 100, true};
  if (word.empty() && unit != "1") throw wrong("has no unit");
  if (word == unit || word.empty()) return {x, false};
  const auto have = named_unit(word), want = named_unit(unit);
  if (!have || !want || have->unit != want->unit) throw wrong(fmt::format("is in {}", word));
  return {x * have->si / want->si, false};
}

bool is_of_shapes(const std::string& kind) { return kind == "frequency" || kind == "load_factor"; }

std::optional<std::string> unit_of(const Entry& q) {
  if (q.kind == "load_factor") return "1";
  if (q.kind == "frequency") return "Hz";
  if (q.kind == "injury") return {};
  if (q.has("joint")) return q.has("component") && q.text("component").front() != 'F' && q.text("component") != "force" ? "N m" : "N";
  if (q.has("stress")) return "Pa";
  if (q.has("sensor")) return "g";
  if (q.has("between")) return "m";
  return unit_of_formula(q);
}

void check_quantities(const Entries& entries) {
  const auto found = entries.find("quantity");
  if (found == entries.end()) return;
  const auto names = [&](std::string_view section) {
    std::vector<std::string> out;
    if (const auto e = entries.find(section); e != entries.end())
      for (const Entry& each : e->second) out.push_back(each.name);
    return out;
  };
  for (const Entry& q : found->second) {
    if (q.kind == "peak" || q.kind == "at" || q.kind == "rms") {
      std::vector<std::string> given;
      for (const char* s : sources)
        if (q.has(s)) given.emplace_back(s);
      if (given.size() != 1)
        fail_quantity(q, given.empty() ? "kind" : given[1], given.empty() ? "of what?" : fmt::format("one of {}", fmt::join(given, ", ")),
                      "give one of joint, stress, sensor, between, formula");
    }
    if (q.has("joint")) check_name(q, "joint", q.text("joint"), "joint", names("joint"));
    if (q.has("sensor")) check_name(q, "sensor", q.text("sensor"), "sensor", names("sensor"));
    if (q.has("between")) {
      if (q.texts("between").size() < 2 || q.texts("between").size() > 3)
        fail_quantity(q, "between", fmt::format("{} probes", q.texts("between").size()), "two probes, or three");
      for (const std::string& p : q.texts("between")) check_name(q, "between", p, "probe", names("probe"));
    }
    if (q.has("component")) check_name(q, "component", q.text("component"), "component", components_of(q));
    if (q.has("cfc") && q.given("cfc") && !q.has("sensor")) fail_quantity(q, "cfc", "only what sensors felt is filtered", "give a sensor");
    if (const auto output = entries.find("output"); q.has("stress") && output != entries.end())
      for (const Entry& o : output->second)
        if (const auto& f = o.texts("fields"); std::find(f.begin(), f.end(), "von_mises") == f.end())
          fail_quantity(q, "stress", "the run does not put out von_mises", "add it to output.fields");
    if (q.has("formula")) unit_of_formula(q);
    if (q.has("tolerance")) parse_tolerance(q.text("tolerance"), unit_of(q).value_or(""), q.where("tolerance"));
    if (const auto time = entries.find("time"); q.kind == "at" && time != entries.end())
      for (const Entry& t : time->second)
        if (t.has("end") && q.number("t") > t.number("end"))
          fail_quantity(q, "t", fmt::format("{:g} s is after the end", q.number("t")),
                        fmt::format("the run ends at {:g} s", t.number("end")));
  }
}

void check_quantity_regions(const Scene& scene, const std::vector<std::string>& regions) {
  for (const Entry& q : scene.entries("quantity"))
    if (q.has("stress")) check_name(q, "stress", q.text("stress"), "region", regions);
}

}  // namespace hilo
