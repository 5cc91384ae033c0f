#pragma once

#include <optional>

#include "collision/convex/quick_set.h"

namespace corridor {

/// Decides contact of two boxes by their 15 separating axes (Gottschalk, Lin, Manocha 1996), if
/// double suffices; else returns nullopt. Either answer is proved.
/// @pre both sets are boxes: `a.box` and `b.box` are true.
std::optional<bool> quickBoxes(const QuickSet& a, const QuickSet& b);

}  // namespace corridor
