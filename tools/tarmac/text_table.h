/// Lines of cells as text, for people and for spreadsheets.
#pragma once

#include <string>
#include <vector>

namespace tarmac::tools {

/// Columns as wide as they need, the first `left` of them left-aligned, the others right-aligned; to standard output.
void print_table(const std::vector<std::vector<std::string>>& lines, std::size_t left = 1);
/// Fields with a comma, a quote or a line break are quoted as in RFC 4180; lines end with \n.
std::string csv(const std::vector<std::vector<std::string>>& lines);

}  // namespace tarmac::tools
