#pragma once

#include "planner/problem/assembly.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Reads `world` and adds its obstacles to the model.
/// @param needed whether to add a fault if the problem has no obstacles. @param isPlanar whether
/// all robots are SE2 robots, so that polygons are legal.
void readWorld(const YamlMap& file, bool needed, bool isPlanar, ModelBuilder& builder,
               Source& source);

/// Reads `allow`, a list of pairs of bodies, which are given by their names. A pair with a link
/// that has no shapes is left out. So is a pair of a body with itself, with a note. @pre The model
/// has all its bodies.
AllowedBodies readAllow(const YamlMap& file, const Model& model);

/// Reads `padding`. Links without shapes are left out. @pre The model has all its bodies.
Padding readPadding(const YamlMap& file, const Model& model);

/// Reads `margin`, a number or a map of margins, into `task.margin` and `task.padding.beyond`.
/// Pairs with a link without shapes are left out, with a note. @pre `task.padding` has been read.
/// @param model with all its bodies; null if there were faults in them: then no pairs are read
void readMargin(const YamlMap& file, const Model* model, Task& task);

}  // namespace corridor
