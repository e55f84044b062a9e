// The entries of a Nastran file: small, large and free fields, continuations joined.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "import/data_line.hpp"

namespace hilo {

/// A bulk entry: its name, and its fields from the second on.
struct BdfEntry {
  std::string name;
  DataLine data;
};

class BdfEntries {
 public:
  explicit BdfEntries(const std::string& path) : path_(path), text_(read_gz(path, "")) {}
  BdfEntries(const BdfEntries&) = delete;  // entries point into it
  bool next(BdfEntry& e);
  /// Names of properties that pre-processors leave in comments: $HMNAME PROP 3"hull".
  const std::map<std::int64_t, std::string>& property_names() const { return names_; }

 private:
  bool line(std::string_view& l);
  void comment(std::string_view l);
  void cut(std::string_view l, std::string_view& first, std::vector<Field>& fields) const;
  bool has_bulk();
  std::string place() const;

  std::string path_, text_;
  size_t at_ = 0;
  int line_ = 0, bulk_ = -1;
  bool in_bulk_ = false;
  std::optional<std::string_view> ahead_;
  std::map<std::int64_t, std::string> names_;
};

}  // namespace hilo
