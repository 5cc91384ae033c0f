#include "planner/robot/mesh_store.h"

#include <algorithm>

#include "collision/core/read_file.h"
#include "collision/core/spelling.h"

namespace corridor {
namespace {

constexpr std::string_view packageScheme = "package://", fileScheme = "file://";

MeshStore::Place checked(const std::filesystem::path& file) {
  const std::string why = whyNoFile(file);
  return {file, why.empty() ? "" : file.string() + ": " + why};
}

}  // namespace

MeshStore::MeshStore(const std::filesystem::path& urdf, const PackageMap& packages,
                     std::vector<std::filesystem::path>& files)
    : folder_(urdf.parent_path()), packages_(packages), files_(files) {}

MeshStore::Place MeshStore::inPackage(const std::string& name) const {
  const std::string inside = name.substr(packageScheme.size());
  const std::size_t slash = inside.find('/');
  if (slash == 0 || slash == inside.npos || slash + 1 == inside.size())
    return {{}, "package://NAME/FILE is needed"};
  const std::string package = inside.substr(0, slash);
  const std::filesystem::path rest =
      std::filesystem::path(inside.substr(slash + 1)).relative_path();
  if (const auto known = packages_.find(package); known != packages_.end())
    return checked((known->second / rest).lexically_normal());

  const std::filesystem::path beside = (folder_ / package / rest).lexically_normal();
  if (whyNoFile(beside).empty()) return {beside, ""};
  // The usual layout of a package is PACKAGE/urdf/robot.urdf.
  const std::filesystem::path absolute =
      std::filesystem::absolute(folder_.empty() ? "." : folder_).lexically_normal();
  for (std::filesystem::path above = absolute; above != above.root_path();
       above = above.parent_path())
    if (above.filename() == package && whyNoFile(above / rest).empty()) return {above / rest, ""};
  std::vector<std::string> names;
  for (const auto& entry : packages_) names.push_back(entry.first);
  const std::string near = didYouMean(package, names);
  return {beside,
          beside.string() + " is not a file, and package " + quotedWord(package) +
              " has no folder" +
              (near.empty() ? "; add robot.yaml: packages: {" + package + ": FOLDER}" : near)};
}

MeshStore::Place MeshStore::locate(const std::string& name) const {
  if (name.starts_with(packageScheme)) return inPackage(name);
  if (name.starts_with(fileScheme)) {
    const std::filesystem::path file = name.substr(fileScheme.size());
    if (!file.is_absolute()) return {{}, "file:///FOLDER/FILE is needed"};
    return checked(file.lexically_normal());
  }
  if (name.find("://") != name.npos)
    return {{}, "a file beside the URDF, package://NAME/FILE or file:///FILE is needed"};
  return checked((folder_ / name).lexically_normal());
}

MeshStore::Place MeshStore::add(const std::string& name) {
  Place place = locate(name);
  if (!place.file.empty() && std::find(files_.begin(), files_.end(), place.file) == files_.end())
    files_.push_back(place.file);
  if (!place.complaint.empty() || meshes_.contains(place.file)) return place;
  std::optional<MeshFile>& mesh = meshes_[place.file];
  try {
    mesh = readMeshFile(place.file);
  } catch (const InputError& error) {
    place.complaint = error.faults().front().str();
    if (const std::size_t more = error.faults().size() - 1)
      place.complaint += " (and " + std::to_string(more) + " more)";
  }
  return place;
}

}  // namespace corridor
