#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "collision/core/error.h"
#include "planner/robot/placed_shape.h"
#include "planner/robot/urdf_file.h"

namespace corridor {

/// Reads the mesh files that a URDF names, each file once.
class MeshStore {
 public:
  /// The file that a mesh name in a URDF stands for.
  struct FoundMesh {
    std::filesystem::path file;
    std::string complaint;  ///< empty if the file was read, or if its fault was reported before
  };

  /// @param files receives each file when it is first named, whether it exists or not, and the
  /// other files that mesh files name.
  MeshStore(const std::filesystem::path& urdf, const UrdfRules& rules,
            std::vector<std::filesystem::path>& files);

  /// Finds and reads the mesh that the URDF calls `name`. Reads each file only once. Adds the file
  /// to the list `files` of the constructor.
  FoundMesh add(const std::string& name);
  /// Returns the names of files whose up-axis is not z, and is not applied. @param ofCollada of
  /// Collada files, whose up-axes are applied if the rules say so, or of others
  std::vector<std::string> ignoredUpAxes(bool ofCollada) const;
  /// Returns the packages that were not found by their names, but whose meshes were found in a
  /// folder of another name above the URDF. Each package is mapped to that folder.
  const std::map<std::string, std::filesystem::path>& guessedPackages() const { return guessed_; }
  /// Returns whether the folder that was guessed for a package is also the folder in which files of
  /// another package were found. If both packages have files of the same names, the meshes may then
  /// belong to the other package. @pre `guessedPackages` has the package.
  bool isDoubtful(const std::string& package) const;
  /// Returns the note on names that begin with package:///, or "". Other readers, such as
  /// Pinocchio, accept such names, too.
  std::string noteOnSlashes() const;
  /// Returns a mesh file that was read. @pre `add` returned `file`, and could read the file.
  const std::shared_ptr<const MeshFile>& get(const std::filesystem::path& file) const {
    return meshes_.at(file);
  }

 private:
  struct Folder {
    std::filesystem::path path;
    std::string package;  ///< the name of the package, if this folder is its root
    bool hasPackageXml = false;
  };
  /// Returns the folders that contain the URDF, the innermost first, except the root of the file
  /// system.
  const std::vector<Folder>& foldersAbove();
  FoundMesh locate(const std::string& name);
  FoundMesh inPackage(const std::string& name);

  std::filesystem::path folder_;
  const UrdfRules& rules_;
  std::vector<std::filesystem::path>& files_;
  /// The folders of each package that was searched for on ROS's paths.
  std::map<std::string, std::vector<std::filesystem::path>> rosFolders_;
  std::vector<Folder> above_;                             // see `foldersAbove`
  std::set<std::filesystem::path> foundByName_;           // folders found by a package's name
  std::map<std::string, std::filesystem::path> guessed_;  // see `guessedPackages`
  std::set<std::string> missing_;                         // packages without a folder, reported
  std::size_t threeSlashes_ = 0;   // number of names that begin with package:///
  std::string firstThreeSlashes_;  // the first of these names
  std::map<std::filesystem::path, std::shared_ptr<const MeshFile>> meshes_;  // null: unreadable
};

}  // namespace corridor
