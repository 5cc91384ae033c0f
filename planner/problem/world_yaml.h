#pragma once

#include "planner/problem/assembly.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Reads `world` and adds its obstacles to the model.
/// @param needed whether a problem without obstacles is a fault.
void readWorld(const YamlMap& file, bool needed, bool isPlanar, ModelBuilder& builder,
               Source& source);

/// Reads `allow`, a list of pairs of names of bodies. A pair with a link that has no shapes is left
/// out. @pre the model has all its bodies.
AllowedBodies readAllow(const YamlMap& file, const Model& model);

/// Reads `padding`. Links without shapes are left out. @pre the model has all its bodies.
Padding readPadding(const YamlMap& file, const Model& model);

}  // namespace corridor
