#pragma once

#include <string>
#include <urdf_world/types.h>
#include <vector>

#include "planner/robot/xml_file.h"

/// Internal: this header includes urdfdom's headers, which users of the library don't need.
namespace corridor {

/// Parses a robot with urdfdom. First removes from `robot` all but the shapes, origins and axes,
/// since Corridor takes nothing else from urdfdom. Returns nullptr if urdfdom prints an error; the
/// errors are appended to `errors`.
///
/// Threads take turns, because urdfdom prints through console_bridge, which is global.
urdf::ModelInterfaceSharedPtr parseByUrdfdom(XmlFile::Element& robot,
                                             std::vector<std::string>& errors);

/// Returns the name that a link or joint has in urdfdom's model: each % is replaced by ?
/// (urdfdom.cpp gives the reason).
std::string urdfdomName(std::string name);

}  // namespace corridor
