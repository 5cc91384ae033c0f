#include "collision/geometry/mesh_file.h"

#include <algorithm>
#include <cmath>

#include "collision/core/read_file.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "collision/geometry/assimp_process.h"
#include "collision/geometry/collada_asset.h"
#include "collision/geometry/cut_polygons.h"
#include "collision/geometry/file_frame.h"
#include "collision/geometry/mesh_health.h"
#include "collision/geometry/mesh_readers.h"
#include "collision/geometry/vertex_welder.h"

namespace corridor {
namespace {

constexpr const char* kWhat = "a mesh file";

std::string lowerExtension(const std::filesystem::path& file) {
  return lowered(file.extension().string());
}

/// A mesh as read, without scale or rotation.
struct StoredMesh {
  MeshFile file;
  double fileUnit = 0;  ///< metres; 0: the format has none
};

using Reader = ReadMesh (*)(std::string_view, MeshFaults&);

/// Returns Corridor's own reader of an extension; null if there is none.
Reader ownReader(const std::string& extension) {
  return extension == ".obj"   ? readObj
         : extension == ".stl" ? readStl
         : extension == ".ply" ? readPly
         : extension == ".off" ? readOff
                               : nullptr;
}

StoredMesh readOwn(const std::filesystem::path& file, Reader reader, MeshFaults& faults) {
  ReadMesh read = reader(readFile(file, kWhat), faults);
  StoredMesh stored;
  stored.file.mesh = std::move(read.mesh);
  stored.file.format = std::move(read.format);
  stored.file.notes = std::move(read.notes);
  stored.file.statedUnits = std::move(read.statedUnits);
  return stored;
}

/// Returns the mesh with equal vertices merged, and without unused vertices. (assimp repeats a
/// vertex for each of its normals.)
TriangleMesh welded(const TriangleMesh& mesh) {
  VertexWelder welder(mesh.vertices.size());
  TriangleMesh result;
  result.triangles = mesh.triangles;
  for (auto& triangle : result.triangles) {
    for (std::uint32_t& corner : triangle) corner = welder.addOrFind(mesh.vertices[corner]);
  }
  result.vertices = welder.takePoints();
  return result;
}

void requireSound(const TriangleMesh& mesh, MeshFaults& faults, const char* hint = "") {
  if (mesh.triangles.empty()) {
    faults.fail(
        0,
        "the mesh has no faces; triangles or polygons are needed, lines and points are not read");
  }
  if (const auto complaint = checkMesh(mesh)) faults.fail(0, *complaint + hint);
}

template <std::size_t n>
bool contains(const std::array<std::string_view, n>& formats, const std::string& extension) {
  return std::find(formats.begin(), formats.end(), extension) != formats.end();
}

/// Formats that assimp reads, but not reliably: it misreads their files in many ways, of which it
/// reports few.
constexpr std::array<std::string_view, 3> kMisread{".fbx", ".x3d", ".amf"};

/// Returns the text of the fault for a file with an unsupported extension.
std::string notRead(const std::string& extension) {
  if (contains(kMisread, extension))
    return "the extension " + inQuotes(extension) +
           " is not supported, because the library that could read it drops or moves parts of such "
           "files without a message; save the mesh as glTF, Collada, OBJ, STL, PLY or OFF";
  return (extension.empty() ? std::string("a name without an extension")
                            : "the extension " + inQuotes(extension)) +
         " is not supported; save the mesh as OBJ, STL, PLY, OFF or glTF";
}

/// The maximum size of a file for assimp, 1 GiB: for a larger file assimp would need more than its
/// 4 GiB of memory.
constexpr std::uint64_t kMostAssimpBytes = std::uint64_t{1} << 30;

/// Checks a file before assimp reads it: its size, whether it is an ordinary file, Collada's unit
/// and up-axis, and the lines of OBJ. @throws InputError if a check fails.
/// @returns Collada's up-axis; nullopt for other formats.
std::optional<char> requireForAssimp(const std::filesystem::path& file,
                                     const std::string& extension, MeshFaults& faults,
                                     std::vector<std::string>& notes) {
  if (extension == ".dae")
    return checkColladaAsset(readFile(file, kWhat, kMostAssimpBytes), faults, notes);
  if (extension == ".obj") checkObjForAssimp(readFile(file, kWhat, kMostAssimpBytes), faults);
  requireFile(file, kWhat, kMostAssimpBytes);
  return std::nullopt;
}

constexpr const char* floatHint = " (this format is read in float, which ends at 3.4e38)";

/// Returns the mesh of an import with its polygons cut and its equal vertices merged.
TriangleMesh cutAndWelded(AssimpImport& import, MeshFaults& faults) {
  requireSound(import.mesh, faults, floatHint);
  cutPolygons(import.mesh, import.polygons, faults, import.notes);
  return welded(import.mesh);
}

StoredMesh readForeign(const std::filesystem::path& file, const std::string& extension,
                       bool unitGiven, MeshFaults& faults) {
  if (!contains(kAssimpFormats, extension)) faults.fail(0, notRead(extension));
  StoredMesh stored;
  const std::optional<char> up = requireForAssimp(file, extension, faults, stored.file.notes);
  AssimpImport import = readWithAssimp(file.string(), AssimpRules::Stored);
  if (!unitGiven && extension == ".3mf")
    faults.fail(0, "the file has a unit, " + shortest(import.fileUnit) +
                       " m, which is not applied; state the unit" + howToState(import.fileUnit));
  stored.file.mesh = cutAndWelded(import, faults);
  stored.file.format = std::move(import.format);
  stored.file.floatVertices = true;
  for (std::string& note : import.notes) stored.file.notes.push_back(std::move(note));
  stored.file.otherFiles = std::move(import.otherFiles);
  stored.fileUnit = import.fileUnit;
  stored.file.isCollada = up.has_value();
  stored.file.fileUp = up || import.up == 0 ? up : std::optional(import.up);
  return stored;
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
  if (file.isCollada) return rule + "; the file's own <up_axis> is not applied (ROS's rule)";
  return rule +
         (file.fileUp ? std::string("; the file's own, ") + *file.fileUp + ", is not applied" : "");
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

MeshFile readMeshFile(const std::filesystem::path& file, const MeshFileOptions& options) {
  MeshFaults faults(file.string());
  checkOptions(options, faults);
  if (const std::string why = whyNotOrdinaryFile(file); !why.empty()) faults.fail(0, why);
  const std::string extension = lowerExtension(file);
  const Reader own = ownReader(extension);
  StoredMesh stored = own ? readOwn(file, own, faults)
                          : readForeign(file, extension, options.metresPerUnit.has_value(), faults);
  MeshFile result = std::move(stored.file);
  requireSound(result.mesh, faults);

  const FileFrame frame(options, stored.fileUnit > 0 ? stored.fileUnit : 1);
  if (!frame.isIdentity()) {
    for (Vec3& vertex : result.mesh.vertices) vertex = frame * vertex;
    if (checkMesh(result.mesh)) {
      faults.fail(0, "its coordinates times " + shortest(frame.scale()) +
                         " m per unit are too large for a double");
    }
  }
  result.unitRule = unitRule(options, stored.fileUnit);
  if (extension == ".3mf" && stored.fileUnit > 0 && *options.metresPerUnit != stored.fileUnit)
    result.notes.push_back("the file's own unit, " + shortest(stored.fileUnit) +
                           " m, is not the stated one, " + shortest(*options.metresPerUnit) +
                           " m, which is used");
  if (auto note = noteOnUnits(result.statedUnits, frame.scale()))
    result.notes.push_back(std::move(*note));
  result.upRule = upRule(options, result);
  return result;
}

std::string noteOnUp(const std::string& files, const std::string& whatAppliesIt) {
  return "the up-axis of " + files + " is not z; it is not applied (ROS's rule), and " +
         whatAppliesIt + " applies it";
}

OmplAppMesh readOmplAppMesh(const std::filesystem::path& file) {
  MeshFaults faults(file.string());
  if (const std::string why = whyNotOrdinaryFile(file); !why.empty()) faults.fail(0, why);
  const std::string extension = lowerExtension(file);
  if (!contains(kAssimpFormats, extension) && !contains(kOwnFormats, extension) &&
      extension != kOmplAppFormat)
    faults.fail(0, notRead(extension));
  OmplAppMesh result;
  requireForAssimp(file, extension, faults, result.notes);
  const Reader own = ownReader(extension);
  MeshFile read;
  if (own) read = readOwn(file, own, faults).file;
  AssimpImport import = readWithAssimp(file.string(), AssimpRules::OmplApp);
  requireSound(import.mesh, faults, floatHint);
  if (own && import.mesh.triangles.size() != read.mesh.triangles.size())
    faults.fail(0, "assimp, which OMPL.app uses, reads " +
                       std::to_string(import.mesh.triangles.size()) + " triangles of the file's " +
                       std::to_string(read.mesh.triangles.size()) +
                       "; save it again as triangles, without comments among them");
  result.importedVertices = static_cast<int>(import.mesh.vertices.size());
  for (const Vec3& vertex : import.mesh.vertices) result.vertexAverage += vertex;
  result.vertexAverage /= result.importedVertices;
  // assimp can drop facets of the formats with a reader of our own, and find as many others.
  if (own) {
    result.mesh = std::move(read.mesh);
  } else {
    import = readWithAssimp(file.string(), AssimpRules::OmplAppPolygons);
    result.mesh = cutAndWelded(import, faults);
  }
  for (std::string& note : import.notes) result.notes.push_back(std::move(note));
  for (std::string& note : read.notes) result.notes.push_back(std::move(note));
  result.otherFiles = std::move(import.otherFiles);
  return result;
}

}  // namespace corridor
