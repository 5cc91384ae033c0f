#include "collision/geometry/assimp_content_scene.h"

#include <cmath>
#include <string_view>

#include <Eigen/Geometry>

namespace corridor {
namespace {

void checkDeformation(const aiScene& scene, const std::string& file, ContentReport& report) {
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[i];
    bool moves = mesh.mNumBones > 0;
    for (unsigned k = 0; k < mesh.mNumAnimMeshes; ++k) moves |= mesh.mAnimMeshes[k]->mWeight != 0;
    if (moves)
      report.fault(file, 0,
                   "bones or blend shapes move the vertices, which is not supported; save the mesh "
                   "in its pose, without them");
  }
}

Eigen::Matrix3d linearPart(const aiMatrix4x4& m) {
  Eigen::Matrix3d linear;
  linear << m.a1, m.a2, m.a3, m.b1, m.b2, m.b3, m.c1, m.c2, m.c3;
  return linear;
}

/// A chain of some ten matrices of floats has an error of 10 * 2^-22 at most, 3e-6.
constexpr double kSlackOfScale = 1e-5;

/// Returns whether a map turns, and scales all directions by `scale`, apart from assimp's rounding.
bool isSimilarity(const Eigen::Matrix3d& map, double& scale) {
  const Eigen::Matrix3d square = map.transpose() * map;
  scale = std::sqrt(square.trace() / 3);
  return (square - scale * scale * Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <=
         kSlackOfScale * scale * scale;
}

/// The linear maps of the nodes above a node: of all, and without the parts of the node itself into
/// which assimp splits nodes of FBX.
struct Above {
  Eigen::Matrix3d all = Eigen::Matrix3d::Identity(), parents = Eigen::Matrix3d::Identity();
};

class NodeCheck {
 public:
  NodeCheck(const std::string& file, SceneKind kind, ContentReport& report)
      : file_(file), kind_(kind), report_(report) {}

  void run(const aiNode& node, const Above& above = {}) {
    const aiMatrix4x4& m = node.mTransformation;
    // The last row of a product of affine maps is exact, except the last number of an inverse: a
    // quotient of determinants, with 16 roundings of 2^-24 (1e-6) for a turn with scales.
    if (m.d1 != 0 || m.d2 != 0 || m.d3 != 0 || !(std::abs(m.d4 - 1) <= 1e-6f))
      report_.fault(
          file_, 0,
          "the last row of a node's matrix is not 0 0 0 1; save the mesh with such transforms");
    const bool isPart = kind_ == SceneKind::Fbx && isPartOfNode(node.mName.C_Str());
    if (kind_ == SceneKind::Fbx && !hasMark(node.mName.C_Str(), ""))
      checkInheritance(node, above.parents);
    Above below{above.all * linearPart(m), above.parents};
    if (!isPart) below.parents = below.all;
    for (unsigned i = 0; i < node.mNumChildren; ++i) run(*node.mChildren[i], below);
  }

 private:
  /// Returns whether a node is one of those before the one that has the name and the properties.
  /// Those behind it undo its geometric transform, which its children do not inherit.
  static bool isPartOfNode(std::string_view name) {
    return hasMark(name, "") && !(hasMark(name, "Geometric") && name.ends_with("Inverse"));
  }
  /// Returns whether a node is one into which assimp splits a node of FBX.
  static bool hasMark(std::string_view name, const char* part) {
    return name.find(std::string("_$AssimpFbx$_") + part) != name.npos;
  }

  /// assimp multiplies the transforms of all nodes, which is FBX's type 1. Type 0, the default,
  /// differs if parents have different scales along their axes; type 2 differs if they have any.
  void checkInheritance(const aiNode& node, const Eigen::Matrix3d& parents) {
    std::int32_t type = 0;
    if (node.mMetaData) node.mMetaData->Get("InheritType", type);
    double scale = 1;
    if (type == 1 ||
        (isSimilarity(parents, scale) && (type == 0 || std::abs(scale - 1) <= kSlackOfScale)))
      return;
    report_.fault(file_, 0,
                  "the node \"" + std::string(node.mName.C_Str()) +
                      "\" inherits the scale of its parents otherwise than assimp reads it "
                      "(InheritType " +
                      std::to_string(type) + "); apply the scales in the modeller");
  }

  const std::string& file_;
  const SceneKind kind_;
  ContentReport& report_;
};

/// Notes axes of FBX that are no right-handed frame, or an up-axis that points down. Corridor reads
/// coordinates as they are stored.
void noteAxes(const aiMetadata& data, ContentReport& report) {
  Eigen::Matrix3i axes = Eigen::Matrix3i::Zero();
  std::int32_t sign = 1;
  for (int i = 0; const char* const name : {"FrontAxis", "CoordAxis", "UpAxis"}) {
    std::int32_t axis = 0;
    if (!data.Get(name, axis) || !data.Get(name + std::string("Sign"), sign) || axis < 0 ||
        axis > 2)
      return;
    axes(axis, i++) = sign;
  }
  if (axes.determinant() != 1 || sign < 0)
    report.note(
        "the file's axes are left-handed, or its up-axis points down; its coordinates are read as "
        "they are stored");
}

}  // namespace

void checkScene(const aiScene& scene, const std::string& file, SceneKind kind,
                ContentReport& report) {
  checkDeformation(scene, file, report);
  NodeCheck(file, kind, report).run(*scene.mRootNode);
  if (kind == SceneKind::Fbx && scene.mMetaData) noteAxes(*scene.mMetaData, report);
  if (kind == SceneKind::Fbx)
    report.note(
        "an FBX file is not searched for geometry that no model uses and properties of unusual "
        "types, which are not read");
}

}  // namespace corridor
