#pragma once

#include "planner/app/benchmark_arguments.h"

namespace corridor::app {

/// `corridor benchmark --merge`: merges databases of one campaign into one database, and writes
/// this database and all reports into the folder `a.output`. A database that is already in this
/// folder must have no runs. @returns the exit status. @throws InputError if a database can't be
/// used, or a file can't be written.
int mergeCampaigns(const BenchmarkArguments& a);

}  // namespace corridor::app
