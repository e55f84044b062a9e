// Where results go: a file, whole or not at all, or stdout.
#pragma once
#include <string>
#include <vector>

namespace hilo {

/// To a file (its folder is made), whole or not at all, or to stdout for "-".
void write_out(const std::string& path, const std::string& bytes);

/// Lines with aligned columns; the first row is the header, numbers (from column `first_number` on) are set right.
std::string aligned(const std::vector<std::vector<std::string>>& rows, size_t first_number);

/// JSON: a quoted text; a number (null where it is not finite); a list of numbers.
std::string json(const std::string& text);
std::string json(double x);
std::string json(const std::vector<double>& values);

}  // namespace hilo
