// SPDX-License-Identifier: GPL-3.0-or-later
// The entries of a Nastran file: small, large and free fields, continuations joined, INCLUDE followed in place.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "import/data_line.hpp"

namespace hilo {

/// A bulk entry: its name, and its fields from the second on.
struct BdfEntry : DataLine {
  std::string name;
};

/// A line of executive or case control.
struct BdfCaseLine {
  std::string text, place;
};

class BdfEntries {
 public:
  explicit BdfEntries(const std::string& path);
  bool next(BdfEntry& e);
  /// Names of properties that pre-processors leave in comments: $HMNAME PROP 3"hull".
  const std::map<std::int64_t, std::string>& property_names() const { return names_; }
  /// What stands before BEGIN BULK.
  const std::vector<BdfCaseLine>& case_lines() const { return case_; }

 private:
  struct Source {
    std::string path, text;
    size_t at = 0;
    int line = 0;
  };
  struct Line {
    std::string_view text;
    const Source* source = nullptr;
    int number = 0;
    std::string place() const;
  };
  /// What a physical line holds besides its fields: its first one, and the name of its continuation (field ten).
  struct Ends {
    std::string_view first, label;
  };
  void open(const std::string& path, const std::string& place);
  bool physical(Line& l);
  bool line(Line& l);
  bool bulk_line(Line& l);
  void include(const Line& l);
  void end_data(const Line& l);
  void comment(std::string_view l);
  Ends cut(const Line& l, std::vector<DataField>& fields) const;

  std::vector<std::unique_ptr<Source>> kept_;  // texts that fields point into
  std::vector<Source*> stack_;
  bool in_bulk_ = false, ahead_given_ = false;
  Line ahead_;
  std::map<std::int64_t, std::string> names_;
  std::vector<BdfCaseLine> case_;
};

}  // namespace hilo
