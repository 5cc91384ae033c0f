#include "planner/robot/mesh_store.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "collision/core/read_file.h"
#include "collision/core/spelling.h"

namespace corridor {
namespace {

constexpr std::string_view packageScheme = "package://", fileScheme = "file://";

MeshStore::FoundMesh checked(const std::filesystem::path& file) {
  const std::string why = whyNotOrdinaryFile(file);
  return {file, why.empty() ? "" : file.string() + ": " + why};
}

std::vector<std::filesystem::path> foldersIn(const char* variable) {
  std::vector<std::filesystem::path> folders;
  const char* const value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): only read
  std::istringstream all(value ? value : "");
  for (std::string folder; std::getline(all, folder, ':');)
    if (!folder.empty()) folders.emplace_back(folder);
  return folders;
}

/// Returns the existing folders of a package that AMENT_PREFIX_PATH and ROS_PACKAGE_PATH lead to.
/// For each PREFIX in the former, this is PREFIX/share/PACKAGE. For each folder in the latter, it
/// is the folder, if its name is PACKAGE, and each folder PACKAGE up to three levels below: a
/// workspace contains repositories, which contain packages.
std::vector<std::filesystem::path> foldersOfPackage(const std::string& package) {
  std::vector<std::filesystem::path> found;
  const auto look = [&](const std::filesystem::path& folder) {
    std::error_code none;
    if (folder.filename() == package && std::filesystem::is_directory(folder, none))
      found.push_back(folder);
  };
  for (const auto& prefix : foldersIn("AMENT_PREFIX_PATH")) look(prefix / "share" / package);
  using Walk = std::filesystem::recursive_directory_iterator;
  constexpr int deepest = 2, mostEntries = 10'000;
  for (const auto& root : foldersIn("ROS_PACKAGE_PATH")) {
    look(root);
    std::error_code error;
    int entries = 0;
    Walk walk(root, std::filesystem::directory_options::skip_permission_denied, error);
    for (; !error && walk != Walk() && entries < mostEntries; walk.increment(error), ++entries) {
      std::error_code none;
      if (!walk->is_directory(none)) continue;
      if (walk->path().filename().string().starts_with('.')) {
        walk.disable_recursion_pending();
        continue;
      }
      look(walk->path());
      if (walk.depth() >= deepest) walk.disable_recursion_pending();
    }
  }
  return found;
}

/// Returns the name of the package whose root is this folder: the name in the folder's package.xml,
/// or the name of the folder if no name can be read there.
std::string packageNameOf(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "package.xml";
  if (!whyNotOrdinaryFile(file).empty()) return folder.filename().string();
  constexpr std::string_view begin = "<name>", end = "</name>", blanks = " \t\r\n";
  std::string text;
  try {
    text = readTextFile(file, "a ROS package");
  } catch (const InputError&) {
    return folder.filename().string();
  }
  const std::size_t from = text.find(begin), to = text.find(end);
  if (from == text.npos || to == text.npos || to < from) return folder.filename().string();
  const std::string name = text.substr(from + begin.size(), to - from - begin.size());
  const std::size_t first = name.find_first_not_of(blanks), last = name.find_last_not_of(blanks);
  return first == name.npos ? folder.filename().string() : name.substr(first, last - first + 1);
}

}  // namespace

MeshStore::MeshStore(const std::filesystem::path& urdf, const UrdfRules& rules,
                     std::vector<std::filesystem::path>& files)
    : folder_(urdf.parent_path()), rules_(rules), files_(files) {}

bool MeshStore::isDoubtful(const std::string& package) const {
  const std::filesystem::path& folder = guessed_.at(package);
  return foundByName_.contains(folder) ||
         std::any_of(guessed_.begin(), guessed_.end(), [&](const auto& other) {
           return other.first != package && other.second == folder;
         });
}

std::vector<std::string> MeshStore::ignoredUpAxes(bool ofCollada) const {
  std::vector<std::string> names;
  for (const auto& [file, mesh] : meshes_)
    if (mesh && mesh->isCollada == ofCollada && mesh->fileUp.value_or('z') != 'z' &&
        !(ofCollada && rules_.colladaUp))
      names.push_back(file.filename().string());
  return names;
}

std::string MeshStore::noteOnSlashes() const {
  if (threeSlashes_ == 0) return "";
  return "mesh " + quotedPath(firstThreeSlashes_) +
         (threeSlashes_ == 1 ? "" : " and " + std::to_string(threeSlashes_ - 1) + " more") +
         ": package:///NAME/FILE is read as package://NAME/FILE";
}

const std::vector<MeshStore::Folder>& MeshStore::foldersAbove() {
  if (!above_.empty()) return above_;
  auto folder = std::filesystem::absolute(folder_.empty() ? "." : folder_).lexically_normal();
  for (; folder.has_relative_path(); folder = folder.parent_path())  // without the root
    above_.push_back(
        {folder, packageNameOf(folder), whyNotOrdinaryFile(folder / "package.xml").empty()});
  return above_;
}

MeshStore::FoundMesh MeshStore::inPackage(const std::string& name) {
  std::string inside = name.substr(packageScheme.size());
  if (inside.starts_with('/') && inside.size() > 1) {
    inside.erase(0, 1);
    if (threeSlashes_++ == 0) firstThreeSlashes_ = name;
  }
  const std::size_t slash = inside.find('/');
  if (slash == 0 || slash == inside.npos || slash + 1 == inside.size())
    return {{}, "package://NAME/FILE is needed"};
  const std::string package = inside.substr(0, slash);
  const std::filesystem::path rest =
      std::filesystem::path(inside.substr(slash + 1)).relative_path();
  if (const auto known = rules_.packages.find(package); known != rules_.packages.end())
    return checked((known->second / rest).lexically_normal());

  const std::filesystem::path beside = (folder_ / package / rest).lexically_normal();
  if (whyNotOrdinaryFile(beside).empty()) return {beside, ""};
  // The usual layout of a package is PACKAGE/urdf/robot.urdf. The folders of other packages are
  // beside the folder PACKAGE.
  const std::vector<Folder>& above = foldersAbove();
  const auto found = [&](const std::filesystem::path& folder) -> FoundMesh {
    foundByName_.insert(folder);
    return {folder / rest, ""};
  };
  for (const Folder& folder : above)
    if (folder.package == package && whyNotOrdinaryFile(folder.path / rest).empty())
      return found(folder.path);
  auto known = rosFolders_.find(package);
  if (known == rosFolders_.end())
    known = rosFolders_.emplace(package, foldersOfPackage(package)).first;
  for (const std::filesystem::path& folder : known->second)
    if (whyNotOrdinaryFile(folder / rest).empty()) return found(folder);
  const auto lacks = [&](const std::filesystem::path& folder) -> FoundMesh {
    return {folder / rest, "package " + quotedWord(package) + " is found at " + folder.string() +
                               ", but has no " + rest.string()};
  };
  if (!known->second.empty()) return lacks(known->second.front());
  for (const Folder& folder : above)
    if (whyNotOrdinaryFile(folder.path / package / rest).empty())
      return found(folder.path / package);
  // A package may have been copied into a folder of another name, without its package.xml. All
  // files of the package are then in one folder.
  const auto guess = guessed_.find(package);
  for (const Folder& folder : above) {
    const bool isCandidate =
        guess == guessed_.end() ? !folder.hasPackageXml : guess->second == folder.path;
    if (!isCandidate || !whyNotOrdinaryFile(folder.path / rest).empty()) continue;
    guessed_.try_emplace(package, folder.path);
    return {folder.path / rest, ""};
  }
  for (const Folder& one : above)
    if (std::error_code none; std::filesystem::is_directory(one.path / package, none))
      return lacks(one.path / package);
  if (!missing_.insert(package).second) {  // reported before
    meshes_[beside];
    return {beside, ""};
  }
  std::vector<std::string> names;
  for (const auto& entry : rules_.packages) names.push_back(entry.first);
  const std::string near = didYouMean(package, names);
  return {beside,
          beside.string() + " is not a file, and no folder of package " + quotedWord(package) +
              " was found" +
              (near.empty()
                   ? "; add packages: {" + package +
                         ": FOLDER} to robot.yaml, or set ROS_PACKAGE_PATH or AMENT_PREFIX_PATH"
                   : near)};
}

MeshStore::FoundMesh MeshStore::locate(const std::string& name) {
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

MeshStore::FoundMesh MeshStore::add(const std::string& name) {
  // Names with a scheme are URIs, in which %20 is a blank. Some programs write them as they are.
  const std::string decoded = name.find("://") == name.npos ? name : percentDecoded(name);
  FoundMesh place = locate(decoded);
  if (!place.complaint.empty() && decoded != name)
    if (FoundMesh plain = locate(name); whyNotOrdinaryFile(plain.file).empty())
      place = std::move(plain);
  if (!place.file.empty() && std::find(files_.begin(), files_.end(), place.file) == files_.end())
    files_.push_back(place.file);
  if (!place.complaint.empty() || meshes_.contains(place.file)) return place;
  std::shared_ptr<const MeshFile>& mesh = meshes_[place.file];
  try {
    MeshFile read = readMeshFile(place.file, {}, rules_.cache);
    if (rules_.colladaUp && read.isCollada && read.fileUp != 'z')
      read = readMeshFile(place.file, {.up = read.fileUp}, rules_.cache);
    for (const std::string& other : read.otherFiles)
      if (std::find(files_.begin(), files_.end(), other) == files_.end()) files_.push_back(other);
    mesh = std::make_shared<const MeshFile>(std::move(read));
  } catch (const InputError& error) {
    place.complaint = error.faults().front().str();
    if (const std::size_t more = error.faults().size() - 1)
      place.complaint += " (and " + std::to_string(more) + " more)";
  }
  return place;
}

}  // namespace corridor
