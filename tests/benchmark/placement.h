#pragma once

#include <optional>
#include <random>
#include <stdexcept>
#include <vector>

#include "collision/queries/distance_obb4.h"
#include "tests/benchmark/shapes.h"

namespace corridor::bench {

/// Returns `count` poses of b at which its distance from a exceeds `gap` by at most 1 % (up to
/// rounding). The pose of a is the identity. b is rotated at random, and approaches from outside
/// along a random line through the origin of a's frame; the length of each step is the current
/// distance minus `gap`. @throws std::runtime_error if too few poses are found.
inline std::vector<Transform> posesAtGap(const Obb4Tree& a, const Obb4Tree& b, double gap,
                                         int count, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<Transform> poses;
  QueryContext context;
  for (int tries = 0; static_cast<int>(poses.size()) < count; ++tries) {
    if (tries == 100 * count) throw std::runtime_error("no poses at this gap were found");
    const Vec3 from = Vec3(normal(random), normal(random), normal(random)).normalized();
    double along = a.reach() + b.reach() + 2 * gap;
    Transform X{randomRotation(random), Vec3::Zero()};
    for (int i = 0; i < 1000 && along > 0; ++i) {
      X.t = along * from;
      const double free = distance(Posed(a), Posed(b, X), {}, context).distance - gap;
      if (free <= 0.01 * gap) {
        poses.push_back(X);
        break;
      }
      along -= free;
    }
  }
  return poses;
}

}  // namespace corridor::bench
