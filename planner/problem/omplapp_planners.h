#pragma once

#include "planner/problem/ini_file.h"
#include "planner/problem/problem.h"

namespace corridor {

/// Reads the section `planner` of an OMPL.app file. Where it names exactly one planner that OMPL
/// has, once, that one is planned with, with its parameters; otherwise the default stays, and a
/// note says so.
void readOmplAppPlanners(const IniFile& ini, Problem& problem);

}  // namespace corridor
