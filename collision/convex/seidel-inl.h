#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Linear programming in few variables, by the algorithm of R. Seidel, Small-dimensional linear
/// programming and convex hulls made easy, Discrete & Computational Geometry 6 (1991). Half-spaces
/// are added one by one. If the best point so far is outside the added half-space, the new best
/// point is on the plane of that half-space. The new best point is found by the same algorithm with
/// one variable less. In random order, n half-spaces in D variables take O(D!·n) operations in the
/// mean.
///
/// The result is computed in the arithmetic of `Real`, without any error bound. With rationals it
/// is exact. With doubles it is a candidate: the caller must prove the answer.
namespace corridor::seidel {

template <class Real, std::size_t D>
using Point = std::array<Real, D>;

/// The half-space {x : normal·x ≤ offset}.
template <class Real, std::size_t D>
struct HalfSpace {
  Point<Real, D> normal;
  Real offset;
  std::uint32_t name;  ///< an identifier that the caller chooses; may occur more than once
};

/// The bounds of the variables: |x_i| ≤ reach_i. They make each linear program bounded.
template <class Real, std::size_t D>
struct Bounds {
  Point<Real, D> reach;
  std::array<std::uint32_t, D> name;  ///< as in `HalfSpace`
};

/// The names of the half-spaces and bounds that determine an answer.
/// * If there is a best point, they are D names. The best point is the only point on all of the D
///   planes, and the goal is a sum of their normals with weights ≥ 0.
/// * Otherwise they are at most D + 1 names, and the half-spaces and bounds that they name have no
///   common point.
template <std::size_t D>
struct Tight {
  std::array<std::uint32_t, D + 1> name;
  std::size_t count = 0;
};

/// Scratch memory for any number of half-spaces in up to D + 1 variables.
template <class Real, std::size_t D>
struct HeapMemory : HeapMemory<Real, D - 1> {
  std::vector<HalfSpace<Real, D>> list;
};
template <class Real>
struct HeapMemory<Real, 0> {};
/// Scratch memory on the stack, for at most `Count` half-spaces in D + 1 variables. Each reduction
/// by one variable adds at most one half-space.
template <class Real, std::size_t D, std::size_t Count>
struct StackMemory : StackMemory<Real, D - 1, Count + 1> {
  std::array<HalfSpace<Real, D>, Count + 1> list;
};
template <class Real, std::size_t Count>
struct StackMemory<Real, 0, Count> {};

template <class Real, std::size_t D>
HalfSpace<Real, D>* memoryFor(HeapMemory<Real, D>& memory, std::size_t count) {
  if (memory.list.size() < count) memory.list.resize(count);
  return memory.list.data();
}
template <class Real, std::size_t D, std::size_t Count>
HalfSpace<Real, D>* memoryFor(StackMemory<Real, D, Count>& memory, std::size_t) {
  return memory.list.data();
}

template <class Real, std::size_t D>
Real dot(const Point<Real, D>& a, const Point<Real, D>& b) {
  Real sum = a[0] * b[0];
  for (std::size_t i = 1; i < D; ++i) sum += a[i] * b[i];
  return sum;
}

/// Returns the array without its k-th entry.
template <class T, std::size_t D>
std::array<T, D - 1> without(const std::array<T, D>& all, std::size_t k) {
  std::array<T, D - 1> rest;
  for (std::size_t i = 0, to = 0; i < D; ++i)
    if (i != k) rest[to++] = all[i];
  return rest;
}

/// If some point is within all bounds and half-spaces, sets x to such a point that is farthest
/// along `goal`, and returns true. Otherwise returns false. In both cases `tight` names the
/// half-spaces and bounds that prove the answer.
template <class Real, class Memory>
bool solve(const Bounds<Real, 1>& bounds, std::span<const HalfSpace<Real, 1>> list,
           const Point<Real, 1>& goal, Point<Real, 1>& x, Tight<1>& tight, Memory&) {
  Real low = -bounds.reach[0], high = bounds.reach[0];
  std::uint32_t lowest = bounds.name[0], highest = bounds.name[0];
  for (const HalfSpace<Real, 1>& each : list) {
    const Real& n = each.normal[0];
    if (n > 0 && each.offset < high * n) high = each.offset / n, highest = each.name;
    if (n < 0 && each.offset < low * n) low = each.offset / n, lowest = each.name;
    if (n == 0 && each.offset < 0) {
      tight = {{each.name}, 1};
      return false;
    }
  }
  if (low > high) {
    tight = {{lowest, highest}, 2};
    return false;
  }
  const bool up = goal[0] > 0;
  x[0] = up ? high : low;
  tight = {{up ? highest : lowest}, 1};
  return true;
}

template <class Real, std::size_t D, class Memory>
bool solve(const Bounds<Real, D>& bounds, std::span<const HalfSpace<Real, D>> list,
           const Point<Real, D>& goal, Point<Real, D>& x, Tight<D>& tight, Memory& memory) {
  for (std::size_t i = 0; i < D; ++i) {
    x[i] = goal[i] > 0 ? bounds.reach[i] : -bounds.reach[i];
    tight.name[i] = bounds.name[i];
  }
  tight.count = D;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const HalfSpace<Real, D>& plane = list[i];
    if (!(dot(plane.normal, x) > plane.offset)) continue;
    // On the plane, x_k = share − Σ slope_j x_j over all j other than k, where k is the index of
    // the normal's largest entry.
    using std::abs;
    std::size_t k = 0;
    for (std::size_t j = 1; j < D; ++j)
      if (abs(plane.normal[j]) > abs(plane.normal[k])) k = j;
    if (plane.normal[k] == 0) {
      tight = {{plane.name}, 1};
      return false;
    }
    const Real share = plane.offset / plane.normal[k];
    Point<Real, D - 1> slope = without(plane.normal, k);
    for (Real& s : slope) s /= plane.normal[k];
    HalfSpace<Real, D - 1>* const rest = memoryFor<Real, D - 1>(memory, i + 2);
    for (std::size_t j = 0; j < i; ++j) {
      const Real& n = list[j].normal[k];
      rest[j].normal = without(list[j].normal, k);
      for (std::size_t m = 0; m < D - 1; ++m) rest[j].normal[m] -= n * slope[m];
      rest[j].offset = list[j].offset - n * share;
      rest[j].name = list[j].name;
    }
    rest[i] = rest[i + 1] = {slope, bounds.reach[k] + share, bounds.name[k]};
    for (Real& s : rest[i].normal) s = -s;
    rest[i].offset = bounds.reach[k] - share;
    Point<Real, D - 1> toward = without(goal, k), y;
    for (std::size_t m = 0; m < D - 1; ++m) toward[m] -= goal[k] * slope[m];
    const Bounds<Real, D - 1> fewer{without(bounds.reach, k), without(bounds.name, k)};
    Tight<D - 1> below;
    const bool found = solve(fewer, std::span<const HalfSpace<Real, D - 1>>(rest, i + 2), toward, y,
                             below, memory);
    for (std::size_t j = 0; j < below.count; ++j) tight.name[j] = below.name[j];
    tight.name[below.count] = plane.name;
    tight.count = below.count + 1;
    if (!found) return false;
    for (std::size_t j = 0, from = 0; j < D; ++j)
      if (j != k) x[j] = y[from++];
    x[k] = share - dot(slope, y);
  }
  return true;
}

}  // namespace corridor::seidel
