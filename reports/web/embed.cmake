# Writes files as constants of a C++ source:  cmake -DOUT=x.cpp -DDIR=folder -P embed.cmake
function(bytes_of file out)
  file(READ ${file} hex HEX)
  string(REGEX REPLACE "(..)" "0x\\1," list "${hex}")
  string(REGEX REPLACE "(................................................................................)" "\\1\n" list "${list}")
  set(${out} "${list}" PARENT_SCOPE)
endfunction()

bytes_of(${DIR}/page.js page_js)
bytes_of(${DIR}/page.css page_css)
bytes_of(${DIR}/compare.js compare_js)
bytes_of(${DIR}/compare.css compare_css)
file(WRITE ${OUT} "// Made by reports/web/embed.cmake.
#include \"reports/web_bundle.h\"

namespace tarmac::reports {
namespace {
constexpr unsigned char kPageJs[] = {${page_js}};
constexpr unsigned char kPageCss[] = {${page_css}};
constexpr unsigned char kCompareJs[] = {${compare_js}};
constexpr unsigned char kCompareCss[] = {${compare_css}};
}  // namespace

std::string_view page_script() { return {reinterpret_cast<const char*>(kPageJs), sizeof kPageJs}; }
std::string_view page_style() { return {reinterpret_cast<const char*>(kPageCss), sizeof kPageCss}; }
std::string_view compare_script() { return {reinterpret_cast<const char*>(kCompareJs), sizeof kCompareJs}; }
std::string_view compare_style() { return {reinterpret_cast<const char*>(kCompareCss), sizeof kCompareCss}; }

}  // namespace tarmac::reports
")
