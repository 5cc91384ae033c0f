#pragma once

#include "planner/problem/ini_file.h"
#include "planner/problem/problem.h"

namespace corridor {

/// Reads the section `planner` of an OMPL.app file. If the section names exactly one planner that
/// OMPL has, and names it once, the problem gets this planner and its parameters. Otherwise the
/// problem keeps the default planner. Notes list the planners if there are several, and the
/// planners that OMPL does not have.
void readOmplAppPlanners(const IniFile& ini, Problem& problem);

/// Sets the problem's sampler to the one that an entry names. An unknown name is a fault.
void readSampler(const IniFile& ini, const IniFile::Entry& entry, Problem& problem);

}  // namespace corridor
