#include "collision/geometry/assimp_import.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
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
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "collision/core/read_file.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "collision/geometry/assimp_content.h"
#include "collision/geometry/assimp_content_scene.h"
#include "collision/geometry/mesh_limits.h"

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

/// Bounds along the path from the root to a node: `scale` of how much its maps stretch, `length` of
/// the sum of its translations without signs, in the units of the file, `rounding` of the relative
/// error of the numbers and of the products of transforms.
struct Path {
  Eigen::Affine3d map = Eigen::Affine3d::Identity();
  double scale = 1, length = 0, rounding = 2 * kNumberRounding;

  Path below(const aiNode& node, const ContentReport& report) const {
    const Eigen::Affine3d step = inDoubles(node.mTransformation);
    const double own = step.translation().norm() + (report.isText ? kLostLength : 0);
    return {map * step, scale * step.linear().jacobiSvd().singularValues()[0],
            length + scale * std::max(own, report.node.length),
            rounding + std::max(kNumberRounding, report.node.rounding)};
  }
};

/// The rounding of a mesh that is the largest in parts of the mesh's size.
struct Rounding {
  double error = 0;  ///< in units of the file
  double share = 0;  ///< of the mesh's size
};

class SceneReader {
 public:
  SceneReader(const aiScene& scene, const ContentReport& report, AssimpImport& import)
      : scene_(scene), report_(report), import_(import) {}

  void read() { addNode(*scene_.mRootNode, {}); }
  bool hasLines() const { return hasLines_; }
  const Rounding& rounding() const { return rounding_; }

 private:
  void addNode(const aiNode& node, const Path& parent) {
    const Path path = parent.below(node, report_);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) addMesh(*scene_.mMeshes[node.mMeshes[i]], path);
    for (unsigned i = 0; i < node.mNumChildren; ++i) addNode(*node.mChildren[i], path);
  }

  /// Adds a mesh of the scene; polygons become fans.
  void addMesh(const aiMesh& from, const Path& path) {
    TriangleMesh& to = import_.mesh;
    const auto first = static_cast<std::uint32_t>(to.vertices.size());
    for (unsigned i = 0; i < from.mNumVertices; ++i) {
      const aiVector3D& v = from.mVertices[i];
      to.vertices.push_back(path.map * Vec3(v.x, v.y, v.z));
    }
    Eigen::AlignedBox3d box;
    double farthest = 0;  // of the vertices of faces, in the mesh's own frame
    for (unsigned i = 0; i < from.mNumFaces; ++i) {
      const aiFace& face = from.mFaces[i];
      if (face.mNumIndices < 3) {
        hasLines_ = true;
        continue;
      }
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        const unsigned corner = face.mIndices[k];
        if (corner >= from.mNumVertices)
          throw std::runtime_error("a face has a corner that is out of range");
        const aiVector3D& v = from.mVertices[corner];
        farthest = std::max(farthest, Vec3(v.x, v.y, v.z).norm());
        box.extend(to.vertices[first + corner]);
      }
      if (face.mNumIndices > 3)
        import_.polygons.push_back(
            {static_cast<std::uint32_t>(to.triangles.size()), face.mNumIndices - 2, 0, 0});
      for (unsigned k = 2; k < face.mNumIndices; ++k)
        to.triangles.push_back(
            {first + face.mIndices[0], first + face.mIndices[k - 1], first + face.mIndices[k]});
    }
    if (!box.isEmpty()) judge(path, farthest, box.diagonal().norm());
  }

  /// Bounds the rounding of a mesh: each length on the way from the root to a vertex goes through
  /// all the roundings on this way, at most. @param extent the size of the mesh
  void judge(const Path& path, double farthest, double extent) {
    const double sum = path.scale * farthest + path.length;
    const double lost = report_.isText ? 2 * kMostLostDecimals : 0;
    const double error = path.rounding * sum + lost * path.scale;
    if (error == 0) return;  // all vertices are the origin
    const double share = extent > 0 && error <= HUGE_VAL ? error / extent : HUGE_VAL;
    if (share > rounding_.share) rounding_ = {error, share};
  }

  const aiScene& scene_;
  const ContentReport& report_;
  AssimpImport& import_;
  bool hasLines_ = false;
  Rounding rounding_;
};

/// Returns the number that the file most likely has, if assimp has stored it as the float `value`:
/// the shortest decimal that rounds to that float.
double shortestDecimal(float value) {
  char text[32];
  const char* const end = std::to_chars(text, text + sizeof text, value).ptr;
  double written = value;
  std::from_chars(text, end, written);
  return written;
}

/// Checks the transform of the root node of a Collada scene. assimp puts Collada's unit and up-axis
/// there. A unit that is 0, or too small for assimp's floats, would shrink the mesh to a point. A
/// negative unit would mirror the mesh. Under OMPL.app's rules a mirrored mesh is accepted, because
/// the mirroring may come from a node of the file that OMPL.app's import steps have merged into the
/// root. @throws std::runtime_error if the transform shrinks the mesh to a point; under `Stored`,
/// also if it mirrors the mesh.
void checkColladaRoot(const aiScene& scene, AssimpRules rules) {
  const double volume = inDoubles(scene.mRootNode->mTransformation).linear().determinant();
  if (!(volume > 0 || (volume < 0 && rules != AssimpRules::Stored)))
    throw std::runtime_error("its <unit> is not above 0, or too small");
}

/// Returns the file's unit in metres, or 0 if the format has none. assimp puts Collada's unit into
/// the root's transform. If this transform is nothing but the unit, this function sets it to the
/// identity and returns the unit. Otherwise it leaves the transform as it is and returns 1.
double takeFileUnit(aiScene& scene, const std::string& format) {
  if (format.starts_with("Collada")) {
    aiMatrix4x4& root = scene.mRootNode->mTransformation;
    const float unit = root.a1;
    if (!(unit > 0) || root != aiMatrix4x4(unit, 0, 0, 0, 0, unit, 0, 0, 0, 0, unit, 0, 0, 0, 0, 1))
      return 1;
    root = aiMatrix4x4();
    return shortestDecimal(unit);
  }
  return format.starts_with("glTF") ? 1 : 0;
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
      file = file_.substr(0, folder) + decoded(file.substr(folder));
      if (!Exists(file.c_str())) file = name;
    }
    if (!Exists(file.c_str())) return nullptr;
    if (file != file_ && !isObj_ &&
        std::find(opened_.begin(), opened_.end(), file) == opened_.end())
      opened_.emplace_back(file);
    return Assimp::DefaultIOSystem::Open(file.c_str(), mode);
  }

 private:
  /// Returns a name with the bytes that URIs write as %20 and the like, which assimp does not
  /// decode.
  static std::string decoded(std::string name) {
    for (auto at = name.find('%'); at != name.npos; at = name.find('%', at + 1)) {
      unsigned char byte = 0;
      const char* const digits = name.data() + at + 1;
      if (at + 3 > name.size() || std::from_chars(digits, digits + 2, byte, 16).ptr != digits + 2 ||
          byte == 0)
        continue;
      name.replace(at, 3, 1, static_cast<char>(byte));
    }
    return name;
  }

  const std::string& file_;
  std::vector<std::string>& opened_;
  const bool isObj_ = lowered(std::filesystem::path(file_).extension().string()) == ".obj";
};

/// Makes faults of the messages in assimp's log that say that it left out geometry.
class DropLog : public Assimp::LogStream {
 public:
  DropLog(const std::string& file, ContentReport& report) : file_(file), report_(report) {}
  void write(const char* message) override {
    const std::string text = oneLine(message);
    for (const char* const sign :
         {"Unable to resolve reference to instanced node", "Unresolved reference format of node",
          "Unable to find geometry for ID", "long message discarded",
          "TRIANGLES mode. Some vertices were dropped"})
      if (const auto at = text.find(sign); at != text.npos)
        report_.fault(file_, 0, "assimp leaves out geometry: " + text.substr(at));
  }

 private:
  const std::string& file_;
  ContentReport& report_;
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

/// Reads a file, unless a fault of its content is found first.
void read(const std::string& file, AssimpRules rules, AssimpImport& result, ContentReport& report) {
  const std::string extension = lowered(std::filesystem::path(file).extension().string());
  const ContentKind kind = contentKindOf(extension);
  if (kind != ContentKind::Other) checkContent(kind, file, readFile(file, "a mesh file"), report);
  if (!report.faults.empty()) return;
  Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
  Assimp::DefaultLogger::get()->attachStream(std::make_unique<DropLog>(file, report).release(),
                                             Assimp::Logger::Warn | Assimp::Logger::Err);
  Assimp::Importer importer;
  removeOtherFormats(importer, extension);
  importer.SetIOHandler(  // the importer owns it
      std::make_unique<OrdinaryFiles>(file, result.otherFiles).release());
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION,
                           rules == AssimpRules::Stored);
  const unsigned steps = rules == AssimpRules::OmplApp
                             ? aiProcess_GenNormals | aiProcess_Triangulate |
                                   aiProcess_JoinIdenticalVertices | aiProcess_SortByPType |
                                   aiProcess_OptimizeGraph
                             : 0u;
  importer.ReadFile(file, steps);
  const aiScene* const scene = importer.GetScene();
  if (!scene || !scene->mRootNode) {
    result.error = oneLine(importer.GetErrorString());
    if (result.error.empty()) result.error = "assimp finds no scene in it";
    return;
  }
  const aiImporterDesc* const description = importer.GetImporterInfo(
      static_cast<std::size_t>(importer.GetPropertyInteger("importerIndex", -1)));
  result.format = description ? description->mName : "unknown";
  if (const auto end = result.format.find(" Importer"); end != std::string::npos)
    result.format.resize(end);
  checkScene(*scene, file, report);
  result.isCollada = result.format.starts_with("Collada");
  if (result.isCollada) checkColladaRoot(*scene, rules);
  if (kind == ContentKind::Gltf || kind == ContentKind::BinaryGltf) result.up = 'y';
  std::unique_ptr<aiScene> own;
  if (rules == AssimpRules::Stored) {
    own.reset(importer.GetOrphanedScene());
    result.fileUnit = takeFileUnit(*own, result.format) + report.fileUnit;  // one of them is 0
  }
  SceneReader reader(own ? *own : *scene, report, result);
  reader.read();
  if (reader.hasLines()) report.note(kNoteOnLines);
  if (const Rounding& rounding = reader.rounding(); !(rounding.share <= 1e-2))
    report.fault(file, 0,
                 "assimp computes in floats, which may move a mesh by " +
                     withDigits(rounding.error, 2) +
                     " units of the file, more than a hundredth of its size; move it to the origin "
                     "of its file, or save it as OBJ, STL, PLY or OFF");
  else if (rounding.share > 1e-4)
    report.note("coordinates are computed in floats, which may move a mesh by " +
                withDigits(rounding.error, 2) + " units of the file, more than 1e-4 of its size");
  const auto triangles = static_cast<double>(result.mesh.triangles.size());
  if (const double inFile = report.triangles.value_or(triangles); inFile != triangles)
    report.fault(file, 0,
                 "assimp reads " + std::to_string(result.mesh.triangles.size()) +
                     " triangles of the file's " +
                     std::to_string(static_cast<std::uint64_t>(std::min(inFile, 1e18))) +
                     "; correct its indices and counts, or save the mesh as OBJ, STL, PLY or OFF");
}

}  // namespace

AssimpImport importByAssimp(const std::string& file, AssimpRules rules) {
  AssimpImport result;
  ContentReport report;
  try {
    read(file, rules, result, report);
  } catch (const std::exception& error) {
    result.error = oneLine(error.what());
  } catch (...) {
    result.error = "assimp gave up without a reason";
  }
  Assimp::DefaultLogger::kill();
  result.faults = std::move(report.faults);
  result.notes = std::move(report.notes);
  return result;
}

}  // namespace corridor
