#pragma once

#include "collision/geometry/collada_document.h"
#include "collision/geometry/scene_mesh.h"

namespace corridor {

/// Reads the vertices and the faces of a `<mesh>` of Collada into `part`.
void readColladaMesh(const xml::Element& mesh, ColladaDocument& document, ScenePart& part);

}  // namespace corridor
