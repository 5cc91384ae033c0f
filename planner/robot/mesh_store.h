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
    std::string complaint;  ///< "": found, and read; or unreadable, and told before
  };

  /// @param files gets each file when it is first named, found or not.
  MeshStore(const std::filesystem::path& urdf, const PackageMap& packages,
            std::vector<std::filesystem::path>& files);

  /// Finds and reads what a URDF calls `name`.
  Place add(const std::string& name);
  /// @pre added, without complaint.
  const MeshFile& get(const std::filesystem::path& file) const { return *meshes_.at(file); }

 private:
  Place locate(const std::string& name) const;
  Place inPackage(const std::string& name) const;

  std::filesystem::path folder_;
  const PackageMap& packages_;
  std::vector<std::filesystem::path>& files_;
  std::map<std::filesystem::path, std::optional<MeshFile>> meshes_;  // none: unreadable
};

}  // namespace corridor
