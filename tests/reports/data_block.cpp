#include "tests/reports/data_block.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace tarmac::reports {

nlohmann::json data_of(const std::string& page) {
  const std::string open = "<script type=\"application/json\" id=\"tarmac-data\">";
  const std::size_t begin = page.find(open);
  if (begin == std::string::npos) throw std::runtime_error("the page has no data block");
  const std::size_t from = begin + open.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

}  // namespace tarmac::reports
