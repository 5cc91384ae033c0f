#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "planner/verify/convex_gap.h"
#include "planner/verify/exact_contact.h"
#include "planner/verify/triangle_gap.h"

namespace corridor::verify {

/// What a body is made of: a triangle of its mesh, or its convex part.
struct Piece {
  Corners corners = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  ///< of a triangle
  RealVec normal = RealVec::Zero();  ///< of a triangle: unit, rounded; 0 where it has none
  std::uint32_t triangle = 0;
  const ConvexPart* part = nullptr;
};

/// Axis-aligned boxes over a body's pieces, one piece a leaf, split at the median centroid along
/// the longest axis. Boxes of triangles are exact: minima and maxima of stored doubles.
class BoxTree {
 public:
  static constexpr std::uint32_t noLeaf = UINT32_MAX;
  struct Node {
    Vec3 lower, upper;
    std::uint32_t left = 0, right = 0;  ///< indices of nodes
    std::uint32_t leaf = noLeaf;        ///< index of a piece, in a leaf
  };

  /// @pre at least one triangle.
  explicit BoxTree(const TriangleMesh& mesh);
  explicit BoxTree(const ConvexPart& part);

  const Node& node(std::uint32_t i) const { return nodes_[i]; }  ///< 0 is the root
  std::size_t size() const { return nodes_.size(); }
  const Piece& piece(std::uint32_t i) const { return pieces_[i]; }
  Real radius() const { return radius_; }  ///< about the origin, of all points; rounded up

 private:
  std::uint32_t build(std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end);

  std::vector<Piece> pieces_;
  std::vector<Node> nodes_;
  Real radius_ = 0;
};

/// Indices of pieces of body a and body b.
struct PiecePair {
  std::uint32_t a = 0, b = 0;
};

/// The distance of two bodies, bracketed, up to the rounding of TriangleGap; points in a's frame.
struct BodyGap {
  Real lower = std::numeric_limits<Real>::infinity();
  Real upper = std::numeric_limits<Real>::infinity();
  PiecePair pair;  ///< of `upper`
  RealVec onA = RealVec::Zero(), onB = RealVec::Zero();
  bool touching =
      false;  ///< `touches` said so of `pair`; the search ended there, upper = lower = 0
};

/// A box along the axes of a's frame.
struct CentredBox {
  RealVec centre, half;
};

/// Distances of two bodies, b placed in the frame of a; owns the scratch memory.
class BodyDistance {
 public:
  /// Both trees must outlive the questions.
  void place(const BoxTree& a, const BoxTree& b, const Placement& X_AB);

  /// Branch and bound on box distances. `guess` is a pair that is likely close. What is farther
  /// than `stop` is not looked at. Pairs at `doubt` or less are shown to `touches`, which decides
  /// exactly; the first that touches ends the search.
  ///
  /// Whatever is not looked at is accounted for: `lower` is the least of the bounds of all pairs of
  /// boxes left out and of all pairs of pieces tested. The box of a node of b is |R|·(half extents)
  /// about the image of its centre; its rounding (3 sums of 3 products, a root of three squares:
  /// under 32u·S) is left to the caller, like the rest.
  BodyGap measure(PiecePair guess, Real doubt, Real stop,
                  const std::function<bool(PiecePair)>& touches);

  /// All pairs of pieces whose boxes are not `within` or more apart, nor in boxes that are
  /// `settled`, but no more than `most`.
  /// @returns false if there are more; all others are at least `within` apart, or settled.
  using Settled = std::function<bool(const CentredBox& a, const CentredBox& b)>;
  bool near(Real within, std::size_t most, const Settled& settled, std::vector<PiecePair>& pairs);

  ConvexSet setA(std::uint32_t piece) const;
  ConvexSet setB(std::uint32_t piece) const;  ///< in a's frame
  /// `guess` and `enough` as in convexGap.
  TriangleGap gap(PiecePair pair, const RealVec& guess = RealVec::Zero(),
                  Real enough = std::numeric_limits<Real>::infinity()) const;

 private:
  struct Item {
    std::uint32_t a, b;
    Real lower;
  };
  CentredBox boxA(std::uint32_t node) const;
  /// A node of b, placed: the box around it along a's axes, and its own, along b's.
  struct PlacedBox {
    CentredBox around;
    RealVec centre = RealVec::Zero(), half = RealVec::Zero();  ///< half along b's axes
    std::uint64_t stamp = 0;                                   ///< the placement that made it
  };
  const PlacedBox& boxB(std::uint32_t node);
  /// Of the closest points so far.
  void lookAlong(const RealVec& between);
  /// A bound by one means after the other, until it is `enough`.
  Real boxGap(std::uint32_t a, std::uint32_t b, Real enough);
  Item item(std::uint32_t a, std::uint32_t b, Real enough) { return {a, b, boxGap(a, b, enough)}; }
  /// The two halves of an item that isn't a pair of leaves.
  std::array<Item, 2> split(const Item& item, Real enough);
  /// Of a triangle and a box: by the slab along the triangle's normal, either way.
  static Real planeGap(const RealVec& normal, const std::array<RealVec, 3>& corners,
                       const CentredBox& box);
  std::array<RealVec, 3> cornersA(std::uint32_t piece) const;
  std::array<RealVec, 3> cornersB(std::uint32_t piece) const;

  const BoxTree* a_ = nullptr;
  const BoxTree* b_ = nullptr;
  Placement X_AB_;
  RealMat extents_ = RealMat::Identity();   ///< |X_AB_.rotation|
  std::optional<ConvexSet> partA_, partB_;  ///< where the body is one
  RealVec direction_ = RealVec::Zero();     ///< unit or zero: slabs along it are bounds, for boxes
  Real endOfA_ = 0, startOfB_ = 0;          ///< of the parts, along it
  std::vector<PlacedBox> boxesB_;
  std::uint64_t stamp_ = 0;
  std::vector<Item> stack_;
};

}  // namespace corridor::verify
