#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "collision/geometry/stated_unit.h"
#include "collision/geometry/triangle_mesh.h"

namespace corridor {

class FileCache;

/// How to interpret the coordinates of a mesh file.
struct MeshFileOptions {
  /// Metres per unit of the file. Unset: the file's own unit if the format has one, else 1.
  std::optional<double> metresPerUnit = {};
  /// The file's up-axis ('x', 'y' or 'z'), which is rotated to z. 'y' maps (x, y, z) to (x, -z, y),
  /// and 'x' maps (x, y, z) to (-y, -z, x), as Collada's axes do. Unset: coordinates are not
  /// rotated.
  std::optional<char> up = {};
};

/// A mesh and how it was read.
struct MeshFile {
  TriangleMesh mesh;
  std::string format;    ///< "OBJ", "STL (binary)", "PLY (ASCII)", "Collada" …
  std::string unitRule;  ///< one line for people: which unit was used, and why
  std::string upRule;    ///< one line for people: which rotation was applied, and why
  /// The up-axis that a Collada file states ('x', 'y' or 'z'; 'y' if it states none); 'y' for glTF.
  /// Unset: other formats. By ROS's rule, `readMeshFile` does not apply this axis; it applies only
  /// the axis that the caller sets in `MeshFileOptions::up`.
  std::optional<char> fileUp = {};
  bool isCollada = false;
  /// True for Collada, glTF and 3MF: the mesh has no vertices without a face.
  bool facesOnly = false;
  std::vector<std::string> notes;  ///< on content that is not read, without the file's name
  /// The other files that were read with it, such as the buffers of a glTF file.
  std::vector<std::string> otherFiles;
  /// The units that comments state (OBJ, STL, PLY, OFF). They are not applied; `notes` names one
  /// that is not the unit in use.
  std::vector<StatedUnit> statedUnits = {};
};

/// Reads a mesh file in double: OBJ, STL, PLY, OFF, Collada, glTF 2.0 or 3MF, by its extension. The
/// transforms of a scene's nodes are applied. This function applies scale and rotation once.
/// Queries use the rounded coordinates that result.
/// @throws InputError that names the file and the line, face or byte: unreadable, no faces, not
/// finite, index out of range, truncated, too large, unknown extension, …
/// @param cache if it has the mesh of the same bytes and options, only the bytes are read. Files of
/// glTF and 3MF, and small files, are not kept. The result is the same with and without a cache.
MeshFile readMeshFile(const std::filesystem::path& file, const MeshFileOptions& options = {},
                      FileCache* cache = nullptr);

/// Returns whether the extension of a name is one that `readMeshFile` reads.
bool hasMeshExtension(const std::filesystem::path& file);

/// Returns the text of a note on files whose `fileUp` is not z and was not applied.
std::string noteOnUp(const std::string& files, const std::string& whatAppliesIt);

/// A mesh as OMPL.app places it. For Collada, the unit and the rotation to y-up are applied, as
/// assimp applies them, which OMPL.app uses. The triangles come from Corridor's own readers, except
/// those of 3DS, which assimp reads.
struct OmplAppMesh {
  TriangleMesh mesh;
  /// The mean of all imported vertices. Each vertex counts as often as assimp keeps it.
  Vec3 vertexAverage = Vec3::Zero();
  int importedVertices = 0;                    ///< the number of these vertices
  std::vector<std::string> notes, otherFiles;  ///< as in `MeshFile`
};
/// Reads a mesh file by OMPL.app's rules. @throws InputError in the cases of `readMeshFile`.
OmplAppMesh readOmplAppMesh(const std::filesystem::path& file);

}  // namespace corridor
