#pragma once

#include "planner/app/benchmark_arguments.h"

namespace corridor::app {

/// `corridor benchmark --merge`: puts the runs of one campaign in several files together, and
/// writes them and all reports into the folder `a.output`, which must have no runs yet. @returns
/// the exit status. @throws InputError if a file can't be used or written.
int mergeCampaigns(const BenchmarkArguments& a);

}  // namespace corridor::app
