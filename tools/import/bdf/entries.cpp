// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/bdf/entries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "base/error.hpp"
#include "base/utf8.hpp"
#include "import/imported.hpp"

namespace hilo {
namespace {

/// Tabs go to the next multiple of eight columns, in free fields they are blanks.
std::string without_tabs(const std::string& text) {
  if (text.find('\t') == std::string::npos) return text;
  std::string out;
  out.reserve(text.size() + text.size() / 4);
  for (const std::string_view l : lines_of(text)) {
    const bool free = l.substr(0, l.find('$')).find(',') != std::string_view::npos;
    const size_t start = out.size();
    for (const char c : l)
      if (c != '\t')
        out += c;
      else
        out.append(free ? 1 : 8 - (out.size() - start) % 8, ' ');
    out += '\n';
  }
  return out;
}

bool starts(std::string_view l, std::string_view word) { return upper(l.substr(0, l.find('$'))).rfind(word, 0) == 0; }

/// Whether executive and case control stand before the bulk entries.
bool has_head(std::string_view text) {
  for (const std::string_view line : lines_of(text)) {
    const auto l = strip(line);
    if (!l.empty() && (l.front() == 'B' || l.front() == 'b') && starts(l, "BEGINBULK")) return true;
    if (!l.empty() && (l.front() == 'C' || l.front() == 'c') && upper(l.substr(0, l.find_first_of(" $\r"))) == "CEND") return true;
  }
  return false;
}

/// The name of a continuation without its sign.
std::string_view bare(std::string_view label) {
  if (!label.empty() && (label.front() == '+' || label.front() == '*')) label.remove_prefix(1);
  return label;
}
/// Columns 2 to 8 of a continuation are columns 74 to 80 of the line it belongs to, whatever stands in column 73; the case does not count.
bool same_label(std::string_view parent, std::string_view child) {
  const std::string p = upper(bare(parent)), c = upper(bare(child));
  return p.empty() || c.empty() || p == c || p.substr(1) == c || upper(parent) == c;
}

}  // namespace

std::string BdfEntries::Line::place() const { return fmt::format("{}:{}", source->path, number); }

BdfEntries::BdfEntries(const std::string& path) {
  open(path, "");
  in_bulk_ = !has_head(stack_.back()->text);
}

void BdfEntries::open(const std::string& path, const std::string& place) {
  auto s = std::make_unique<Source>();
  s->path = path;
  s->text = without_tabs(as_utf8(read_gz(path, place)));
  if (std::string_view(s->text).substr(0, 65536).find('\0') != std::string_view::npos)
    throw Error(place.empty() ? path : place, fmt::format("\"{}\" is not a text file", path), "hilo-import reads Nastran files as text");
  stack_.push_back(s.get());
  kept_.push_back(std::move(s));
}

bool BdfEntries::physical(Line& l) {
  while (!stack_.empty()) {
    Source& s = *stack_.back();
    if (s.at >= s.text.size()) {
      stack_.pop_back();
      continue;
    }
    const size_t end = std::min(s.text.find('\n', s.at), s.text.size());
    l.text = std::string_view(s.text).substr(s.at, end - s.at);
    s.at = end + 1;
    l.source = &s, l.number = ++s.line;
    if (!l.text.empty() && l.text.back() == '\r') l.text.remove_suffix(1);
    return true;
  }
  return false;
}

/// The name may go on over several lines between its quotes.
void BdfEntries::include(const Line& l) {
  namespace fs = std::filesystem;
  std::string name(strip(strip(l.text).substr(7)));
  if (!name.empty() && name.front() == '=') name = strip(std::string_view(name).substr(1));
  if (!name.empty() && (name.front() == '\'' || name.front() == '"')) {
    const char quote = name.front();
    Line more;
    while (name.find(quote, 1) == std::string::npos && name.size() < 4096 && stack_.back() == l.source && physical(more))
      name += strip(more.text);
    const size_t end = name.find(quote, 1);
    if (end == std::string::npos) throw Error(l.place(), "INCLUDE: the quote is not closed");
    name = name.substr(1, end - 1);
  } else
    name = strip(std::string_view(name).substr(0, name.find('$')));
  if (name.empty()) throw Error(l.place(), "INCLUDE names no file");
  std::replace(name.begin(), name.end(), '\\', '/');
  const fs::path p = fs::path(name).is_absolute() ? fs::path(name) : fs::path(l.source->path).parent_path() / name;
  std::error_code ignored;
  for (const Source* s : stack_)
    if (fs::equivalent(s->path, p, ignored))
      throw Error(l.place(), fmt::format("INCLUDE of \"{}\", which is being read", name), "a file cannot include itself");
  if (stack_.size() > 100) throw Error(l.place(), fmt::format("INCLUDE nested more than 100 deep at \"{}\"", name));
  open(p.lexically_normal().string(), l.place());
}

bool BdfEntries::line(Line& l) {
  while (physical(l)) {
    const auto text = strip(l.text);
    if (text.size() > 7 && (text.front() == 'I' || text.front() == 'i') && upper(text.substr(0, 7)) == "INCLUDE" &&
        std::string_view(" '\"=").find(text[7]) != std::string_view::npos) {
      include(l);
      continue;
    }
    return true;
  }
  return false;
}

void BdfEntries::comment(std::string_view l) {  // names that pre-processors leave: $HMNAME PROP 3"hull"
  const std::string s(l);
  int id;
  char name[200];
  if (std::sscanf(s.c_str(), "$HMNAME PROP %d\"%199[^\"]", &id, name) == 2 ||
      std::sscanf(s.c_str(), "$ANSA_NAME_COMMENT;%d;PSOLID;%199[^;]", &id, name) == 2 ||
      std::sscanf(s.c_str(), "$ Femap with NX Nastran Property %d : %199[^\n]", &id, name) == 2 ||
      std::sscanf(s.c_str(), "$ Femap Property %d : %199[^\n]", &id, name) == 2)
    names_[id] = clean_name(name);
}

BdfEntries::Ends BdfEntries::cut(const Line& line, std::vector<DataField>& fields) const {
  const std::string_view l = line.text.substr(0, line.text.find('$'));
  Ends ends;
  if (l.find(',') != std::string_view::npos) {
    ends.first = strip(l.substr(0, l.find(',')));
    const bool large = !ends.first.empty() && (ends.first.back() == '*' || ends.first.front() == '*');
    const size_t count = large ? 4 : 8;
    size_t from = 0, n = 0;
    for (size_t i = 0; i <= l.size(); ++i) {
      if (i < l.size() && l[i] != ',') continue;
      const auto raw = l.substr(from, i - from);
      const auto f = strip(raw);
      const int column = static_cast<int>(from + (f.empty() ? 0 : static_cast<size_t>(f.data() - raw.data()))) + 1;
      if (n > 0 && n <= count)
        fields.push_back({f, column});
      else if (n == count + 1 && !f.empty() && f.find_first_not_of("0123456789.eEdD-") != std::string_view::npos)
        ends.label = f;  // "+E1", or a word: a number there is a field too many
      else if (n > count && !f.empty())
        throw Error(fmt::format("{}:{}", line.place(), column), fmt::format("more than {} fields after the name on a line", count),
                    "go on in a line that begins with a comma");
      from = i + 1, ++n;
    }
    while (n++ <= count) fields.push_back({"", 1});
    return ends;
  }
  ends.first = strip(l.substr(0, 8));
  const bool large = !ends.first.empty() && (ends.first.back() == '*' || ends.first.front() == '*');
  const size_t width = large ? 16 : 8, count = large ? 4 : 8;
  for (size_t i = 0; i < count; ++i) {
    const size_t from = 8 + i * width;
    fields.push_back({from < l.size() ? strip(l.substr(from, width)) : std::string_view{}, static_cast<int>(from) + 1});
  }
  if (l.size() > 72) ends.label = strip(l.substr(72, 8));
  return ends;
}

/// The next line of bulk data that is neither empty nor a comment; what stands before BEGIN BULK is kept aside.
bool BdfEntries::bulk_line(Line& l) {
  while (ahead_given_ || line(l)) {
    if (ahead_given_) {
      l = ahead_, ahead_given_ = false;
      return true;
    }
    if (!l.text.empty() && l.text.front() == '$') {
      comment(l.text);
      continue;
    }
    const auto text = strip(l.text.substr(0, l.text.find('$')));
    if (text.empty()) continue;
    if (starts(text, "BEGINBULK") || starts(text, "BEGINSUPER")) {
      if (in_bulk_ || upper(text).size() > 9)
        throw Error(l.place(), fmt::format("{}: superelements are not read", text), "write one model without superelements");
      in_bulk_ = true;
      continue;
    }
    if (in_bulk_) return true;
    case_.push_back({std::string(text), l.place()});
  }
  return false;
}

/// Nothing is read behind it; in an included file that would lose what the file that includes it goes on with.
void BdfEntries::end_data(const Line& l) {
  if (stack_.size() > 1) {
    stack_.pop_back();
    for (Line more; physical(more);) {
      const auto text = strip(more.text.substr(0, more.text.find('$')));
      if (text.empty()) continue;
      if (starts(text, "ENDDATA")) break;
      throw Error(l.place(), fmt::format("ENDDATA ends an included file, but entries follow at {}", more.place()),
                  "remove it from the included file");
    }
  }
  stack_.clear();
}

bool BdfEntries::next(BdfEntry& e) {
  Line l;
  if (!bulk_line(l)) return false;
  if (starts(l.text, "ENDDATA")) {
    end_data(l);
    return false;
  }
  static_cast<DataLine&>(e) = {&l.source->path, l.number, {}};
  Ends ends = cut(l, e.fields);
  e.name = upper(ends.first);
  if (e.name.empty() || e.name.front() == '+' || e.name.front() == '*')
    throw Error(l.place(), "a continuation that follows no entry", "sort the continuations after their entries");
  bool large = e.name.back() == '*', half = large;
  if (large) e.name.pop_back();
  while (bulk_line(l)) {
    const auto mark = e.fields.size();
    const Ends more = cut(l, e.fields);
    if (!more.first.empty() && more.first.front() != '+' && more.first.front() != '*') {
      e.fields.resize(mark);
      ahead_ = l, ahead_given_ = true;
      break;
    }
    if (!same_label(ends.label, more.first))
      throw Error(l.place(), fmt::format("continuation \"{}\" follows a line that goes on at \"{}\"", more.first, ends.label),
                  "sort the continuations after their entries");
    // a large line is half of a small one: what follows the first half is the second
    large = !more.first.empty() && more.first.front() == '*';
    if (half && !large) throw Error(l.place(), "a line of large fields goes on in small ones", "begin the line with *");
    half = large && !half;
    ends = more;
  }
  while (!e.fields.empty() && e.fields.back().text.empty()) e.fields.pop_back();
  return true;
}

}  // namespace hilo
