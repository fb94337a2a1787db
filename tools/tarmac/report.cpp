// `tarmac report`: the page of runs that were evaluated before.
#include <fmt/format.h>

#include "tools/tarmac/commands.h"
#include "tools/tarmac/layout.h"
#include "tools/tarmac/write_page.h"

namespace tarmac::tools {

int report_command(const ReportArguments& arguments, const CommonArguments& common) {
  std::vector<RunFolder> runs;
  for (const std::string& folder : arguments.folders) {
    for (RunFolder& run : runs_below(folder)) runs.push_back(std::move(run));
  }
  write_page(runs, arguments.out, Console(common.quiet));
  fmt::print("{}\n", arguments.out);
  return 0;
}

}  // namespace tarmac::tools
