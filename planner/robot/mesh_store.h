#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "collision/core/error.h"
#include "planner/robot/placed_shape.h"
#include "planner/robot/urdf_file.h"

namespace corridor {

/// The mesh files that a URDF names, each read once.
class MeshStore {
 public:
  /// Where a URDF's mesh may be.
  struct Place {
    std::filesystem::path file;
    std::string complaint;  ///< "": found
  };

  /// @param files gets each file when it is first named, found or not.
  MeshStore(const std::filesystem::path& urdf, const PackageMap& packages,
            std::vector<std::filesystem::path>& files);

  /// Finds and reads what a URDF calls `name`.
  Place add(const std::string& name);
  /// @pre added, and found. nullptr: unreadable, which is among `faults`.
  const MeshFile* find(const std::filesystem::path& file) const;
  /// Those of mesh files.
  const std::vector<Fault>& faults() const { return faults_; }

 private:
  Place locate(const std::string& name) const;
  Place inPackage(const std::string& name) const;

  std::filesystem::path folder_;
  const PackageMap& packages_;
  std::vector<std::filesystem::path>& files_;
  std::map<std::filesystem::path, std::optional<MeshFile>> meshes_;
  std::vector<Fault> faults_;
};

}  // namespace corridor
