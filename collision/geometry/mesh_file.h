#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "collision/geometry/triangle_mesh.h"

namespace corridor {

/// What a caller may say about a mesh file.
struct MeshFileOptions {
  /// Metres per unit of the file. Unset: the file's own unit where its format has one, else 1.
  std::optional<double> metresPerUnit = {};
  /// The file's up-axis ('x', 'y' or 'z'), turned to z by a rotation: 'y' takes (x, y, z) to
  /// (x, -z, y), 'x' to (-y, -z, x), as Collada's axes do. Unset: coordinates as stored.
  std::optional<char> up = {};
};

/// A mesh and how it was read.
struct MeshFile {
  TriangleMesh mesh;
  std::string format;  ///< "OBJ", "STL (binary)", "PLY (ASCII)" …, or assimp's name of the format
  std::string unitRule;  ///< one line for people: which unit was used, and why
  std::string upRule;    ///< one line for people: which turn was applied, and why
  bool floatVertices =
      false;  ///< read by assimp, so the vertices are those of the file rounded to float
};

/// Reads a mesh file. The extension decides: OBJ, STL, PLY and OFF are read in double by our own
/// readers; Collada, glTF, FBX, 3DS, X3D, 3MF and AMF by assimp, in a process of its own with
/// limits of time and memory. Scale and turn are applied here, once: what comes back is the model.
/// @throws InputError naming file and line, face or byte: unreadable, no faces, non-finite, index
/// out of range, truncated, too large, another extension …
MeshFile readMeshFile(const std::filesystem::path& file, const MeshFileOptions& options = {});

/// A mesh as OMPL.app places it: read with its import steps, node transforms and Y-up turn applied.
struct OmplAppMesh {
  TriangleMesh mesh;
  Vec3 vertexAverage =
      Vec3::Zero();  ///< of all imported vertices, each as often as assimp keeps it
  int importedVertices = 0;
};
/// @throws InputError as `readMeshFile`.
OmplAppMesh readOmplAppMesh(const std::filesystem::path& file);

}  // namespace corridor
