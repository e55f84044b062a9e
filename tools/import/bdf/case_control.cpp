// SPDX-License-Identifier: GPL-3.0-or-later
// Executive and case control of a Nastran file: what stands before BEGIN BULK.  One subcase becomes scene lines, with the loads of that
// which its STATSUB names; what stands above the subcases holds for each of them.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <ranges>

#include "base/error.hpp"
#include "import/bdf/card.hpp"

namespace hilo {
namespace {

/// "SPC(1) = 3" as "SPC" and "3".
std::pair<std::string, std::string> parts(const std::string& line) {
  const auto end = line.find_first_of(" =(,");
  const std::string word = upper(line.substr(0, end));
  const auto eq = line.find('=');
  std::string value = eq != std::string::npos ? line.substr(eq + 1) : end == std::string::npos ? "" : line.substr(end);
  value.erase(0, value.find_first_not_of(" ,="));
  return {word, value};
}

/// A word of case control by its first four letters, which are enough there.
std::string head_of(const std::string& word) { return word.substr(0, 4); }

/// Requests for output, names, and controls of printing: nothing is lost.  By their first four letters, or whole where others share these.
bool is_request(const std::string& word) {
  static const std::set<std::string> heads{"DISP", "PRES", "VECT", "VELO", "SVEL", "ACCE", "SACC", "STRE", "STRA", "ELST", "ELSU", "FORC",
                                           "ELFO", "SPCF", "MPCF", "OLOA", "GPFO", "GPST", "GPKE", "ESE",  "EKE",  "EDE",  "ECHO", "SUBT",
                                           "LABE", "LINE", "MAXL", "SET",  "PAGE", "OUTP", "SVEC", "SDIS", "THER", "FLUX", "MEFF", "MPFA",
                                           "WEIG", "GROU", "TFL",  "SURF", "VOLU", "STRF", "ID",   "TIME", "CEND", "DIAG", "NAST", "APP",
                                           "SKIP", "RESU", "BCRE", "ELSD", "GPSD", "VUGR", "NLST", "ASSI", "INIT", "FORM", "XYPL", "XYPR",
                                           "XYPU", "PLOT", "OTIM", "OMOD", "ELDA", "ENTH", "HDOT", "HOUT"};
  static const std::set<std::string> whole{"MODALKE", "MODALSE", "CONTACTRESULTS"};
  return heads.contains(head_of(word)) || whole.contains(word) || word.find_first_not_of("0123456789") == std::string::npos;
}

/// ANALYSIS of a subcase: the solution that it is, "" where it is none here.
std::string solution_of(const std::string& analysis) {
  static const std::map<std::string, std::string> known{{"STAT", "101"}, {"MODE", "103"}, {"BUCK", "105"}, {"NLST", "106"}};
  const auto it = known.find(head_of(analysis));
  return it == known.end() ? "" : it->second;
}

/// Text and controls, which end with their line; SET and the other requests go on behind a comma.
bool goes_on_by_comma(const std::string& word) {
  static const std::set<std::string> ends_there{"SUBT", "LABE", "ECHO", "LINE", "MAXL", "PAGE", "ID", "TIME", "CEND", "APP"};
  return is_request(word) && !ends_there.contains(head_of(word));
}

std::int64_t number_in(const std::string& value, const BdfCaseLine& line) {
  std::int64_t n = 0;
  const auto [end, bad] = std::from_chars(value.data(), value.data() + value.size(), n);
  if (bad != std::errc() || n < 0) throw Error(line.place, fmt::format("expected the number of a set, found \"{}\"", line.text));
  return n;
}

/// Which set a word chooses; null where it is no such word.
std::int64_t BdfCase::*choice_of(const std::string& word) {
  static const std::map<std::string, std::int64_t BdfCase::*> known{
      {"SPC", &BdfCase::spc},   {"MPC", &BdfCase::mpc},     {"BGSET", &BdfCase::glue}, {"BCSET", &BdfCase::contact},
      {"LOAD", &BdfCase::load}, {"METH", &BdfCase::method}, {"TSTEP", &BdfCase::step}, {"TSTEPNL", &BdfCase::step}};
  const auto it = known.find(head_of(word) == "METH" ? "METH" : word);
  return it == known.end() ? nullptr : it->second;
}

/// Temperatures that the subcase does not take heat nothing, so nothing expands.
void forget_heat(Imported& in) {
  std::erase_if(in.not_read, [](const NotRead& n) { return n.what.ends_with(": thermal expansion"); });
  for (NotRead& n : in.not_read)
    if (n.what.starts_with("TEMP")) n.what += " of a set that the subcase does not use";
}

/// A line of case control; plots: behind OUTPUT(XYPLOT), whose words say how curves are drawn.
struct Said {
  const BdfCaseLine& line;
  std::string word, value;
  bool plots;
};
/// What stands above the subcases, or one of these.
struct Block {
  std::string word, place;  // "SUBCASE"
  std::int64_t number = -1;
  std::vector<Said> lines = {};
  bool is_subcase() const { return word == "SUBCASE"; }
  bool says(const std::string& of) const { return std::ranges::find(lines, of, &Said::word) != lines.end(); }
};

/// The first is what stands above the subcases.
std::vector<Block> blocks_of(const std::vector<BdfCaseLine>& lines) {
  std::vector<Block> blocks(1);
  bool goes_on = false, plots = false;
  for (const BdfCaseLine& line : lines) {
    const bool rest = goes_on;  // of a request that goes on behind a comma
    const auto [word, value] = parts(line.text);
    goes_on = line.text.back() == ',' && (rest || goes_on_by_comma(word));
    if (rest) continue;
    plots = plots || (head_of(word) == "OUTP" && line.text.find('(') != std::string::npos);
    if (word == "SUBCASE")
      blocks.push_back({word, line.place, value.empty() ? 1 : number_in(value, line)});
    else if (word == "SUBCOM" || word == "SYM" || word == "REPCASE")
      blocks.push_back({word, line.place});
    else
      blocks.back().lines.push_back({line, word, value, plots});
  }
  return blocks;
}

/// Null where there is none.
const Block* subcase_of(const std::vector<Block>& blocks, std::int64_t number) {
  const auto at = std::ranges::find_if(blocks, [&](const Block& b) { return b.is_subcase() && b.number == number; });
  return at == blocks.end() ? nullptr : &*at;
}

void take(const Block& block, BdfCase& c, Imported& in) {
  for (const auto& [line, word, value, plots] : block.lines) {
    if (word == "CEND")
      c.any = true;
    else if (word == "SOL")
      c.solution = upper(value.substr(0, value.find_first_of(" ,")));
    else if (const std::string solution = word == "ANALYSIS" ? solution_of(upper(value)) : ""; !solution.empty())
      c.solution = solution;
    else if (head_of(word) == "TITL")
      c.title = value;
    else if (head_of(word) == "SUBT" || head_of(word) == "LABE")
      (word[0] == 'L' ? c.label : c.subtitle) = value;
    else if (word == "STATSUB")
      (upper(line.text).find("(PREL") != std::string::npos ? c.preload_of : c.loads_of) = {number_in(value, line), line.place};
    else if (const auto chosen = choice_of(word))
      c.*chosen = number_in(value, line);
    else if (word == "PARAM") {
      if (upper(line.text).find("WTMASS") != std::string::npos)
        throw Error(line.place, "PARAM WTMASS in case control is not read", "write it into the bulk data");
      in.skip("PARAM in case control", line.place);
    } else if (head_of(word) == "TEMP" || word == "TSTRU") {
      c.heats = true;
      in.skip("case control TEMPERATURE", line.place);
    } else if (!is_request(word) && !plots)
      in.skip("case control " + word.substr(0, 40), line.place);
  }
}

/// The subcase that the scene is of where none is asked for, null for none: the first one, but of modes and dynamics that whose STATSUB
/// names a static one, and of buckling the one behind those of loads.
const Block* main_of(const std::vector<Block>& blocks, const BdfCase& above) {
  const auto subcases = std::ranges::subrange(blocks.begin() + 1, blocks.end());
  const auto first = std::ranges::find_if(subcases, &Block::is_subcase);
  if (first == blocks.end()) return nullptr;
  if (above.is_static() || above.solution == "200") return &*first;
  const auto chosen = [&](auto&& wanted) {
    return std::find_if(first, blocks.end(), [&](const Block& b) { return b.is_subcase() && wanted(b); });
  };
  auto main = chosen([](const Block& b) { return b.says("STATSUB"); });
  if (main == blocks.end() && above.buckles()) main = chosen([&](const Block& b) { return &b != &*first && !b.says("LOAD"); });
  return main == blocks.end() ? &*first : &*main;
}

/// The static subcase under whose loads `main` vibrates or buckles: that of STATSUB, and of buckling without it the first one.  Null for
/// none.
const Block* base_of(const std::vector<Block>& blocks, const Block* main, const BdfCase& c, Imported& in) {
  const bool plain = c.loads_of.subcase >= 0, preload = c.preload_of.subcase >= 0;
  if (!c.finds_modes() && !c.buckles()) {
    if (plain || preload) in.skip("case control STATSUB", (plain ? c.loads_of : c.preload_of).place);
    return nullptr;
  }
  if (preload && (c.buckles() || plain)) in.skip("case control STATSUB(PRELOAD)", c.preload_of.place);
  if (c.buckles() && !plain) {
    const auto first = std::ranges::find_if(blocks, &Block::is_subcase);
    return main && main != &*first && !main->says("LOAD") ? &*first : nullptr;
  }
  if (!plain && !preload) return nullptr;
  const auto& [number, place] = plain ? c.loads_of : c.preload_of;
  const Block* base = subcase_of(blocks, number);
  if (!base) in.skip(fmt::format("case control STATSUB = {}, of which there is none", number), place);
  return base;
}

/// Adds the loads of the static subcase, and what else `c` does not choose itself; false where the two are held or tied otherwise.
bool add_base(const BdfCase& base, BdfCase& c) {
  for (const auto set : {&BdfCase::spc, &BdfCase::mpc, &BdfCase::glue, &BdfCase::contact})
    if (c.*set >= 0 && c.*set != base.*set) return false;
  c.spc = base.spc, c.mpc = base.mpc, c.glue = base.glue, c.contact = base.contact, c.load = base.load;
  if (c.method < 0) c.method = base.method;
  c.heats = c.heats || base.heats;
  c.loaded_at_rest = c.finds_modes();
  return true;
}

/// Whether a STATSUB names this subcase.
bool is_base(const std::vector<Block>& blocks, const Block& block) {
  for (const Block& b : blocks)
    for (const Said& s : b.lines)
      if (&b != &block && s.word == "STATSUB" && number_in(s.value, s.line) == block.number) return true;
  return false;
}

}  // namespace

std::vector<std::int64_t> subcases_of(const std::vector<BdfCaseLine>& lines, const std::string& path) {
  constexpr size_t most = 1000;
  std::vector<std::int64_t> numbers;
  for (const Block& b : blocks_of(lines)) {
    if (!b.is_subcase()) continue;
    if (std::ranges::find(numbers, b.number) != numbers.end())
      throw Error(b.place, fmt::format("SUBCASE {} is given twice", b.number), "number each once, or take the first by --subcase");
    numbers.push_back(b.number);
    if (numbers.size() > most) throw Error(b.place, fmt::format("more than {} subcases", most), "take some of them by --subcase N");
  }
  if (numbers.empty()) throw Error("", fmt::format("--subcase all: {} has no SUBCASE", path), "leave --subcase away", Exit::usage);
  return numbers;
}

void read_case(const std::vector<BdfCaseLine>& lines, BdfDeck& deck, Imported& in, std::optional<std::int64_t> subcase) {
  const std::vector<Block> blocks = blocks_of(lines);
  BdfCase above;
  take(blocks[0], above, in);
  const Block* main = subcase ? subcase_of(blocks, *subcase) : main_of(blocks, above);
  if (subcase && !main) {
    std::vector<std::int64_t> numbers;
    for (const Block& b : blocks)
      if (b.is_subcase()) numbers.push_back(b.number);
    throw Error("", fmt::format("--subcase {}: there is none", *subcase), fmt::format("subcases: {}", fmt::join(numbers, ", ")),
                Exit::usage);
  }
  BdfCase& c = deck.chosen;
  c = above;
  if (main) {
    take(*main, c, in);
    c.number = main->number;
    if (c.method < 0 && (c.finds_modes() || c.buckles()) && is_base(blocks, *main)) c.solution = "101";
  }
  const Block* base = base_of(blocks, main, c, in);
  if (base) {
    BdfCase loads = above;
    if (base != main) take(*base, loads, in);
    if (!add_base(base == main ? BdfCase(c) : loads, c)) {
      in.skip(fmt::format("case control STATSUB of subcase {}, which has other supports, equations or contacts", base->number),
              main->place);
      c.load = -1, base = nullptr;
    }
  }
  const auto first = std::ranges::find_if(blocks, &Block::is_subcase);
  const bool is_first = first != blocks.end() && main == &*first;
  for (const Block& b : blocks | std::views::drop(1))
    if (&b != main && &b != base)
      in.skip(!b.is_subcase()        ? b.word
              : subcase || !is_first ? fmt::format("SUBCASE but {}", c.number)
                                     : "SUBCASE after the first",
              b.place);
  if (c.any && !c.heats) forget_heat(in);
}

}  // namespace hilo
