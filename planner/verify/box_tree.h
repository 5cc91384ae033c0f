#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "planner/verify/exact_contact.h"
#include "planner/verify/triangle_gap.h"

namespace corridor::verify {

/// A triangle of one of several meshes that share a frame.
struct SoupTriangle {
  Corners corners;
  std::uint32_t mesh = 0, triangle = 0;  ///< index of the mesh, and of the triangle in it
};

/// Axis-aligned boxes over triangles, one triangle a leaf, split at the median centroid along the
/// longest axis. Boxes are exact: minima and maxima of stored doubles.
class BoxTree {
 public:
  static constexpr std::uint32_t noLeaf = UINT32_MAX;
  struct Node {
    Vec3 lower, upper;
    std::uint32_t left = 0, right = 0;  ///< indices of nodes
    std::uint32_t leaf = noLeaf;        ///< index of a triangle, in a leaf
  };

  explicit BoxTree(std::vector<SoupTriangle> soup);

  bool empty() const { return nodes_.empty(); }
  const Node& node(std::uint32_t i) const { return nodes_[i]; }  ///< 0 is the root
  std::size_t size() const { return nodes_.size(); }
  const SoupTriangle& triangle(std::uint32_t i) const { return soup_[i]; }
  const std::vector<SoupTriangle>& triangles() const { return soup_; }

 private:
  std::uint32_t build(std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end);

  std::vector<SoupTriangle> soup_;
  std::vector<Node> nodes_;
};

/// Indices of triangles of the moving and the fixed tree.
struct TrianglePair {
  std::uint32_t moving = 0, fixed = 0;
};

/// The map x ↦ rotation·x + position, rounded; the caller knows by how much.
struct Placement {
  RealMat rotation;
  RealVec position;
};

/// The distance of two soups, bracketed, up to the rounding of TriangleGap.
struct SoupGap {
  Real lower = std::numeric_limits<Real>::infinity();
  Real upper = std::numeric_limits<Real>::infinity();
  TrianglePair pair;  ///< of `upper`
  RealVec onMoving = RealVec::Zero(), onFixed = RealVec::Zero();
  bool touching =
      false;  ///< `touches` said so of `pair`; the search ended there, upper = lower = 0
};

/// Distances of the same two trees under many placements; owns the scratch memory.
class SoupDistance {
 public:
  SoupDistance(const BoxTree& moving, const BoxTree& fixed);

  /// Branch and bound on box distances. `guess` is a pair that is likely close. Pairs at `doubt` or
  /// less are shown to `touches`, which decides exactly; the first that touches ends the search.
  ///
  /// Whatever is not looked at is accounted for: `lower` is the least of the bounds of all pairs of
  /// boxes left out and of all pairs of triangles tested. The box of a moving node is |R|·(half
  /// extents) about the image of its centre; its rounding (3 sums of 3 products, a root of three
  /// squares: under 32u·S) is left to the caller, like the rest.
  SoupGap measure(const Placement& placement, TrianglePair guess, Real doubt,
                  const std::function<bool(TrianglePair)>& touches);

 private:
  struct Box {
    RealVec centre, half;
  };
  struct Item {
    std::uint32_t moving, fixed;
    Real lower;
  };
  const Box& movingBox(std::uint32_t node);
  Real boxGap(std::uint32_t moving, std::uint32_t fixed);
  std::array<RealVec, 3> image(std::uint32_t triangle) const;  ///< of a moving one
  /// Only a lower bound, where that is cheap and `enough`.
  TriangleGap gap(TrianglePair pair, Real enough) const;

  const BoxTree& moving_;
  const BoxTree& fixed_;
  Placement placement_;
  RealVec direction_;  ///< of the closest points so far, unit or zero: slabs along it are bounds,
                       ///< for boxes too
  std::vector<Box> movingBoxes_, fixedBoxes_;
  std::vector<std::uint64_t> stamps_;  ///< of movingBoxes_: the measurement that made them
  std::uint64_t stamp_ = 0;
  std::vector<Item> stack_;
};

}  // namespace corridor::verify
