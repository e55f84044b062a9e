// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/inp/lines.hpp"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>

#include "base/error.hpp"
#include "base/utf8.hpp"

namespace hilo {
namespace {

/// Cut at commas outside double quotes.
void cut(std::string_view line, std::vector<DataField>& fields) {
  fields.clear();
  size_t from = 0;
  bool quoted = false;
  for (size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (line[i] != ',' || quoted)) continue;
    const auto raw = line.substr(from, i - from);
    const auto text = strip(raw);
    const size_t lead = text.empty() ? 0 : static_cast<size_t>(text.data() - raw.data());
    fields.push_back({text, static_cast<int>(from + lead) + 1});
    from = i + 1;
  }
  while (!fields.empty() && fields.back().text.empty()) fields.pop_back();
}

}  // namespace

std::string_view unquote(std::string_view s) { return s.size() > 1 && s.front() == '"' && s.back() == '"' ? s.substr(1, s.size() - 2) : s; }

std::string Card::place() const { return fmt::format("{}:{}", *file, line); }
const Card::Param* Card::find(const std::string& param) const {
  const auto p = params.find(param);
  if (p == params.end()) return nullptr;
  p->second.asked = true;
  return &p->second;
}
std::string Card::place(const std::string& param) const {
  const Param* p = find(param);
  return fmt::format("{}:{}:{}", *file, line, p ? p->column : 1);
}
std::string Card::value(const std::string& param, const std::string& fallback) const {
  const Param* p = find(param);
  return p ? p->value : fallback;
}
std::string Card::word(const std::string& param, const std::string& fallback) const { return upper(value(param, fallback)); }
std::string Card::need(const std::string& param) const {
  const Param* p = find(param);
  if (!p || p->value.empty()) throw Error(fmt::format("{}:1", place()), fmt::format("{} lacks {}=", name, param));
  return p->value;
}
double Card::number(const std::string& param) const { return DataLine{file, line, {{need(param), params.at(param).column}}}.number(0); }
std::int64_t Card::integer(const std::string& param) const {
  return DataLine{file, line, {{need(param), params.at(param).column}}}.integer(0);
}

InpLines::InpLines(const std::string& path) : folder_(std::filesystem::path(path).parent_path().string()) { open(path, ""); }

void InpLines::open(const std::string& path, const std::string& place) {
  Source s{std::make_shared<const std::string>(path), std::make_shared<const std::string>(as_utf8(read_gz(path, place)))};
  if (s.text->substr(0, 65536).find('\0') != std::string::npos)
    throw Error(path, "not a text file", "hilo-import reads .inp decks as text");
  stack_.push_back(s);
  kept_.push_back(s);
}

void InpLines::include(const std::string& name, const std::string& card, const std::string& place) {
  namespace fs = std::filesystem;
  if (name.empty()) throw Error(place + ":1", fmt::format("{} lacks INPUT=", card));
  if (stack_.size() > 20)
    throw Error(place, fmt::format("{} nested more than 20 deep at \"{}\"", card, name), "does a file include itself?");
  const fs::path p = fs::path(name).is_absolute() ? fs::path(name) : fs::path(folder_) / name;
  open(p.string(), place);
}

bool InpLines::next_line(std::string_view& line) {
  if (ahead_) {
    line = *ahead_;
    ahead_.reset();
    return true;
  }
  while (!stack_.empty()) {
    Source& s = stack_.back();
    if (s.at >= s.text->size()) {
      stack_.pop_back();
      continue;
    }
    const size_t end = std::min(s.text->find('\n', s.at), s.text->size());
    line = std::string_view(*s.text).substr(s.at, end - s.at);
    s.line_at = s.at, s.at = end + 1;
    ++s.line;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    const auto bare = strip(line);
    if (bare.empty() || bare.substr(0, 2) == "**") continue;
    if (bare.size() > 8 && bare.front() == '*' && upper(bare.substr(0, 8)) == "*INCLUDE") {
      std::vector<DataField> fields;
      cut(bare, fields);
      std::string name;
      for (const auto& f : fields)
        if (const auto eq = f.text.find('='); eq != std::string_view::npos && upper(f.text.substr(0, eq)) == "INPUT")
          name = unquote(strip(f.text.substr(eq + 1)));
      include(name, "*INCLUDE", fmt::format("{}:{}", *s.path, s.line));
      continue;
    }
    if (!values_.empty()) put_values(line);
    return true;
  }
  return false;
}

int InpLines::count(std::string_view word) const {
  int n = 0;
  const std::string& text = *kept_.front().text;
  for (size_t at = 0; at < text.size(); at = std::min(text.find('\n', at), text.size()) + 1) {
    const std::string line = upper(std::string_view(text).substr(at, word.size() + 8));
    n += line.starts_with(word) && (line.size() == word.size() || !std::isalnum(static_cast<unsigned char>(line[word.size()])));
  }
  return n;
}

InpLines::Mark InpLines::mark() const { return {stack_.back()}; }

void InpLines::give_back() {
  if (!ahead_) return;
  Source& s = stack_.back();
  s.at = s.line_at, --s.line;
  ahead_.reset();
}

void InpLines::read_again(const Mark& from) {
  give_back();
  stack_.push_back(from.source);
}

void InpLines::go_back() { stack_.pop_back(); }

void InpLines::put_values(std::string_view& line) {
  if (line.find('<') == line.npos) return;
  std::string out;
  for (size_t at = 0; at < line.size();) {
    const size_t from = line.find('<', at), to = from == line.npos ? from : line.find('>', from);
    if (to == line.npos) {
      out += line.substr(at);
      break;
    }
    const std::string name(strip(line.substr(from + 1, to - from - 1)));
    const auto value = values_.find(name);
    if (value == values_.end())
      throw Error(fmt::format("{}:{}:{}", *stack_.back().path, stack_.back().line, from + 1),
                  fmt::format("no parameter \"{}\" so far", name), "*PARAMETER gives it before");
    out += line.substr(at, from - at);
    out += value->second, at = to + 1;
  }
  line = replaced_.emplace_back(std::move(out));
}

bool InpLines::next_text(std::string_view& text, std::string& place) {
  if (!next_line(text)) return false;
  if (strip(text).front() == '*') {
    ahead_ = text;
    return false;
  }
  place = fmt::format("{}:{}", *stack_.back().path, stack_.back().line);
  return true;
}

void InpLines::count_unread() {
  if (unread_.lines++ == 0) unread_.place = fmt::format("{}:{}", *stack_.back().path, stack_.back().line);
}

/// The data line at hand is done with.
void InpLines::settle() {
  if ((given_ & ~asked_) != 0) count_unread();
  given_ = asked_ = 0;
}

bool InpLines::next_data(DataLine& data) {
  settle();
  std::string_view line;
  if (!next_line(line)) return false;
  if (strip(line).front() == '*') {
    ahead_ = line;
    return false;
  }
  data.file = stack_.back().path.get();
  data.line = stack_.back().line;
  cut(line, data.fields);
  data.asked.bits = &asked_;
  for (size_t i = 0; i < std::min<size_t>(data.fields.size(), 64); ++i)
    if (!data.fields[i].text.empty()) given_ |= std::uint64_t{1} << i;
  return true;
}

bool InpLines::next_card(Card& card) {
  settle();
  std::string_view line;
  for (;;) {
    if (!next_line(line)) return false;
    if (strip(line).front() == '*') break;
    count_unread();
  }
  card.file = stack_.back().path.get();
  card.line = stack_.back().line;
  card.params.clear();
  std::vector<DataField> fields;
  for (bool first = true, more = true; more; first = false) {
    cut(line, fields);
    more = strip(line).back() == ',';
    for (const auto& f : fields) {
      if (first && &f == &fields.front()) {
        card.key = upper(f.text.substr(1));
        card.name.assign(1, '*');
        for (const char c : strip(f.text.substr(1)))
          if (!(std::isspace(static_cast<unsigned char>(c)) && card.name.back() == ' '))
            card.name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        continue;
      }
      const auto eq = f.text.find('=');
      const auto key = upper(f.text.substr(0, eq));
      if (key.empty()) continue;
      const auto value = eq == std::string_view::npos ? std::string_view{} : strip(f.text.substr(eq + 1));
      const int column =
          eq == std::string_view::npos || value.empty() ? f.column : f.column + static_cast<int>(value.data() - f.text.data());
      card.params[key] = {std::string(unquote(value)), column};
    }
    if (more && !next_line(line)) break;
    if (more && strip(line).front() == '*') {  // a comma at the end with nothing behind it
      ahead_ = line;
      break;
    }
    // CalculiX decks end a card with a comma by mistake: a line of plain numbers is data
    if (more && line.find('=') == std::string_view::npos && !std::isalpha(static_cast<unsigned char>(strip(line).front()))) {
      ahead_ = line;
      break;
    }
  }
  if (card.key != "SUBMODEL" && card.has("INPUT")) {  // the file of its data lines; of results there
    give_back();
    include(card.need("INPUT"), card.name, card.place());
    card.params.erase("INPUT");
  }
  return true;
}

}  // namespace hilo
