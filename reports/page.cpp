#include "reports/page.h"

#include <fmt/format.h>

#include "reports/web_bundle.h"

namespace tarmac::reports {

namespace {

constexpr const char* kNoScript =
    "<noscript><p class=\"note\">The tables and lines of this page are drawn by the script inside it, which your "
    "browser "
    "has switched off. The same numbers are in evaluation.json beside each estimator's trajectory.</p></noscript>\n";

std::string question(const ReportInput& input) {
  const auto block = [](const char* title, const std::string& text) {
    return text.empty()
               ? std::string()
               : fmt::format("<div><span class=\"engraved\">{}</span><p>{}</p></div>\n", title, escape_html(text));
  };
  const std::string blocks = block("Why this drive", input.why) + block("What would be a surprise", input.surprise);
  return blocks.empty() ? "" : "<div class=\"question\">\n" + blocks + "</div>\n";
}

std::string header(const ReportInput& input) {
  const Verdict verdict_ = verdict(input.runs);
  std::string html =
      "<header>\n<div class=\"plate\"><span class=\"wordmark\">Tarmac</span><div id=\"theme\"></div></div>\n";
  html += fmt::format("<h1>{}</h1>\n<p class=\"verdict\">{}</p>\n", escape_html(input.title),
                      escape_html(verdict_.sentence));
  if (!verdict_.note.empty()) html += fmt::format("<p class=\"verdict-note\">{}</p>\n", escape_html(verdict_.note));
  return html + question(input) + kNoScript + "</header>\n";
}

}  // namespace

std::string escape_html(const std::string& text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out += i + k <= bytes.size() ? kDigits[word >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return out;
}

std::string frame_page(const std::string& title, std::string_view style, const std::string& body,
                       const std::string& data, std::string_view script) {
  std::string html = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  html += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  // The browser itself refuses whatever would leave the page.
  html +=
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n";
  html += fmt::format("<title>{} · Tarmac</title>\n<style>\n", escape_html(title));
  html += style;
  html += "</style>\n</head>\n<body>\n" + body;
  html += "<script type=\"application/json\" id=\"tarmac-data\">" + data + "</script>\n<script>\n";
  html += script;
  html += "</script>\n</body>\n</html>\n";
  return html;
}

std::string assemble_page(const ReportInput& input, const Pictures& pictures) {
  std::string body = header(input);
  body += "<div id=\"legend\"><nav aria-label=\"Contents\"></nav><div class=\"bar\"></div></div>\n<main>\n";
  for (const char* id : {"summary", "comparison", "findings", "top", "stills", "drift", "phase", "residuals", "deskew",
                         "degeneracy", "timing", "outcome", "provenance"}) {
    body += fmt::format("<section id=\"{}\"></section>\n", id);
  }
  body += "</main>\n";
  return frame_page(input.title, page_style(), body, page_data(input, pictures), page_script());
}

}  // namespace tarmac::reports
