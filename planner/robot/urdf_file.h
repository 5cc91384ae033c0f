#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "collision/core/error.h"
#include "planner/robot/robot_description.h"

namespace corridor {

class FileCache;

/// Folders by package name, for names such as `package://NAME/…` in a URDF. If a package is not
/// listed, the reader searches for the file in these folders, in this order:
/// - the folder NAME beside the URDF;
/// - the folders that contain the URDF and are the root of package NAME. The package's name is
///   taken from the package.xml of the folder, or is the folder's name if there is no package.xml;
/// - the package's folders to which the environment variables AMENT_PREFIX_PATH and
///   ROS_PACKAGE_PATH lead; if there are such folders, the search ends with them;
/// - a folder NAME in a folder that contains the URDF;
/// - a folder without package.xml that contains the URDF (`MeshStore::guessedPackages`).
using PackageMap = std::map<std::string, std::filesystem::path>;

/// The rules for reading a URDF.
struct UrdfRules {
  PackageMap packages = {};
  /// If true, a link without <collision> gets the geometry of its <visual>. If false, such a link
  /// has no shape, and a note names it.
  bool visualsCollide = false;
  /// If true, the soft limits of <safety_controller> narrow the limits of the joint. If false, a
  /// note names the joints whose soft limits are narrower.
  bool softLimits = false;
  /// If true, the <up_axis> of Collada files is applied. If false, it is ignored, which is ROS's
  /// rule, and a note names the files whose up-axis is not z.
  bool colladaUp = false;
  std::vector<std::string> xacro = {};  ///< arguments for a .xacro file: "prefix:=left_"
  /// Where meshes are looked for before they are read (`readMeshFile`); null: none.
  FileCache* cache = nullptr;
};

/// Returns whether a file is a URDF: one whose name ends in .urdf or .xacro, in capitals or not, or
/// one whose name ends in .xml, or has no extension, and whose first element is <robot>.
bool isUrdf(const std::filesystem::path& file);

/// Reads a URDF with its collision geometry. urdfdom parses the file; this function also reports
/// faults that urdfdom accepts.
///
/// All faults are appended to `faults`, with file and line. The result is nullopt if the URDF has a
/// fault. The URDF and every mesh file are appended to `files`, in the order in which they are
/// first named.
/// @param notesOfFaulty receives the notes if the result is nullopt; otherwise the notes are in the
/// model.
std::optional<RobotDescription> readUrdf(const std::filesystem::path& file, const UrdfRules& rules,
                                         std::vector<Fault>& faults,
                                         std::vector<std::filesystem::path>& files,
                                         std::vector<Note>* notesOfFaulty = nullptr);

/// Reads an SRDF into `model`: groups (joints, links, chains, subgroups), named states, and
/// disabled collisions with their reasons. End effectors are ignored. Virtual joints are not used;
/// a note names each planar or floating one.
///
/// Only a file that can't be read at all is a fault. Names that the model lacks, and elements that
/// can't be used, are not faults but notes, since other readers of SRDF accept them, too. A group
/// with unknown members consists of its other members (`JointGroup::missing`). A group or state
/// that can't be used is kept with the reason (`unusable`); it is a fault only in a problem that
/// names it.
/// @param xacro arguments for a .xacro file.
void readSrdf(const std::filesystem::path& file, RobotDescription& model,
              std::vector<Fault>& faults, const std::vector<std::string>& xacro = {});

}  // namespace corridor
