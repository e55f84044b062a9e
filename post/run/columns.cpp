// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/run/columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.hpp"
#include "post/run/expression.hpp"

namespace hilo {
namespace {

std::string trimmed_blanks(const std::string& text) {
  const auto from = text.find_first_not_of(' '), to = text.find_last_not_of(' ');
  return from == std::string::npos ? "" : text.substr(from, to - from + 1);
}

/// Resultants of a history: "F" of Fx, Fy and Fz, "M" of Mx, My and Mz; where their columns begin.
std::vector<std::pair<std::string, size_t>> resultants(const Series& what) {
  std::vector<std::pair<std::string, size_t>> found;
  for (size_t c = 0; c + 2 < what.column.size(); ++c)
    for (const char* of : {"F", "M"})
      if (what.column[c] == std::string(of) + "x" && what.column[c + 1] == std::string(of) + "y" &&
          what.column[c + 2] == std::string(of) + "z")
        found.emplace_back(of, c);
  return found;
}

}  // namespace

RunColumns::RunColumns(const RunFile& run, const std::vector<std::string>& lets) : run_(run), known_(run.series_names()) {
  for (const std::string& text : lets) {
    if (text.find('=') == std::string::npos) throw Error("--let", fmt::format("\"{}\" has no =", text), "NAME = FORMULA", Exit::usage);
    Column c = formula(text);
    if (c.label == "t" || c.label == "pi") throw Error("--let", fmt::format("\"{}\" has a meaning already", c.label), "", Exit::usage);
    let_[c.label] = std::move(c);
  }
}

const Series& RunColumns::history(const std::string& name) {
  auto found = read_.find(name);
  if (found == read_.end()) found = read_.emplace(name, run_.series(name)).first;
  return found->second;
}

/// Read once: every file has thousands, and every name that is asked for looks at all of them.
const Series& RunColumns::described(const std::string& name) {
  auto found = described_.find(name);
  if (found == described_.end()) found = described_.emplace(name, run_.describe(name)).first;
  return found->second;
}

Column RunColumns::column(const std::string& name, const Series& what, size_t c) {
  const Series& s = history(name);
  Column p{name + "." + what.column[c], what.unit[c], s.t, {}};
  for (size_t row = 0; row < s.rows(); ++row) p.value.push_back(s.at(row, c));
  return p;
}

Column RunColumns::resultant(const std::string& name, const Series& what, const std::string& of, size_t first) {
  const Series& s = history(name);
  Column p{name + "." + of, what.unit[first], s.t, {}};
  for (size_t row = 0; row < s.rows(); ++row) p.value.push_back(std::hypot(s.at(row, first), s.at(row, first + 1), s.at(row, first + 2)));
  return p;
}

Column RunColumns::named(const std::string& name) {
  if (const auto let = let_.find(name); let != let_.end()) return let->second;
  std::vector<std::string> labels;
  for (const std::string& history : known_) {
    const Series& what = described(history);
    for (size_t c = 0; c < what.column.size(); ++c) {
      labels.push_back(history + "." + what.column[c]);
      if (labels.back() == name) return column(history, what, c);
    }
    for (const auto& [of, first] : resultants(what)) {
      labels.push_back(history + "." + of);
      if (labels.back() == name) return resultant(history, what, of, first);
    }
  }
  for (const auto& [let, value] : let_) labels.push_back(let);
  const std::string hint = suggest(name, labels);
  throw Error(run_.path, fmt::format("no column \"{}\"", name),
              hint.empty() ? "see --list; a name with other signs than letters, digits, _ and dots stands in double quotes" : hint);
}

Column RunColumns::formula(const std::string& text) {
  const auto equals = text.find('=');
  const std::string left = trimmed_blanks(text.substr(0, equals)), right = trimmed_blanks(text.substr(equals + 1));
  const auto bracket = left.ends_with(']') ? left.rfind('[') : std::string::npos;
  Column c{trimmed_blanks(left.substr(0, bracket)), "1", {}, {}};
  if (bracket != std::string::npos) c.unit = left.substr(bracket + 1, left.size() - bracket - 2);
  if (c.label.empty()) throw Error("", fmt::format("\"{}\" gives its column no name", text), "NAME [UNIT] = FORMULA", Exit::usage);
  c.t = run_.store().read<double>("/history/t");
  for (size_t rows = c.t.size();; c.t.resize(rows)) {  // a run in progress may be a row ahead in one array
    c.value = evaluate(right, c.t, [&](const std::string& name) {
      Column found = named(name);
      rows = std::min(rows, found.t.size());
      if (!std::equal(c.t.begin(), c.t.begin() + static_cast<std::ptrdiff_t>(rows), found.t.begin()))
        throw Error(run_.path, fmt::format("\"{}\" has other times than the other histories", name),
                    "the columns of a formula have the same times");
      found.value.resize(c.t.size());
      return found.value;
    });
    if (rows == c.t.size()) break;
  }
  return c;
}

std::vector<Column> RunColumns::pick(const std::vector<std::string>& wanted) {
  std::vector<Column> picked;
  std::set<std::string> have;
  for (const std::string& glob : wanted) {
    if (glob.find('=') != std::string::npos) {
      picked.push_back(formula(glob));
      if (!have.insert(picked.back().label).second)
        throw Error(run_.path, fmt::format("two columns are called \"{}\"", picked.back().label), "give each its own name", Exit::usage);
      continue;
    }
    bool any = false;
    for (const std::string& name : known_) {
      const Series& what = described(name);
      for (size_t c = 0; c < what.column.size(); ++c) {
        const std::string label = name + "." + what.column[c];
        if (!matches(glob, name) && !matches(glob, label)) continue;
        any = true;
        if (have.insert(label).second) picked.push_back(column(name, what, c));
      }
      for (const auto& [of, first] : resultants(what)) {
        if (const std::string label = name + "." + of; !glob.ends_with("." + of) || !matches(glob, label) || !have.insert(label).second)
          continue;
        any = true;
        picked.push_back(resultant(name, what, of, first));
      }
    }
    if (any) continue;
    std::string hint = suggest(glob, known_);
    std::vector<std::string> members;  // of a group, as joint
    for (const std::string& name : known_)
      if (name.starts_with(glob + ".")) members.push_back(name);
    if (constexpr size_t most = 8; !members.empty()) {
      hint =
          fmt::format("\"{}.*\" for all of: {}", glob, fmt::join(members.begin(), members.begin() + std::min(most, members.size()), ", "));
      if (members.size() > most) hint += fmt::format(" ... {} in all", members.size());
    }
    throw Error(run_.path, fmt::format("no history \"{}\"", glob), hint.empty() ? "see --list" : hint);
  }
  return picked;
}

Column RunColumns::one(const std::string& wanted) {
  if (wanted.find('=') != std::string::npos) return formula(wanted);
  return named(wanted);
}

}  // namespace hilo
