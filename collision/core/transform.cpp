#include "collision/core/transform.h"

#include <cmath>

namespace corridor {

bool Transform::isFinite() const {
  bool finite = true;
  for (int i = 0; i < 9; ++i) finite &= std::isfinite(m.data()[i]);
  for (int i = 0; i < 3; ++i) finite &= std::isfinite(t.data()[i]);
  return finite;
}

Transform rigidInverse(const Transform& X) {
  Transform inverse;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) inverse.m(i, j) = X.m(j, i);
    inverse.t[i] = -(X.m(0, i) * X.t[0] + X.m(1, i) * X.t[1] + X.m(2, i) * X.t[2]);
  }
  return inverse;
}

}  // namespace corridor
