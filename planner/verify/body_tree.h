#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "planner/verify/convex_gap.h"
#include "planner/verify/exact_contact.h"
#include "planner/verify/triangle_gap.h"

namespace corridor::verify {

/// A leaf primitive of a body: a triangle of its mesh, or one of its convex parts.
struct LeafPrimitive {
  Corners corners = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  ///< triangle only
  RealVec normal = RealVec::Zero();  ///< triangle only: unit, rounded; 0 if degenerate
  std::uint32_t number = 0;          ///< index of the triangle or part in the body
  const ConvexPart* part = nullptr;
};

/// A binary tree of axis-aligned boxes over a body's leaf primitives. Each leaf has one leaf
/// primitive. Nodes are split at the median centroid along the longest axis. Boxes of triangles are
/// exact: minima and maxima of stored doubles. Boxes of parts are rounded outward.
class BodyTree {
 public:
  static constexpr std::uint32_t noLeaf = UINT32_MAX;
  struct Node {
    Vec3 lower, upper;
    std::uint32_t left = 0, right = 0;  ///< indices of nodes
    std::uint32_t leaf = noLeaf;        ///< index of a leaf primitive; only in a leaf
  };

  /// @pre the mesh has a triangle.
  explicit BodyTree(const TriangleMesh& mesh);
  /// @pre at least one part; each part has at least one point.
  explicit BodyTree(std::span<const ConvexPart> parts);

  const Node& node(std::uint32_t i) const { return nodes_[i]; }  ///< 0 is the root
  std::size_t size() const { return nodes_.size(); }
  const LeafPrimitive& leaf(std::uint32_t i) const { return leaves_[i]; }
  bool hasParts() const { return leaves_[0].part != nullptr; }
  /// Returns the distance of the farthest point from the origin of the body's frame, rounded up.
  Real radius() const { return radius_; }

 private:
  void build();
  std::uint32_t build(std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end);

  std::vector<LeafPrimitive> leaves_;
  std::vector<Node> nodes_;
  Real radius_ = 0;
};

/// A pair of leaf primitives: indices in body a and in body b.
struct LeafPair {
  std::uint32_t a = 0, b = 0;
};

/// Lower and upper bound of the distance of two bodies, and witness points in a's frame. Both
/// bounds may be off by the rounding that DistanceBounds describes.
struct BodyGap {
  Real lower = std::numeric_limits<Real>::infinity();
  Real upper = std::numeric_limits<Real>::infinity();
  LeafPair pair;  ///< the pair of leaf primitives that gives `upper`
  RealVec onA = RealVec::Zero(), onB = RealVec::Zero();
  bool touching = false;  ///< `touches` found contact of `pair`; then upper = lower = 0
};

/// A box along the axes of a's frame.
struct CentredBox {
  RealVec centre, half;
};

/// Computes distances of two bodies, with b placed in the frame of a. Owns the scratch memory.
///
/// Boxes are compared in double, which takes a fraction of the time of long double. Let S be the
/// sum of both radii and the distance of the two frames, and u = 2^-53. Every length that occurs is
/// at most √3·S. A coordinate of a placed box is computed from the rounded placement by three
/// products and three sums: it is off by less than 35u·S. For the comparison along the axes of b,
/// the difference of two boxes is transformed a second time, with errors of the same size. So each
/// coordinate of the difference is off by less than 90u·S, and its norm by less than 170u·S. Widths
/// of slabs take fewer steps. `boxError_` is 512u·S. If a bound in double is within `boxError_` of
/// the value with which it is compared, it is computed again in long double.
class BodyDistance {
 public:
  /// Sets the bodies and their relative placement. Both trees must outlive all queries.
  void place(const BodyTree& a, const BodyTree& b, const Placement& X_AB);

  /// Bounds the distance of the bodies by branch and bound on the distances of boxes.
  /// @param guess a pair of leaf primitives that is likely close; the search starts with it.
  /// @param doubt pairs of leaf primitives with a lower bound of at most `doubt` are passed to
  /// `touches`.
  /// @param stop pairs with a lower bound of at least `stop` are pruned.
  /// @param touches decides whether two leaf primitives touch. The first contact ends the search.
  ///
  /// The result's `lower` also covers all pruned pairs: it is the smallest bound of all pruned node
  /// pairs and all tested pairs of leaf primitives. Let R be the rotation of X_AB. The box of a
  /// node of b, in a's frame, has the half extents |R|·(half extents) about the image of its
  /// centre. The caller must add all rounding, also that of the boxes in long double. The rounding
  /// of the boxes is below 32u·S, with u = 2^-64: it comes from 3 sums of 3 products, and from the
  /// root of a sum of three squares.
  BodyGap measure(LeafPair guess, Real doubt, Real stop,
                  const std::function<bool(LeafPair)>& touches);

  /// A function that returns whether `collectNear` may leave out all pairs of a leaf primitive in
  /// one box and a leaf primitive in the other box.
  using Settled = std::function<bool(const CentredBox& a, const CentredBox& b)>;
  /// Collects the pairs of leaf primitives whose boxes are closer than `within`. Pairs in two boxes
  /// for which `settled` returns true are left out.
  /// @param most the largest number of pairs collected.
  /// @returns false if there are more pairs than `most`. If the result is true, all pairs that are
  /// not collected are at least `within` apart, or are settled.
  bool collectNear(Real within, std::size_t most, const Settled& settled,
                   std::vector<LeafPair>& pairs);

  ConvexSet setA(std::uint32_t leaf) const;
  ConvexSet setB(std::uint32_t leaf) const;  ///< in a's frame
  /// Returns the bounds of the distance of two leaf primitives. @param guess,enough see
  /// convexGap().
  DistanceBounds gap(LeafPair pair, const RealVec& guess = RealVec::Zero(),
                     Real enough = std::numeric_limits<Real>::infinity()) const;

 private:
  struct Item {
    std::uint32_t a, b;
    Real lower;
  };
  template <class Number>
  using Vec = Eigen::Matrix<Number, 3, 1>;
  /// A placement, and the direction of the slab that boxGap() tries. With Number = double, both are
  /// rounded.
  template <class Number>
  struct Frame {
    Eigen::Matrix<Number, 3, 3> rotation = Eigen::Matrix<Number, 3, 3>::Identity();
    Eigen::Matrix<Number, 3, 3> extents = Eigen::Matrix<Number, 3, 3>::Identity();  ///< |rotation|
    Vec<Number> position = Vec<Number>::Zero();
    Vec<Number> direction = Vec<Number>::Zero();  ///< unit or zero
  };
  template <class Number>
  struct Box {
    Vec<Number> centre, half;
  };
  /// The box of a node of b in a's frame, in two forms: a box along a's axes around it, and the box
  /// itself, along b's axes.
  template <class Number>
  struct PlacedBox {
    Box<Number> around, along;
  };
  struct StampedBox {
    PlacedBox<double> box;
    std::uint64_t stamp = 0;  ///< identifies the placement for which the box was computed
  };
  template <class Number>
  const Frame<Number>& frame() const;
  template <class Number>
  static Box<Number> boxOf(const BodyTree::Node& node);
  template <class Number>
  PlacedBox<Number> placedBox(std::uint32_t node) const;
  const PlacedBox<double>& boxB(std::uint32_t node);  ///< computed once for each placement
  /// Returns a box, along the axes of a, that contains the box of a node of a or of b.
  CentredBox aroundA(std::uint32_t node) const;
  CentredBox aroundB(std::uint32_t node);
  /// Sets the direction of the slab that boxGap() tries. @param between the vector between the
  /// closest points found so far.
  void lookAlong(const RealVec& between);
  /// Returns a lower bound of the distance of two nodes. Tries better and more expensive bounds
  /// until one reaches `enough`.
  Real boxGap(std::uint32_t a, std::uint32_t b, Real enough);
  template <class Number>
  Number boxGap(std::uint32_t a, std::uint32_t b, const PlacedBox<Number>& boxOfB,
                Number enough) const;
  Item item(std::uint32_t a, std::uint32_t b, Real enough) { return {a, b, boxGap(a, b, enough)}; }
  /// Splits one node of a node pair into its children. @pre the two nodes are not both leaves.
  std::array<Item, 2> split(const Item& item, Real enough);
  /// Returns a lower bound of the distance of a triangle and a box: the width of the slab between
  /// them along the triangle's normal. The box may be on either side of the triangle.
  template <class Number>
  static Number planeGap(const Vec<Number>& normal, const std::array<Vec<Number>, 3>& corners,
                         const Box<Number>& box);
  template <class Number = Real>
  std::array<Vec<Number>, 3> cornersA(std::uint32_t leaf) const;
  template <class Number = Real>
  std::array<Vec<Number>, 3> cornersB(std::uint32_t leaf) const;

  const BodyTree* a_ = nullptr;
  const BodyTree* b_ = nullptr;
  Placement X_AB_;
  Frame<Real> real_;
  Frame<double> double_;
  Real boxError_ = 0;  ///< metres; infinite if squares in double could overflow or vanish
  std::optional<ConvexSet> partA_, partB_;  ///< set if the body is a single convex part
  Real endOfA_ = 0, startOfB_ = 0;          ///< ends of the single parts along the direction
  std::vector<StampedBox> boxesB_;
  std::uint64_t stamp_ = 0;
  std::vector<Item> stack_;
};

}  // namespace corridor::verify
