#pragma once

#include <string>

#include <assimp/scene.h>

#include "collision/geometry/assimp_content.h"

namespace corridor {

/// Adds a fault if a scene has content that `importByAssimp` would place wrongly: something other
/// than nodes moves vertices, or a transform is not affine.
void checkScene(const aiScene& scene, const std::string& file, ContentReport& report);

}  // namespace corridor
