/// What a table is asked to show, checked against what there is.
#pragma once

#include "scenarios/store.h"
#include "tools/tarmac/commands.h"

namespace tarmac::tools {

/// The filter of a command line. Throws InputError with did-you-mean for a metric, case, estimator, scenario, status,
/// parameter or value that the store does not know. `metrics` are left as the arguments name them.
scenarios::ResultFilter store_filter(const scenarios::Store& store, const TableArguments& arguments);

}  // namespace tarmac::tools
