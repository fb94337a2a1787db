#include "tools/tarmac/store_filter.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/config.h"
#include "core/error.h"
#include "metrics/registry.h"

namespace tarmac::tools {
namespace {

using Words = std::vector<std::string>;

constexpr std::size_t kListed = 20;

std::string listed(const Words& known) {
  if (known.empty()) return "there is none";
  const Words first(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(std::min(kListed, known.size())));
  return fmt::format("there {} {}{}", known.size() == 1 ? "is" : "are", fmt::join(first, ", "),
                     known.size() > kListed ? fmt::format(" and {} more", known.size() - kListed) : "");
}

/// Throws unless each word is known.
void check(const std::string& option, const Words& words, const Words& known, const Words& also_known = {}) {
  for (const std::string& word : words) {
    if (std::find(known.begin(), known.end(), word) != known.end()) continue;
    if (std::find(also_known.begin(), also_known.end(), word) != also_known.end()) continue;
    Words all = known;
    all.insert(all.end(), also_known.begin(), also_known.end());
    const std::string guess = core::did_you_mean(word, all);
    throw core::InputError(fmt::format("{} {}: the store knows none of that name{}; {}", option, word,
                                       guess.empty() ? "" : fmt::format(" (did you mean '{}'?)", guess),
                                       listed(known)));
  }
}

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

void check_parameter(const scenarios::Store& store, const scenarios::Override& parameter) {
  check("--where", {parameter.first}, store.distinct("parameter"));
  Words values;
  for (const auto& row :
       store.query("select distinct value from parameters where path = " + quoted(parameter.first)).rows)
    values.push_back(row[0].value_or(""));
  check(fmt::format("--where {} =", parameter.first), {parameter.second}, values);
}

Words registered_metrics() {
  Words names;
  for (const auto& metric : metrics::metrics()) names.emplace_back(metric.name);
  return names;
}

}  // namespace

scenarios::ResultFilter store_filter(const scenarios::Store& store, const TableArguments& arguments) {
  scenarios::ResultFilter filter;
  filter.scenarios = arguments.scenarios;
  filter.cases = arguments.cases;
  filter.estimators = arguments.estimators;
  filter.statuses = arguments.statuses;
  filter.metrics = arguments.metrics;
  check("--scenario", filter.scenarios, store.distinct("scenario"));
  check("--case", filter.cases, store.distinct("case"));
  check("--estimator", filter.estimators, store.distinct("estimator"));
  check("--metrics", filter.metrics, store.distinct("metric"), registered_metrics());
  // That no cell ended so is an answer.
  Words statuses(scenarios::kOutcomeStatuses.begin(), scenarios::kOutcomeStatuses.end());
  statuses.insert(statuses.end(), {"pending", "running"});
  check("--status", filter.statuses, store.distinct("status"), statuses);
  if (!arguments.seeds.empty()) filter.seeds = scenarios::parse_seeds(arguments.seeds);
  for (const std::string& text : arguments.where) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
      throw core::InputError(fmt::format("--where {}: expected key=value, such as motion.peak=3", text));
    filter.parameters.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    check_parameter(store, filter.parameters.back());
  }
  return filter;
}

}  // namespace tarmac::tools
