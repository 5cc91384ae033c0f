#pragma once

#include <random>
#include <span>

#include "collision/predicates/triangle.h"

/// Pairs of triangles for which contact is hard to decide. They are made on a grid of integers,
/// where touching triangles touch exactly. Then they are placed. Some placings keep every contact
/// exactly; others round coordinates, and may lose or create contacts.
namespace corridor::test {

struct PlacedPair {
  Triangle a, b;
  Transform X_WA, X_WB;
};

/// A way of making two triangles with integer coordinates of magnitude at most 2^24. About half of
/// the pairs touch.
struct PairFamily {
  const char* name;
  void (*make)(std::mt19937_64& random, Triangle& a, Triangle& b);
};
std::span<const PairFamily> pairFamilies();

/// A way of placing a pair of triangles made by a family.
struct PairPlacing {
  const char* name;
  /// True if the placed triangles touch if and only if the original ones do. False if rounding may
  /// change this.
  bool keeps;
  PlacedPair (*place)(std::mt19937_64& random, const Triangle& a, const Triangle& b);
};
std::span<const PairPlacing> pairPlacings();

/// Returns one of the 24 rotations that are exact in doubles: the signed permutations with
/// determinant 1.
Mat3 exactRotation(std::mt19937_64& random);

}  // namespace corridor::test
