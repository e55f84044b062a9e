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

/// Requests for output, names, and controls of printing: nothing is lost.
bool is_request(const std::string& word) {
  static const std::set<std::string> requests{
      "DISPLACEMENT", "DISPLACEMENTS", "DISP",          "PRESSURE", "VECTOR",  "VELOCITY",      "VELO",     "SVELOCITY",
      "ACCELERATION", "ACCE",          "SACCELERATION", "STRESS",   "STRE",    "STRAIN",        "STRA",     "ELSTRESS",
      "ELSTRAIN",     "FORCE",         "FORC",          "ELFORCE",  "ELFO",    "SPCFORCES",     "SPCFORCE", "SPCF",
      "MPCFORCES",    "MPCFORCE",      "MPCF",          "OLOAD",    "OLOA",    "GPFORCE",       "GPFO",     "GPSTRESS",
      "GPSTRAIN",     "ESE",           "EKE",           "EDE",      "ECHO",    "SUBTITLE",      "LABEL",    "LINE",
      "MAXLINES",     "SET",           "PAGE",          "OUTPUT",   "SVECTOR", "SDISPLACEMENT", "THERMAL",  "FLUX",
      "MEFFMASS",     "WEIGHTCHECK",   "GROUNDCHECK",   "TFL",      "SURFACE", "VOLUME",        "STRFIELD", "ID",
      "TIME",         "CEND",          "DIAG",          "NASTRAN",  "APP",     "SKIP",          "RESULTS",  "BCRESULTS",
      "ELSDCON",      "GPSDCON",       "VUGRID",        "MODALKE",  "MODALSE", "NLSTRESS",      "ANALYSIS", "ASSIGN",
      "INIT",         "FORMAT",        "XYPLOT",        "XYPRINT",  "PLOT",    "OTIME",         "OMODES",   "CONTACTRESULTS"};
  return requests.contains(word) || word.find_first_not_of("0123456789") == std::string::npos;
}

/// Text and controls, which end with their line; SET and the other requests go on behind a comma.
bool goes_on_by_comma(const std::string& word) {
  static const std::set<std::string> ends_there{"SUBTITLE", "LABEL", "ECHO", "LINE", "MAXLINES", "PAGE", "ID", "TIME", "CEND", "APP"};
  return is_request(word) && !ends_there.contains(word);
}

std::int64_t number_in(const std::string& value, const BdfCaseLine& line) {
  std::int64_t n = 0;
  const auto [end, bad] = std::from_chars(value.data(), value.data() + value.size(), n);
  if (bad != std::errc() || n < 0) throw Error(line.place, fmt::format("expected the number of a set, found \"{}\"", line.text));
  return n;
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
  bool others = false, goes_on = false;
  std::string buckles;                // place of the SUBCASE of SOL 105 that buckles under the loads of the one before
  std::vector<std::int64_t> numbers;  // of subcases
  for (const BdfCaseLine& line : lines) {
    const bool rest = goes_on, comma = line.text.back() == ',';  // of a request that goes on behind a comma
    const auto [word, value] = parts(line.text);
    goes_on = comma && (rest || goes_on_by_comma(word));
    if (rest) continue;
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
      if (word == "METHOD" && c.method < 0)
        c.method = number_in(value, line);
      else if (!(word == "SPC" && number_in(value, line) == c.spc) && word != "STATSUB" && word != "LABEL" && word != "SUBTITLE" &&
               !is_request(word))
        in.skip("SUBCASE after the first", std::exchange(buckles, ""));
    }
    if (others) continue;
    if (word == "SOL")
      c.solution = upper(value.substr(0, value.find_first_of(" ,")));
    else if (word == "TITLE")
      c.title = value;
    else if (word == "SUBTITLE" || word == "LABEL")
      (word == "LABEL" ? c.label : c.subtitle) = value;
    else if (word == "SPC")
      c.spc = number_in(value, line);
    else if (word == "MPC")
      c.mpc = number_in(value, line);
    else if (word == "BGSET")
      c.glue = number_in(value, line);
    else if (word == "BCSET")
      c.contact = number_in(value, line);
    else if (word == "LOAD")
      c.load = number_in(value, line);
    else if (word == "METHOD")
      c.method = number_in(value, line);
    else if (word == "TSTEP" || word == "TSTEPNL")
      c.step = number_in(value, line);
    else if (word == "PARAM") {
      if (upper(line.text).find("WTMASS") != std::string::npos)
        throw Error(line.place, "PARAM WTMASS in case control is not read", "write it into the bulk data");
      in.skip("PARAM in case control", line.place);
    } else if (!is_request(word))
      in.skip("case control " + word.substr(0, 40), line.place);
  }
  if (subcase && c.number < 0)
    throw Error("", fmt::format("--subcase {}: there is none", *subcase), fmt::format("subcases: {}", fmt::join(numbers, ", ")),
                Exit::usage);
}

}  // namespace hilo
