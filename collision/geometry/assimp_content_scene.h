#pragma once

#include <string>

#include <assimp/scene.h>

#include "collision/geometry/assimp_content.h"

namespace corridor {

enum class SceneKind { Fbx, Other };

/// Adds a fault if a scene has content that `importByAssimp` would place wrongly: something other
/// than nodes moves vertices, a transform is not affine, or FBX nodes do not inherit the scale of
/// their parents as assimp reads it. Adds a note on what is not checked of FBX.
void checkScene(const aiScene& scene, const std::string& file, SceneKind kind,
                ContentReport& report);

}  // namespace corridor
