/// Words and numbers of mesh files in text.
#pragma once

#include <charconv>
#include <string_view>
#include <system_error>

namespace tarmac::io::world {

/// Words of a line, one after the other; "" at its end.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}
  std::string_view next() {
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (!rest_.empty() && blank(rest_.front())) rest_.remove_prefix(1);
    std::size_t size = 0;
    while (size < rest_.size() && !blank(rest_[size])) ++size;
    const std::string_view word = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return word;
  }
  /// What is left, without blanks at either end.
  std::string_view rest() {
    const std::size_t first = rest_.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return rest_.substr(first, rest_.find_last_not_of(" \t\r") - first + 1);
  }

 private:
  std::string_view rest_;
};

/// The whole word as a number; `nan` and `inf` are numbers too.
template <class Number>
bool parse(std::string_view word, Number& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

}  // namespace tarmac::io::world
