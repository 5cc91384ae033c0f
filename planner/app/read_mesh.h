#pragma once

#include <optional>
#include <string>

#include "collision/geometry/mesh_file.h"

namespace corridor::app {

/// Reads a mesh file. @param unit of its coordinates: m, cm, mm, in. @param up its up-axis: x, y,
/// z.
MeshFile readMeshAs(const std::string& file, const std::optional<std::string>& unit,
                    const std::optional<std::string>& up);

/// Reads a mesh file, and prints its notes on stderr, each with the file's name.
MeshFile readMeshAndPrintNotes(const std::string& file);

}  // namespace corridor::app
