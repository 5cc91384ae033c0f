#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "collision/geometry/cut_polygons.h"
#include "collision/geometry/mesh_readers.h"
#include "collision/geometry/mesh_text.h"

namespace corridor {

/// The faces of one mesh of a scene, in the mesh's own frame.
struct ScenePart {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> corners;  ///< of all faces, one after the other
  /// A face: its number of corners (3 or more), and its line in the file (0: no lines).
  struct Face {
    std::uint32_t corners = 3;
    int line = 0;
  };
  std::vector<Face> faces;

  void addFace(std::initializer_list<std::uint32_t> indices, int line);
};

/// The map from the frame of a node into that of the scene, with bounds of its rounding along the
/// path from the root: `scale` of how much the maps stretch, `length` of the sum of their
/// translations without signs.
class NodePath {
 public:
  /// Returns the path to a child, or to the next transform of the same node.
  /// @param turn a bound of an error of the step's rotation that its entries have beside their
  /// rounding, radians.
  NodePath below(const Eigen::Affine3d& step, double turn = 0) const;

  const Eigen::Affine3d& map() const { return map_; }
  double length() const { return length_; }
  /// Says whether the map turns left hands into right ones.
  bool isMirrored() const;
  /// Returns a bound of the rounding of points that are at most so far from the origin of the
  /// node's frame. HUGE_VAL if the transforms shrink or stretch beyond `kMostMagnitude`.
  double rounding(double farthest) const;

 private:
  Eigen::Affine3d map_ = Eigen::Affine3d::Identity();
  double scale_ = 1, length_ = 0;
  double lost_ = 0, lostLength_ = 0;  ///< bounds of what underflowed: of the linear map's entries,
                                      ///< and of the translation
  int steps_ = 0;
};

/// The range of numbers other than 0 in files of scenes, to keep products of transforms from
/// vanishing or overflowing.
constexpr double kLeastMagnitude = 1e-250, kMostMagnitude = 1e250;
/// Says whether a number other than 0 was read as 0, as 1e-400 is.
bool isRoundedToZero(std::string_view text, double number);
/// Returns what is wrong with a number of a scene, or "".
std::string wrongMagnitude(double number);

/// Collects the meshes of a scene of nodes, each under the map of its node.
class SceneMesh {
 public:
  explicit SceneMesh(MeshFaults& faults) : faults_(faults) {}

  /// Adds the faces of a part. @throws InputError if there are too many.
  void add(const ScenePart& part, const NodePath& path);
  /// Counts a node that is visited, and its children. Nodes may be instanced by nodes that are
  /// instanced, so that a small file can have any number of them. @throws InputError if there are
  /// too many, or if `depth` shows that a node contains itself.
  void visit(int depth, std::size_t children);
  void note(const std::string& text) { addNote(read_.notes, text); }

  /// Returns the mesh, with its polygons cut and equal vertices merged. @throws InputError if there
  /// are no faces, if a polygon crosses itself, or if rounding may move a part by more than 1 % of
  /// its size. (It is noted above 1e-4, and always for parts that are a point.)
  ReadMesh take(std::string format);

 private:
  MeshFaults& faults_;
  ReadMesh read_;
  std::vector<PolygonFan> polygons_;
  bool placesMesh_ = false;
  std::uint64_t visits_ = 0, children_ = 0;
  double error_ = 0, share_ = 0;  // the largest rounding of a part, by its share of the part's size
};

}  // namespace corridor
