#pragma once

#include "planner/app/benchmark_arguments.h"

namespace corridor::app {

/// `corridor benchmark --merge`: puts databases of one campaign together in a new folder, with all
/// reports. @returns the exit status. @throws InputError
int mergeCampaigns(const BenchmarkArguments& a);

}  // namespace corridor::app
