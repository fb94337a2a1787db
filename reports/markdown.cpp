#include "reports/markdown.h"

#include <string_view>

namespace tarmac::reports {

std::string markdown_cell(const std::string& text) {
  constexpr std::string_view kMarkup = "|\\`*_[]~";
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '&')
      out += "&amp;";
    else if (c == '@')
      out += "&#64;";
    else if (c == '\n' || c == '\r')
      out += ' ';
    else if (kMarkup.find(c) != std::string_view::npos)
      out += std::string("\\") + c;
    else if (static_cast<unsigned char>(c) >= 0x20)
      out += c;
  }
  return out;
}

}  // namespace tarmac::reports
