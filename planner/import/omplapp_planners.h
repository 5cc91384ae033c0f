#pragma once

#include "planner/import/ini_file.h"
#include "planner/problem/problem.h"

namespace corridor {

/// Reads the section `planner` of an OMPL.app file. If the section names exactly one planner that
/// OMPL has, and names it once, the problem gets this planner with its parameters, and the sampler
/// and resolution that the section sets for it. Otherwise the problem keeps its planner. If there
/// are several planners, a note lists them. Another note lists the planners that OMPL does not
/// have.
void readOmplAppPlanners(const IniFile& ini, Problem& problem);

/// Sets the problem's sampler to the sampler that `entry` names. Adds a fault if the name is
/// unknown.
void readSampler(const IniFile& ini, const IniFile::Entry& entry, Problem& problem);

}  // namespace corridor
