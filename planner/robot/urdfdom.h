#pragma once

#include <string>
#include <urdf_world/types.h>
#include <vector>

#include "planner/robot/xml_file.h"

/// Internal: this header includes urdfdom's headers, which users of the library don't need.
namespace corridor {

/// Parses a robot with urdfdom. Visuals and materials are not needed; they are removed from `robot`
/// before parsing. Returns nullptr if urdfdom prints an error; the errors are appended to `errors`.
///
/// Threads take turns, because urdfdom prints through console_bridge, which is global.
urdf::ModelInterfaceSharedPtr parseByUrdfdom(XmlFile::Element& robot,
                                             std::vector<std::string>& errors);

/// Returns a link's or joint's name as urdfdom knows it, with each % replaced (urdfdom.cpp says
/// why).
std::string urdfdomName(std::string name);

}  // namespace corridor
