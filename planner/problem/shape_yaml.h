#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "planner/problem/placement.h"
#include "planner/robot/placed_shape.h"

/// Readers of the shapes of robots and obstacles in problem and robot files.
namespace corridor {

/// The context in which a shape is read.
struct ShapePlace {
  std::string name;              ///< the shape's name
  std::filesystem::path folder;  ///< the folder that file names are relative to
  Placement outer = {};          ///< the placement of the obstacle that lists the shape in `shapes`
  bool isPlanar = false;  ///< the shape belongs to an SE2 robot, or to a world in which all robots
                          ///< are SE2 robots
};

/// Reads the meshes of shapes. A file is read once for each unit and up-axis.
class ShapeMeshes {
 public:
  /// Returns the mesh in `file`, with the unit and up-axis of `map` applied. `key` is the key that
  /// names the file, for faults. Returns null if a fault was added for this mesh, now or earlier.
  std::shared_ptr<const MeshFile> read(const YamlMap& map, const char* key,
                                       const std::filesystem::path& file);
  /// Returns why the mesh can't be solid, or "".
  const std::string& whyNotWatertight(const std::shared_ptr<const MeshFile>& mesh);

 private:
  using Options = std::pair<std::optional<double>, std::optional<char>>;  // unit and up-axis
  std::map<std::pair<std::filesystem::path, Options>, std::shared_ptr<const MeshFile>> meshes_;
  std::map<std::shared_ptr<const MeshFile>, std::string> whyNotWatertight_;
};

/// The files that shapes name.
struct ShapeFiles {
  std::vector<std::filesystem::path>& files;  ///< in the order in which shapes name them
  ShapeMeshes meshes = {};
};

/// Reads a shape of any kind (mesh, primitive, polygon, cloud or map), and applies unit, up-axis
/// and placement. Returns nullopt if a fault was added.
/// @param files gets the shape's file, if it has one.
/// @param notApplied if not null, and the shape is a mesh (not its hull), the placement is stored
/// here instead of being applied to the vertices.
std::optional<PlacedShape> readShape(const YamlMap& map, const ShapePlace& place, ShapeFiles& files,
                                     Placement* notApplied = nullptr);

/// Applies a placement to the vertices of a mesh. Returns false if a fault was added.
bool applyPlacement(const YamlMap& map, const Placement& placement, PlacedShape& shape);

/// Reads the list `shapes` of a robot or an obstacle. If there is one shape, its name is
/// `place.name`. If there are several, the name of each is `place.name`, a slash, and the shape's
/// own name or its number, counted from 1. Shapes with faults are left out. @pre the map has
/// `shapes`.
/// @param keys the legal keys of one shape.
std::vector<PlacedShape> readShapes(const YamlMap& map, const MapKeys& keys,
                                    const ShapePlace& place, ShapeFiles& files);

/// Translates a shape. Returns "", or the reason why the shape can't be moved; parts of it may then
/// be moved already.
std::string shift(PlacedShape& shape, const Vec3& by);

/// Adds a file to the list, unless the list already has it.
void addFile(std::vector<std::filesystem::path>& files, const std::filesystem::path& file);

}  // namespace corridor
