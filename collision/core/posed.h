#pragma once

#include "collision/core/transform.h"

namespace corridor {

/// A tree or body, and the map from its frame to the world (or to the frame in which a query
/// works). It refers to the shape, which must outlive it (do not name a
/// `Posed` of a temporary), and holds a copy of the map.
///
///     distance(Posed(cup, X_WCup), Posed(table), {}, context)
template <class Shape>
struct Posed {
  const Shape& shape;
  Transform X_W;

  Posed(const Shape& shape_, const Transform& X_W_ = {}) : shape(shape_), X_W(X_W_) {}
};

}  // namespace corridor
