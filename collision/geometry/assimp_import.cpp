#include "collision/geometry/assimp_import.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <sys/stat.h>
#include <vector>

#include <Eigen/Geometry>
#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "collision/core/spelling.h"

/// Replaces assimp's handler of failed assertions, which would end the program. Debian's assimp is
/// built with assertions, and some damaged files violate an assertion. The dynamic linker finds
/// this definition first, because the program precedes assimp in the symbol search order. An
/// exception is safe here: assimp's importers also throw exceptions for errors, and clean up.
namespace Assimp {
ASSIMP_API void aiAssertViolation(const char* expression, const char*, int) {
  throw std::runtime_error(std::string("assimp's assertion fails: ") + expression);
}
}  // namespace Assimp

namespace corridor {
namespace {

Eigen::Affine3d inDoubles(const aiMatrix4x4& m) {
  Eigen::Affine3d map;
  map.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, 0, 0, 0,
      1;
  return map;
}

/// Adds the meshes of a node and of its children, under the maps of the nodes.
void addNode(const aiScene& scene, const aiNode& node, const Eigen::Affine3d& parent,
             TriangleMesh& to) {
  const Eigen::Affine3d map = parent * inDoubles(node.mTransformation);
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& from = *scene.mMeshes[node.mMeshes[i]];
    const auto first = static_cast<std::uint32_t>(to.vertices.size());
    for (unsigned k = 0; k < from.mNumVertices; ++k) {
      const aiVector3D& v = from.mVertices[k];
      to.vertices.push_back(map * Vec3(v.x, v.y, v.z));
    }
    for (unsigned k = 0; k < from.mNumFaces; ++k) {
      const aiFace& face = from.mFaces[k];
      if (face.mNumIndices != 3) continue;  // lines and points; polygons are cut by the import
      for (const unsigned corner : {face.mIndices[0], face.mIndices[1], face.mIndices[2]})
        if (corner >= from.mNumVertices)
          throw std::runtime_error("a face has a corner that is out of range");
      to.triangles.push_back(
          {first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) addNode(scene, *node.mChildren[i], map, to);
}

std::string oneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

/// Opens ordinary files only, and reports all others as missing. This rule also applies to files to
/// which the mesh file refers, such as the buffers of a glTF file. Adds each such file to `opened`,
/// except those of OBJ, which are materials.
class OrdinaryFiles : public Assimp::DefaultIOSystem {
 public:
  OrdinaryFiles(const std::string& file, std::vector<std::string>& opened)
      : file_(file), opened_(opened) {}

  bool Exists(const char* file) const override {  // assimp's own version would open the file
    struct stat status {};
    return ::stat(file, &status) == 0 && S_ISREG(status.st_mode);
  }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    std::string file = name;
    if (const std::size_t folder = file_.rfind('/') + 1;  // 0 without a folder
        file != file_ && file.starts_with(file_.substr(0, folder))) {
      // By the format, the name is encoded. Some programs write it as it is.
      file = file_.substr(0, folder) + percentDecoded(file.substr(folder));
      if (!Exists(file.c_str())) file = name;
    }
    if (!Exists(file.c_str())) return nullptr;
    if (file != file_ && !isObj_ &&
        std::find(opened_.begin(), opened_.end(), file) == opened_.end())
      opened_.emplace_back(file);
    return Assimp::DefaultIOSystem::Open(file.c_str(), mode);
  }

 private:
  const std::string& file_;
  std::vector<std::string>& opened_;
  const bool isObj_ = lowered(std::filesystem::path(file_).extension().string()) == ".obj";
};

/// Returns whether an importer reads files of an extension such as ".dae".
bool readsExtension(const aiImporterDesc& description, const std::string& extension) {
  std::string_view rest = description.mFileExtensions;  // "dae zae"
  while (!rest.empty()) {
    const std::string_view one = rest.substr(0, rest.find(' '));
    if (one == std::string_view(extension).substr(1)) return true;
    rest.remove_prefix(std::min(rest.size(), one.size() + 1));
  }
  return false;
}

/// Removes every importer that does not read files of the extension. Otherwise assimp would offer a
/// file with unexpected content to every importer.
void removeOtherFormats(Assimp::Importer& importer, const std::string& extension) {
  std::vector<Assimp::BaseImporter*> others;
  for (std::size_t i = 0; i < importer.GetImporterCount(); ++i)
    if (const aiImporterDesc* const description = importer.GetImporterInfo(i);
        !description || !readsExtension(*description, extension))
      others.push_back(importer.GetImporter(i));
  for (Assimp::BaseImporter* const other : others) {
    importer.UnregisterLoader(other);
    const std::unique_ptr<Assimp::BaseImporter> end(other);
  }
}

void read(const std::string& file, AssimpImport& result) {
  Assimp::Importer importer;
  removeOtherFormats(importer, lowered(std::filesystem::path(file).extension().string()));
  importer.SetIOHandler(  // the importer owns it
      std::make_unique<OrdinaryFiles>(file, result.otherFiles).release());
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  importer.ReadFile(file, aiProcess_GenNormals | aiProcess_Triangulate |
                              aiProcess_JoinIdenticalVertices | aiProcess_SortByPType |
                              aiProcess_OptimizeGraph);
  const aiScene* const scene = importer.GetScene();
  if (scene && scene->mRootNode)
    return addNode(*scene, *scene->mRootNode, Eigen::Affine3d::Identity(), result.mesh);
  result.error = oneLine(importer.GetErrorString());
  if (result.error.empty()) result.error = "assimp finds no scene in it";
}

}  // namespace

AssimpImport importByAssimp(const std::string& file) {
  AssimpImport result;
  try {
    read(file, result);
  } catch (const std::exception& error) {
    result.error = oneLine(error.what());
  } catch (...) {
    result.error = "assimp gave up without a reason";
  }
  return result;
}

}  // namespace corridor
