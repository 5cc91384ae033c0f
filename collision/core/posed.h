#pragma once

#include "collision/core/transform.h"

namespace corridor {

/// A tree or body (the shape), and the map from its frame to the world or to the frame in which a
/// query works. A `Posed` holds a copy of the map, but only a reference to the shape. The shape
/// must outlive the `Posed`: never store a `Posed` of a temporary shape.
///
///     distance(Posed(cup, X_WCup), Posed(table), {}, context)
template <class Shape>
struct Posed {
  const Shape& shape;
  Transform X_W;

  Posed(const Shape& shape_, const Transform& X_W_ = {}) : shape(shape_), X_W(X_W_) {}
};

}  // namespace corridor
