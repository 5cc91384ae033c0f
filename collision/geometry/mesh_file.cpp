#include "collision/geometry/mesh_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include "collision/core/read_file.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "collision/geometry/assimp_process.h"
#include "collision/geometry/cached_mesh_file.h"
#include "collision/geometry/file_frame.h"
#include "collision/geometry/mesh_health.h"
#include "collision/geometry/mesh_readers.h"

namespace corridor {
namespace {

constexpr const char* kWhat = "a mesh file";

std::string lowerExtension(const std::filesystem::path& file) {
  return lowered(file.extension().string());
}

/// The formats that are read, for messages.
constexpr const char* kFormats = "OBJ, STL, PLY, OFF, Collada, glTF or 3MF";
/// A format that OMPL.app's problems may use, which assimp reads. assimp lays its meshes on their
/// side (a stored (x, y, z) arrives as (x, z, -y)) and applies a scale of the file.
constexpr const char* kOmplAppFormat = ".3ds";

/// The maximum size of a file of a scene, 1 GiB: its text is kept in memory as a tree.
constexpr std::uint64_t kMostSceneBytes = std::uint64_t{1} << 30;

/// Returns whether an extension is one of a format that is read.
bool isMeshExtension(const std::string& extension) {
  static constexpr std::array<std::string_view, 8> all{".obj", ".stl",  ".ply", ".off",
                                                       ".dae", ".gltf", ".glb", ".3mf"};
  return std::find(all.begin(), all.end(), extension) != all.end();
}

/// Returns whether a format is read from the bytes of one file.
bool isOneFile(const std::string& extension) {
  return extension != ".3mf" && extension != ".gltf" && extension != ".glb";
}

/// Returns the bytes of a file, which must not be of another format.
std::string bytesOfFile(const std::filesystem::path& file, const std::string& extension) {
  const bool isScene = extension == ".dae" || extension == ".gltf" || extension == ".glb";
  std::string bytes = readFile(file, kWhat, isScene ? kMostSceneBytes : kMostFileBytes);
  requireOwnFormat(bytes, file, kWhat);
  return bytes;
}

/// Reads the bytes of a file whose format is `isOneFile`, without scale or rotation.
ReadMesh readBytes(const std::string& bytes, const std::string& extension, MeshFaults& faults) {
  if (extension == ".obj") return readObj(bytes, faults);
  if (extension == ".stl") return readStl(bytes, faults);
  if (extension == ".ply") return readPly(bytes, faults);
  if (extension == ".off") return readOff(bytes, faults);
  return readCollada(bytes, faults);
}

/// Reads a file of a format that is read, without scale or rotation.
ReadMesh readStored(const std::filesystem::path& file, const std::string& extension,
                    MeshFaults& faults) {
  if (extension == ".3mf") {
    requireFile(file, kWhat, kMostSceneBytes);
    return readThreeMf(file.string(), faults);
  }
  const std::string bytes = bytesOfFile(file, extension);
  if (isOneFile(extension)) return readBytes(bytes, extension, faults);
  return extension == ".gltf" ? readGltf(file.string(), bytes, faults)
                              : readGlb(file.string(), bytes, faults);
}

void requireSound(const TriangleMesh& mesh, MeshFaults& faults) {
  if (mesh.triangles.empty()) {
    faults.fail(
        0,
        "the mesh has no faces; triangles or polygons are needed, lines and points are not read");
  }
  if (const auto complaint = checkMesh(mesh)) faults.fail(0, *complaint);
}

/// Returns the text of the fault for a file with an unsupported extension.
std::string notRead(const std::string& extension) {
  return (extension.empty() ? std::string("a name without an extension")
                            : "the extension " + inQuotes(extension)) +
         " is not supported; save the mesh as " + kFormats +
         (extension.empty() || extension == ".xml" ? " (a robot in URDF begins with <robot>)" : "");
}

std::string unitRule(const MeshFileOptions& options, double fileUnit) {
  if (options.metresPerUnit) {
    return shortest(*options.metresPerUnit) + " m per unit, as requested" +
           (fileUnit > 0 ? ", instead of the file's own " + shortest(fileUnit) + " m" : "");
  }
  if (fileUnit > 0) return shortest(fileUnit) + " m per unit, by the file or its format";
  return "1 m per unit, since neither the format nor the user states one";
}

std::string upRule(const MeshFileOptions& options, const MeshFile& file) {
  std::string rule;
  switch (options.up.value_or(' ')) {
    case 'x':
      rule = "x is up, as requested: rotated by (x, y, z) -> (-y, -z, x)";
      break;
    case 'y':
      rule = "y is up, as requested: rotated by (x, y, z) -> (x, -z, y)";
      break;
    case 'z':
      rule = "z is up, as requested: not rotated";
      break;
    default:
      rule = "coordinates as stored, since no up-axis was requested";
      break;
  }
  if (!file.fileUp || options.up == file.fileUp) return rule;
  return rule + "; the file's own, " + *file.fileUp + ", is not applied" +
         (options.up ? "" : " (ROS's rule)");
}

}  // namespace

void checkOptions(const MeshFileOptions& options, MeshFaults& faults) {
  if (options.metresPerUnit &&
      !(std::isfinite(*options.metresPerUnit) && *options.metresPerUnit > 0)) {
    faults.add(0, "metres per unit must be a finite number above 0, not " +
                      shortest(*options.metresPerUnit));
  }
  if (options.up && *options.up != 'x' && *options.up != 'y' && *options.up != 'z') {
    faults.add(0, "the up-axis must be x, y or z, not " + inQuotes(std::string(1, *options.up)));
  }
  faults.throwIfAny();
}

namespace {

/// Applies the options to a mesh as it is stored.
MeshFile applied(ReadMesh read, const std::string& extension, const MeshFileOptions& options,
                 MeshFaults& faults) {
  requireSound(read.mesh, faults);
  MeshFile result;
  result.mesh = std::move(read.mesh);
  result.format = std::move(read.format);
  result.notes = std::move(read.notes);
  result.otherFiles = std::move(read.otherFiles);
  result.statedUnits = std::move(read.statedUnits);
  result.isCollada = extension == ".dae";
  result.facesOnly = read.fileUnit > 0;
  if (read.up != 0) result.fileUp = read.up;

  const FileFrame frame(options, read.fileUnit > 0 ? read.fileUnit : 1);
  if (!frame.isIdentity()) {
    for (Vec3& vertex : result.mesh.vertices) vertex = frame * vertex;
    if (checkMesh(result.mesh)) {
      faults.fail(0, "its coordinates times " + shortest(frame.scale()) +
                         " m per unit are too large for a double");
    }
  }
  result.unitRule = unitRule(options, read.fileUnit);
  if (read.fileUnit > 0 && options.metresPerUnit.value_or(read.fileUnit) != read.fileUnit)
    result.notes.push_back("the file's own unit, " + shortest(read.fileUnit) +
                           " m, is not the stated one, " + shortest(*options.metresPerUnit) +
                           " m, which is used");
  if (auto note = noteOnUnits(result.statedUnits, frame.scale()))
    result.notes.push_back(std::move(*note));
  result.upRule = upRule(options, result);
  return result;
}

}  // namespace

MeshFile readMeshFile(const std::filesystem::path& file, const MeshFileOptions& options,
                      FileCache* cache) {
  MeshFaults faults(file.string());
  checkOptions(options, faults);
  if (const std::string why = whyNotOrdinaryFile(file); !why.empty()) faults.fail(0, why);
  const std::string extension = lowerExtension(file);
  if (!isMeshExtension(extension)) faults.fail(0, notRead(extension));
  if (!cache || !isOneFile(extension))
    return applied(readStored(file, extension, faults), extension, options, faults);
  const std::string bytes = bytesOfFile(file, extension);
  return cachedMeshFile(bytes, extension, options, *cache, [&] {
    return applied(readBytes(bytes, extension, faults), extension, options, faults);
  });
}

bool hasMeshExtension(const std::filesystem::path& file) {
  return isMeshExtension(lowerExtension(file));
}

std::string noteOnUp(const std::string& files, const std::string& whatAppliesIt) {
  return "the up-axis of " + files + " is not z; it is not applied (ROS's rule), and " +
         whatAppliesIt + " applies it";
}

namespace {

/// Applies Collada's unit and turns its up-axis to y, as assimp does. glTF and 3MF stay as they
/// are.
void toOmplApp(ReadMesh& read, const std::string& extension) {
  if (extension != ".dae") return;
  for (Vec3& v : read.mesh.vertices) {
    v *= read.fileUnit;
    if (read.up == 'x') v = Vec3(-v.y(), v.x(), v.z());
    if (read.up == 'z') v = Vec3(v.x(), v.z(), -v.y());
  }
}

/// Adds a fault if the bounds of a mesh are not those of assimp's import: then OMPL.app, which uses
/// assimp, plans with another mesh. assimp computes in floats, so that its bounds differ by 2^-24
/// of each coordinate and of each translation on the way; 1 % leaves room for translations that
/// cancel. What a dropped or moved part changes less is not seen, and `mesh` is our own reader's.
void compareBounds(const TriangleMesh& mesh, const TriangleMesh& byAssimp, MeshFaults& faults) {
  const auto boundsOf = [](const TriangleMesh& of) {
    std::array<Vec3, 2> bounds{Vec3::Constant(HUGE_VAL), Vec3::Constant(-HUGE_VAL)};
    for (const auto& triangle : of.triangles)
      for (const std::uint32_t corner : triangle) {
        bounds[0] = bounds[0].cwiseMin(of.vertices[corner]);
        bounds[1] = bounds[1].cwiseMax(of.vertices[corner]);
      }
    return bounds;
  };
  const auto ours = boundsOf(mesh), theirs = boundsOf(byAssimp);
  const double size = (ours[1] - ours[0]).norm() + 1e-6 * (ours[0].norm() + ours[1].norm());
  if (!((ours[0] - theirs[0]).norm() <= 1e-2 * size && (ours[1] - theirs[1]).norm() <= 1e-2 * size))
    faults.fail(
        0,
        "assimp, which OMPL.app uses, reads other geometry than the file has; save it again "
        "as triangles");
}

}  // namespace

OmplAppMesh readOmplAppMesh(const std::filesystem::path& file) {
  MeshFaults faults(file.string());
  if (const std::string why = whyNotOrdinaryFile(file); !why.empty()) faults.fail(0, why);
  const std::string extension = lowerExtension(file);
  if (!isMeshExtension(extension) && extension != kOmplAppFormat)
    faults.fail(0, notRead(extension));
  OmplAppMesh result;
  ReadMesh read;
  if (isMeshExtension(extension)) read = readStored(file, extension, faults);
  toOmplApp(read, extension);
  AssimpImport import = readWithAssimp(file.string());
  requireSound(import.mesh, faults);
  result.importedVertices = static_cast<int>(import.mesh.vertices.size());
  for (const Vec3& vertex : import.mesh.vertices) result.vertexAverage += vertex;
  result.vertexAverage /= result.importedVertices;
  if (extension == kOmplAppFormat) {
    result.mesh = std::move(import.mesh);
  } else {
    requireSound(read.mesh, faults);
    compareBounds(read.mesh, import.mesh, faults);
    result.mesh = std::move(read.mesh);
  }
  result.notes = std::move(read.notes);
  result.otherFiles = std::move(import.otherFiles);
  return result;
}

}  // namespace corridor
