#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "collision/core/rigid_pose.h"
#include "collision/core/transform.h"
#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"

/// Tools for tests that put NaN and ±infinity in every place of an argument, one at a time.
namespace corridor::test {

inline constexpr std::array<double, 3> kNotFinite{std::numeric_limits<double>::quiet_NaN(),
                                                  std::numeric_limits<double>::infinity(),
                                                  -std::numeric_limits<double>::infinity()};

/// These functions append pointers to all numbers of a value.
inline void addNumbers(double& x, std::vector<double*>& numbers) {
  numbers.push_back(&x);
}
template <class Derived>
void addNumbers(Eigen::PlainObjectBase<Derived>& matrix, std::vector<double*>& numbers) {
  for (Eigen::Index i = 0; i < matrix.size(); ++i) numbers.push_back(matrix.data() + i);
}
inline void addNumbers(Transform& X, std::vector<double*>& numbers) {
  addNumbers(X.m, numbers), addNumbers(X.t, numbers);
}
inline void addNumbers(RigidPose& pose, std::vector<double*>& numbers) {
  addNumbers(pose.p, numbers), addNumbers(pose.q.coeffs(), numbers);
}
inline void addNumbers(TriangleMesh& mesh, std::vector<double*>& numbers) {
  for (Vec3& vertex : mesh.vertices) addNumbers(vertex, numbers);
}
inline void addNumbers(ConvexPart& part, std::vector<double*>& numbers) {
  for (Vec3& point : part.points) addNumbers(point, numbers);
  addNumbers(part.radius, numbers);
}
template <class Item>
void addNumbers(std::vector<Item>& items, std::vector<double*>& numbers) {
  for (Item& item : items) addNumbers(item, numbers);
}
template <class Item, std::size_t N>
void addNumbers(std::array<Item, N>& items, std::vector<double*>& numbers) {
  for (Item& item : items) addNumbers(item, numbers);
}

/// Calls check(bad, what) for each copy of `good` in which one number is not finite. `what`
/// describes the copy in messages of tests.
/// @param numbersOf returns pointers to the numbers of its argument.
template <class Value, class NumbersOf, class Check>
void forEachNotFinite(const Value& good, const NumbersOf& numbersOf, const Check& check) {
  Value first = good;
  const std::size_t count = numbersOf(first).size();
  for (std::size_t i = 0; i < count; ++i)
    for (const double bad : kNotFinite) {
      Value copy = good;
      *numbersOf(copy)[i] = bad;
      check(copy, "number " + std::to_string(i) + " is " + std::to_string(bad));
    }
}
template <class Value, class Check>
void forEachNotFinite(const Value& good, const Check& check) {
  const auto numbersOf = [](Value& value) {
    std::vector<double*> numbers;
    addNumbers(value, numbers);
    return numbers;
  };
  forEachNotFinite(good, numbersOf, check);
}

/// Returns whether a query claims something: `claim` returns true. A query that throws
/// std::invalid_argument claims nothing.
template <class Claim>
bool claims(const Claim& claim) {
  try {
    return claim();
  } catch (const std::invalid_argument&) {
    return false;
  }
}

}  // namespace corridor::test
