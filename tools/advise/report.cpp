// SPDX-License-Identifier: GPL-3.0-or-later
#include "advise/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "post/files/csv.hpp"

namespace hilo {
namespace {

std::string number(double x, int digits = 6) { return std::isfinite(x) ? fmt::format("{:.{}g}", x + 0.0, digits) : "-"; }  // no -0

std::string choice(const Candidate* c, const Advice& a) {
  return c == a.chosen ? "chosen" : c == a.reference ? "reference" : c == a.base ? "base" : "-";
}

const Candidate* all_rigid(const Advice& a) {
  const auto found = std::find_if(a.tried.begin(), a.tried.end(), [](const Candidate* c) {
    return c->failure.empty() && std::all_of(c->levels.begin(), c->levels.end(), [](Level l) { return l == Level::rigid; });
  });
  return found == a.tried.end() ? nullptr : *found;
}

/// Of each quantity: its value by the chosen model, what is allowed, and the parts of the error: what the levels change (to the base,
/// and from there to the reference), what is in doubt of the reference (its sign is not known), the time step, modes left out and the mesh.
Table budget(const Advice& a) {
  Table t{{"quantity", "unit", "value", "allowed", "levels", "linear strains", "in doubt", "step", "modes", "mesh", "sum over allowed",
           "all rigid"},
          {},
          2,
          4};
  const Candidate* rigid = all_rigid(a);
  for (size_t k = 0; k < a.base->values.size(); ++k) {
    const QuantityValue &mine = a.chosen->values[k], &base = a.base->values[k], &its = a.reference->values[k];
    const double levels = mine.value - base.value, strains = base.value - its.value, step = -a.step[k];
    const double modes = a.modes.empty() ? 0 : -a.modes[k], mesh = a.mesh.empty() ? 0 : -a.mesh[k];
    const double doubt = a.doubt * a.tightest * std::abs(its.value);
    const double sum = a.with_step(mine.value - its.value, k) + doubt + std::abs(modes) + std::abs(mesh);
    t.rows.push_back({mine.name, mine.unit, number(mine.value), number(its.allowed), number(levels),
                      a.reference == a.base ? "-" : number(strains), number(doubt), number(step), a.modes.empty() ? "-" : number(modes),
                      a.mesh.empty() ? "-" : number(mesh), number(sum / its.allowed),
                      rigid ? number(rigid->values[k].value - its.value) : "-"});
  }
  return t;
}

Table regions(const Candidates& all, const Advice& a) {
  Table t{{"region", "level", "reference", "strain energy [J]", "rigid instead: error over allowed", "why"}, {}, 3, 4};
  for (size_t r = 0; r < all.names().size(); ++r) {
    const auto energy = a.base->energy.find(r);
    const auto without = a.without.find(r);
    const auto kept = a.kept_rigid.find(r);
    const double error = without == a.without.end() ? HUGE_VAL : difference(*without->second, *a.reference);
    t.rows.push_back({all.names()[r], std::string(word(a.chosen->levels[r])), std::string(word(a.reference->levels[r])),
                      energy == a.base->energy.end() ? "-" : number(energy->second), number(error),
                      kept != a.kept_rigid.end()                                        ? kept->second
                      : without != a.without.end() && !without->second->failure.empty() ? "does not run rigid: " + without->second->failure
                      : without != a.without.end() && without->second->ended > 0
                          ? fmt::format("as far as its run went, {:.4g} s", without->second->ended)
                          : "-"});
  }
  return t;
}

/// The smallest first, in the same order in every call.
std::vector<const Candidate*> by_unknowns(const Advice& a) {
  auto out = a.tried;
  if (a.reference->step != 1) out.push_back(a.reference);
  std::stable_sort(out.begin(), out.end(), [](const Candidate* x, const Candidate* y) {
    return std::tuple(x->unknowns, x->levels, x->end, x->modes) < std::tuple(y->unknowns, y->levels, y->end, y->modes);
  });
  return out;
}

Table models(const Candidates& all, const Advice& a) {
  Table t{{"model", "choice", "largest in", "run", "error over allowed", "unknowns", "s"}, {}, 4, 4};
  for (const Candidate* c : by_unknowns(a)) {
    std::string in = "-";
    const double d = difference(*c, *a.reference, &in);
    if (!c->failure.empty()) in = "does not run: " + c->failure;
    t.rows.push_back({label(c->levels, all.names()) + (c->modes != 1 ? fmt::format(", {} times the modes", c->modes) : "") +
                          (c->step != 1 ? ", by twice the step" : "") +
                          (c->ended > 0 ? fmt::format(", ended at {:.4g} s", c->ended)
                           : c->end > 0 ? fmt::format(", to {:.4g} s", c->end)
                                        : ""),
                      choice(c, a), c == a.reference ? "-" : in, c->failure.empty() ? c->run : "-", number(d), number(c->unknowns),
                      c->failure.empty() ? number(c->cost, 4) : "-"});
  }
  return t;
}

/// Is it always a raw acceleration that smaller models than the chosen one lose?
std::string told_of_raw(const Advice& a) {
  const QuantityValue* lost = nullptr;
  for (const Candidate* c : a.tried) {
    std::string in;
    if (!c->failure.empty() || c->unknowns >= a.chosen->unknowns || difference(*c, *a.reference, &in) <= 1) continue;
    const auto& values = a.reference->values;
    const auto found = std::find_if(values.begin(), values.end(), [&](const QuantityValue& v) { return v.name == in; });
    if (found == values.end() || found->measured != Measured::raw_acceleration || (lost && lost != &*found)) return "";
    lost = &*found;
  }
  return lost ? fmt::format("; smaller models lose \"{}\" alone: a raw acceleration holds all frequencies (give it a cfc)", lost->name)
              : "";
}

std::string what_is_known(const Candidates& all, const Advice& a) {
  std::string modes;
  if (a.modes.empty() && a.modes_at_most > 0 && a.modes_at_most < 1)
    modes = fmt::format("; what its modes lack of the strain may change {:.2g} of it", a.modes_at_most);
  else if (a.modes.empty() && a.modes_at_most == 0 &&
           std::ranges::count(a.chosen->levels, Level::rigid) + std::ranges::count(a.chosen->levels, Level::nonlinear) <
               std::ssize(a.chosen->levels))
    modes = "; linear strains hold what modes leave out";
  std::string mesh = a.mesh.empty() ? "; the error of the mesh is unknown (--finer)" : "";
  for (size_t k = 0; k < a.mesh.size(); ++k)
    if (const QuantityValue& v = a.reference->values[k]; std::abs(a.mesh[k]) > v.allowed)
      mesh += fmt::format("; the mesh alone makes {:.3g} {} of \"{}\", of {:.3g} {} allowed", std::abs(a.mesh[k]), v.unit, v.name,
                          v.allowed, v.unit);
  constexpr double much = 0.05;  // as in the solver
  const std::string positions = a.positions_off > much ? fmt::format(
                                                             "; positions of it are off by about {:.2g} % of the motion, by the solver's "
                                                             "estimate: a shorter time.step, where they are asked for",
                                                             100 * a.positions_off)
                                                       : "";
  return fmt::format(
      "judged by {}{}; what linear strains leave out of it may be {:.2g} of the tightest tolerance, by their own measures{}{}",
      label(a.reference->levels, all.names()), a.reference->step != 1 ? ", by what it changes at twice the step" : "", a.doubt,
      a.doubt > 0.5 ? ": more than half, and nothing checked it" : "", modes + told_of_raw(a) + mesh + positions);
}

/// What the chosen model saves of a run of all cells.
std::string saving(const Advice& a) {
  const double ratio = a.all_cells / a.chosen->cost;
  if (std::ranges::all_of(a.chosen->levels, [](Level l) { return l == Level::nonlinear; })) return "all of them cells";
  return fmt::format("a run of all cells takes about {:.3g} s: {}", a.all_cells,
                     about_as_long(a.all_cells, a.chosen->cost) ? "about the same"
                     : ratio > 1                                ? fmt::format("{:.3g} times cheaper", ratio)
                                                                : fmt::format("{:.3g} times dearer", 1 / ratio));
}

}  // namespace

std::string report_text(const Candidates& all, const Advice& a) {
  Table shown = models(all, a);
  for (auto& row : shown.rows) row.erase(row.begin() + 3);
  shown.header.erase(shown.header.begin() + 3), shown.n_text = 3;
  return fmt::format("{}\n{}\n{}\nchosen: {}; {:.3g} s, {}\n{}; runs so far {:.3g} s\n", budget(a).text(), regions(all, a).text(),
                     shown.text(), label(a.chosen->levels, all.names()), a.chosen->cost, saving(a), what_is_known(all, a), all.spent());
}

std::string report_json(const Candidates& all, const Advice& a) {
  double step = 0;
  for (size_t k = 0; k < a.step.size(); ++k) step = std::max(step, std::abs(a.step[k]) / a.reference->values[k].allowed);
  Json out = Json::object(Json::In::lines);
  out.add("step_over_allowed", step);
  out.add("doubt_over_allowed", a.doubt);
  out.add("modes_at_most_over_allowed", a.modes_at_most);
  out.add("positions_off", std::isfinite(a.positions_off) ? Json(a.positions_off, 6) : nullptr);
  out.add("checked", a.reference != a.base);
  out.add("all_cells_seconds", a.all_cells);
  out.add("spent_seconds", all.spent());
  out.add("quantities", budget(a).json());
  out.add("regions", regions(all, a).json());
  out.add("models", models(all, a).json());
  return out.text() + "\n";
}

std::string models_csv(const Candidates& all, const Advice& a) {
  std::map<double, std::string> rows;  // by cost
  for (const Candidate* c : a.tried) {
    const double d = difference(*c, *a.reference);
    if (c != a.reference && std::isfinite(d))
      rows[c->cost] = fmt::format("{:.4g},{:.4g},{},{}\n", c->cost, d, c == a.chosen ? "chosen" : "other models",
                                  csv_cell(label(c->levels, all.names())));
  }
  std::string out = "processor time [s],error over allowed,choice,model\n";
  for (const auto& [cost, row] : rows) out += row;
  return out;
}

std::string regions_csv(const Candidates& all, const Advice& a) {
  std::string out = "region,if rigid: error/allowed\n";
  for (const auto& [r, c] : a.without)
    if (const double d = difference(*c, *a.reference); std::isfinite(d)) out += fmt::format("{},{:.4g}\n", csv_cell(all.names()[r]), d);
  return out;
}

std::string rules(const Candidates& all, const Advice& a, const std::string& command) {
  std::string text = fmt::format("# {}\n", command);
  for (const Fidelity f : {Fidelity::rigid, Fidelity::linear, Fidelity::nonlinear}) {
    std::string list;
    for (size_t r = 0; r < all.names().size(); ++r)
      if (!all.is_beam(r) && fidelity(a.chosen->levels[r]) == f) list += (list.empty() ? "" : ", ") + json_text(all.names()[r]);
    if (!list.empty()) text += fmt::format("{} = [{}]\n", word(f), list);
  }
  for (size_t r = 0; r < all.names().size(); ++r) {
    if (all.is_beam(r)) text += fmt::format("# in the scene: [{}] fidelity = \"{}\"\n", all.table(r), word(a.chosen->levels[r]));
    if (a.chosen->levels[r] == Level::stiffening) text += fmt::format("# in the scene: [{}] stiffening = true\n", all.table(r));
    if (a.chosen->modes_in(r) == 1 || fidelity(a.chosen->levels[r]) != Fidelity::linear) continue;
    const auto [most, up_to] = all.modes_of(r, a.chosen->modes_in(r));
    text += fmt::format("# in the scene: [{}] modes = {}, up_to = {:.6g}\n", all.table(r), most, all.written("Hz", up_to));
  }
  return text;
}

}  // namespace hilo
