#pragma once

#include "planner/robot/robot_description.h"
#include "planner/robot/srdf_names.h"
#include "planner/robot/xml_file.h"

namespace corridor {

/// Internal to readSrdf(): reads <group> and <group_state> of the root element, as MoveIt does
/// (srdfdom). Faults within a group or state are removed from the file's list of faults and become
/// notes. The first of these faults is the reason why the group or state can't be used.
void readSrdfGroups(XmlFile& file, SrdfNames& names, RobotDescription& model);

}  // namespace corridor
