// SPDX-License-Identifier: GPL-3.0-or-later
// Executive and case control of a Nastran file: what stands before BEGIN BULK.  The first subcase becomes scene lines; what stands above
// the subcases holds for each of them.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

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

}  // namespace

std::vector<std::int64_t> subcases_of(const std::vector<BdfCaseLine>& lines, const std::string& path) {
  constexpr size_t most = 1000;
  std::vector<std::int64_t> numbers;
  bool goes_on = false;
  for (const BdfCaseLine& line : lines) {
    const bool rest = goes_on;
    const auto [word, value] = parts(line.text);
    goes_on = line.text.back() == ',' && (rest || goes_on_by_comma(word));
    if (rest || word != "SUBCASE") continue;
    const std::int64_t number = value.empty() ? 1 : number_in(value, line);
    if (std::ranges::find(numbers, number) != numbers.end())
      throw Error(line.place, fmt::format("SUBCASE {} is given twice", number), "number each once, or take the first by --subcase");
    numbers.push_back(number);
    if (numbers.size() > most) throw Error(line.place, fmt::format("more than {} subcases", most), "take some of them by --subcase N");
  }
  if (numbers.empty()) throw Error("", fmt::format("--subcase all: {} has no SUBCASE", path), "leave --subcase away", Exit::usage);
  return numbers;
}

void read_case(const std::vector<BdfCaseLine>& lines, BdfDeck& deck, Imported& in, std::optional<std::int64_t> subcase) {
  BdfCase& c = deck.chosen;
  bool others = false, goes_on = false, plots = false;
  std::string buckles;                // place of the SUBCASE of SOL 105 that buckles under the loads of the one before
  std::vector<std::int64_t> numbers;  // of subcases
  for (const BdfCaseLine& line : lines) {
    const bool rest = goes_on, comma = line.text.back() == ',';  // of a request that goes on behind a comma
    const auto [word, value] = parts(line.text);
    goes_on = comma && (rest || goes_on_by_comma(word));
    if (rest) continue;
    plots = plots || (head_of(word) == "OUTP" && line.text.find('(') != std::string::npos);  // its words say how curves are drawn
    if (word == "CEND") c.any = true;
    if (word == "SUBCASE" || word == "SUBCOM" || word == "SYM" || word == "REPCASE") {
      const bool is_case = word == "SUBCASE";
      const std::int64_t number = !is_case ? -1 : value.empty() ? 1 : number_in(value, line);
      if (is_case) numbers.push_back(number);
      others = !is_case || c.number >= 0 || (subcase && number != *subcase);
      buckles = others && buckles.empty() && is_case && !subcase && c.buckles() ? line.place : "";
      if (others && buckles.empty())
        in.skip(!is_case ? word : subcase ? fmt::format("SUBCASE but {}", *subcase) : "SUBCASE after the first", line.place);
      if (!others) c.number = number;
      continue;
    }
    if (!buckles.empty()) {
      if (head_of(word) == "METH" && c.method < 0)
        c.method = number_in(value, line);
      else if (!(word == "SPC" && number_in(value, line) == c.spc) && word != "STATSUB" && !is_request(word))
        in.skip("SUBCASE after the first", std::exchange(buckles, ""));
    }
    if (others) continue;
    if (word == "SOL")
      c.solution = upper(value.substr(0, value.find_first_of(" ,")));
    else if (const std::string solution = word == "ANALYSIS" ? solution_of(upper(value)) : ""; !solution.empty())
      c.solution = solution;
    else if (head_of(word) == "TITL")
      c.title = value;
    else if (head_of(word) == "SUBT" || head_of(word) == "LABE")
      (word[0] == 'L' ? c.label : c.subtitle) = value;
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
  if (c.any && !c.heats) forget_heat(in);
  if (subcase && c.number < 0)
    throw Error("", fmt::format("--subcase {}: there is none", *subcase), fmt::format("subcases: {}", fmt::join(numbers, ", ")),
                Exit::usage);
}

}  // namespace hilo
