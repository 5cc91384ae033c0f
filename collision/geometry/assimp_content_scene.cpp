#include "collision/geometry/assimp_content_scene.h"

#include <cmath>

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

void checkAffine(const aiNode& node, const std::string& file, ContentReport& report) {
  const aiMatrix4x4& m = node.mTransformation;
  // The last row of a product of affine maps is exact, except the last number of an inverse: a
  // quotient of determinants, with 16 roundings of 2^-24 (1e-6) for a turn with scales.
  if (m.d1 != 0 || m.d2 != 0 || m.d3 != 0 || !(std::abs(m.d4 - 1) <= 1e-6f))
    report.fault(
        file, 0,
        "the last row of a node's matrix is not 0 0 0 1; save the mesh with such transforms");
  for (unsigned i = 0; i < node.mNumChildren; ++i) checkAffine(*node.mChildren[i], file, report);
}

}  // namespace

void checkScene(const aiScene& scene, const std::string& file, ContentReport& report) {
  checkDeformation(scene, file, report);
  checkAffine(*scene.mRootNode, file, report);
}

}  // namespace corridor
