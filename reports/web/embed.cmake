# Writes files as constants of a C++ source:  cmake -DOUT=x.cpp -DJS=page.js -DCSS=page.css -P embed.cmake
function(bytes_of file out)
  file(READ ${file} hex HEX)
  string(REGEX REPLACE "(..)" "0x\\1," list "${hex}")
  string(REGEX REPLACE "(................................................................................)" "\\1\n" list "${list}")
  set(${out} "${list}" PARENT_SCOPE)
endfunction()

bytes_of(${JS} js)
bytes_of(${CSS} css)
file(WRITE ${OUT} "// Made by reports/web/embed.cmake.
#include \"reports/web_bundle.h\"

namespace tarmac::reports {
namespace {
constexpr unsigned char kJs[] = {${js}};
constexpr unsigned char kCss[] = {${css}};
}  // namespace

std::string_view page_script() { return {reinterpret_cast<const char*>(kJs), sizeof kJs}; }
std::string_view page_style() { return {reinterpret_cast<const char*>(kCss), sizeof kCss}; }

}  // namespace tarmac::reports
")
