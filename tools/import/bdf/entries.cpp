#include "import/bdf/entries.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "base/error.hpp"
#include "import/imported.hpp"

namespace hilo {

bool BdfEntries::line(std::string_view& l) {
  if (at_ >= text_.size()) return false;
  const size_t end = std::min(text_.find('\n', at_), text_.size());
  l = std::string_view(text_).substr(at_, end - at_);
  at_ = end + 1;
  ++line_;
  if (!l.empty() && l.back() == '\r') l.remove_suffix(1);
  return true;
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

/// Fields of one physical line behind its first; `first` is that one.
void BdfEntries::cut(std::string_view l, std::string_view& first, std::vector<Field>& fields) const {
  const auto strip = [](std::string_view s) {
    while (!s.empty() && s.front() == ' ') s.remove_prefix(1);
    while (!s.empty() && (s.back() == ' ' || s.back() == '\t')) s.remove_suffix(1);
    return s;
  };
  if (const auto dollar = l.find('$'); dollar != std::string_view::npos) l = l.substr(0, dollar);
  if (l.find(',') != std::string_view::npos) {
    size_t from = 0, n = 0;
    for (size_t i = 0; i <= l.size(); ++i)
      if (i == l.size() || l[i] == ',') {
        const auto f = strip(l.substr(from, i - from));
        if (n == 0)
          first = f;
        else if (n < 9)
          fields.push_back({f, static_cast<int>(from) + 1});
        from = i + 1, ++n;
      }
    while (n++ < 9) fields.push_back({"", 1});
    return;
  }
  first = strip(l.substr(0, 8));
  const bool large = !first.empty() && (first.back() == '*' || first.front() == '*');
  const size_t width = large ? 16 : 8, count = large ? 4 : 8;
  for (size_t i = 0; i < count; ++i) {
    const size_t from = 8 + i * width;
    fields.push_back({from < l.size() ? strip(l.substr(from, width)) : std::string_view{}, static_cast<int>(from) + 1});
  }
}

bool BdfEntries::next(BdfEntry& e) {
  std::string_view l;
  for (;;) {
    if (ahead_)
      l = *ahead_, ahead_.reset();
    else if (!line(l))
      return false;
    if (!l.empty() && l.front() == '$') {
      comment(l);
      continue;
    }
    if (l.find_first_not_of(" \t") == std::string_view::npos) continue;
    if (upper(l.substr(0, 10)) == "BEGINBULK") {  // all before it was case control
      in_bulk_ = true;
      continue;
    }
    if (!in_bulk_ && has_bulk()) continue;
    if (upper(l).rfind("ENDDATA", 0) == 0) return false;
    break;
  }
  if (l.find('\t') != std::string_view::npos) throw Error(place(), "a tab in a Nastran entry", "write blanks or commas");
  e.data = {&path_, line_, {}};
  std::string_view first;
  cut(l, first, e.data.fields);
  e.name = upper(first);
  if (!e.name.empty() && e.name.back() == '*') e.name.pop_back();
  while (line(l)) {
    if (!l.empty() && l.front() == '$') {
      comment(l);
      continue;
    }
    const bool more = !l.empty() && (l.front() == '+' || l.front() == '*' || l.front() == ',' ||
                                     (l.front() == ' ' && l.find_first_not_of(' ') != std::string_view::npos));
    if (!more) {
      ahead_ = l;
      break;
    }
    cut(l, first, e.data.fields);
  }
  while (!e.data.fields.empty() && e.data.fields.back().text.empty()) e.data.fields.pop_back();
  return true;
}

bool BdfEntries::has_bulk() {
  if (bulk_ < 0) {
    const std::string head = upper(std::string_view(text_).substr(0, 100000));
    bulk_ = head.find("BEGINBULK") != std::string::npos;
  }
  return bulk_ > 0;
}

std::string BdfEntries::place() const { return fmt::format("{}:{}", path_, line_); }

}  // namespace hilo
