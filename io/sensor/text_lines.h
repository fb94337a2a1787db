/// Text files of numbers, line by line, with errors that say where.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.h"

namespace tarmac::io {

/// One line that holds data, cut into fields; the text lives as long as the TextLines that it came from.
struct TextLine {
  const std::filesystem::path* file = nullptr;
  int number = 0;  ///< 1-based
  std::string_view text;
  std::vector<std::string_view> fields;

  /// Throws core::InputError "file:line: message".
  [[noreturn]] void fail(const std::string& message) const;
  /// Field k as a finite number; otherwise an error that names the field as `meaning`.
  double number_at(std::size_t k, const char* meaning) const;
  /// Field k as integer nanoseconds.
  std::int64_t integer_at(std::size_t k, const char* meaning) const;
  /// Field k as decimal seconds, exact to the nanosecond: never through a double, which has no room for it.
  core::Time seconds_at(std::size_t k, const char* meaning) const;
};

/// The lines of a file that are neither empty nor comments (from '#' on). Carriage returns are taken off.
class TextLines {
 public:
  /// `separator` ' ' stands for any run of blanks and tabs. Throws core::InputError when the file cannot be read.
  TextLines(const std::filesystem::path& file, char separator);
  TextLines(const TextLines&) = delete;
  TextLines& operator=(const TextLines&) = delete;
  /// The next line with data; false at the end of the file.
  bool next(TextLine& line);
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  std::string content_;
  char separator_;
  std::size_t at_ = 0;
  int number_ = 0;
};

/// Seconds with all nine decimals, exact: "12.000000345".
std::string seconds_text(core::Time t);

}  // namespace tarmac::io
