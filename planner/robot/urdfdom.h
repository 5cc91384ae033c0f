#pragma once

#include <string>
#include <urdf_world/types.h>
#include <vector>

#include "planner/robot/xml_file.h"

/// Not for users of the library: it brings urdfdom.
namespace corridor {

/// What urdfdom makes of a robot, but for visuals and materials, which nobody here looks at (and
/// which are removed from `robot`). nullptr where it prints an error: `errors` has it.
///
/// urdfdom prints by console_bridge, which is global: one thread at a time.
urdf::ModelInterfaceSharedPtr parseByUrdfdom(XmlFile::Element& robot,
                                             std::vector<std::string>& errors);

/// A name as it has it (see urdfdom.cpp).
std::string urdfdomName(std::string name);

}  // namespace corridor
