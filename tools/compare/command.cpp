// `tarmac compare`: two builds, or two estimators, over the same seeds.
#include <fmt/format.h>

#include "core/error.h"
#include "core/files.h"
#include "reports/compare_markdown.h"
#include "reports/compare_page.h"
#include "tools/compare/compare.h"
#include "tools/compare/results.h"
#include "tools/tarmac/commands.h"
#include "tools/tarmac/console.h"
#include "tools/tarmac/provenance.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;

CompareSettings settings_of(const CompareArguments& arguments) {
  CompareSettings settings;
  settings.a = arguments.folders.at(0);
  settings.b = arguments.folders.back();
  settings.estimator_a = arguments.a;
  settings.estimator_b = arguments.b;
  const bool one_folder = arguments.folders.size() == 1;
  if (one_folder && (arguments.a.empty() || arguments.b.empty()))
    throw core::InputError(
        "compare: one folder alone needs two estimators: --a NAME and --b NAME; or give two folders");
  if (one_folder && arguments.a == arguments.b)
    throw core::InputError(
        fmt::format("compare: --a and --b are both '{}'; give two estimators, or two folders", arguments.a));
  // One of them named: the same one on the other side.
  if (settings.estimator_a.empty()) settings.estimator_a = arguments.b;
  if (settings.estimator_b.empty()) settings.estimator_b = arguments.a;
  settings.metrics = arguments.metrics;
  settings.case_name = arguments.case_name;
  settings.drives = !arguments.out.empty();
  return settings;
}

void write(const std::string& file, const std::string& text) {
  const fs::path path = file;
  if (path.has_parent_path()) fs::create_directories(path.parent_path());
  core::write_file(path, text);
}

}  // namespace

int compare_command(const CompareArguments& arguments, const CommonArguments& common) {
  const CompareSettings settings = settings_of(arguments);
  const Console console(common.quiet);
  reports::CompareInput input = compare_folders(settings, console.progress("compare"));
  input.command = shell_command(common.words);
  if (!arguments.out.empty()) write(arguments.out, reports::assemble_compare_page(input));
  if (!arguments.markdown.empty()) {
    const fs::path page = arguments.out;
    write(arguments.markdown, reports::compare_markdown(input, page.filename().string()));
  }
  print_comparison(input, common.json);
  for (const std::string& file : {arguments.out, arguments.markdown})
    if (!file.empty()) console.say(file);
  return 0;
}

}  // namespace tarmac::tools
