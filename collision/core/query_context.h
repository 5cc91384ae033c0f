#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "collision/core/counters.h"
#include "collision/core/last_pairs.h"
#include "collision/core/swept_sphere.h"
#include "collision/core/transform.h"

namespace corridor {

/// All that a query may write: scratch memory, counters and guesses. Each thread has its own. The
/// contents never change a verdict, nor a distance beyond its error bound. They may change which of
/// several closest or touching triangles is reported.
class QueryContext {
 public:
  Counters counters;

  /// A pair of tree nodes. `bodies` is the number of their pair of bodies if several share a list.
  struct NodePair {
    std::uint32_t a, b, bodies;
  };
  std::vector<NodePair> stack;  ///< node pairs that the current traversal has still to visit
  /// A pair of nodes of 4-wide trees. `pairs` selects the pairs of their boxes to test: bit 4·i + j
  /// for the i-th box of a and the j-th of b. `key` is the least key of these pairs, by which a
  /// traversal orders them.
  struct NodePair4 {
    std::uint32_t a, b;
    float key;
    std::uint32_t pairs;
  };
  /// The pair of both roots.
  static constexpr NodePair4 kWholeTrees = {0, 0, -HUGE_VALF, 0xffff};
  std::vector<NodePair4> stack4;  ///< the node pairs that a traversal starts from, and has left
  void startAtRoots() {
    if (stack4.empty()) stack4.resize(1);
    stack4[0] = kWholeTrees;
  }
  /// Copies the first `count` node pairs of `stack4` to `stack`, for binary trees.
  void stackFrom(std::size_t count) {
    stack.clear();
    for (std::size_t i = 0; i < count; ++i) stack.push_back({stack4[i].a, stack4[i].b, 0});
  }
  /// The node pairs of one pair of bodies in a work list: a range of `openPairs`.
  struct PairWork {
    std::uint32_t bodies;
    std::size_t begin, end;
    /// Lower bound of the clearance of the node pairs that longer time intervals have separated
    /// already, metres; only if the query needs it.
    double clearance = 0;
  };
  /// The work list of a motion query: the node pairs that a time interval leaves to its halves.
  std::vector<NodePair4> openPairs;
  std::vector<PairWork> workList;  ///< the ranges of `openPairs`, by pair of bodies
  /// Swept spheres around the bodies of a scene, in the world frame, for one time interval. Each is
  /// computed when it is first needed.
  class SweptSpheres {
   public:
    void makeRoom(std::size_t bodies) {
      if (spheres_.size() < bodies) spheres_.resize(bodies);
    }
    /// Discards all, for another time interval.
    void forget() { ++stamp_; }
    /// Returns the body's swept sphere, computed by `make` if there is none yet.
    /// @pre `makeRoom` included the body, and `make` calls no member of this class.
    template <class Make>
    const SweptSphere& of(std::size_t body, const Make& make) {
      Stamped& known = spheres_[body];
      if (known.stamp != stamp_) known = {make(), stamp_};
      return known.sphere;
    }

   private:
    struct Stamped {
      SweptSphere sphere;
      std::uint64_t stamp = 0;
    };
    std::vector<Stamped> spheres_;
    std::uint64_t stamp_ = 0;
  };
  SweptSpheres spheres;
  /// A pair of nodes or of leaf primitives (in leaf order), with a lower bound of its distance,
  /// metres.
  struct BoundedPair {
    std::uint32_t a, b;
    double bound;
  };
  /// Used by distance queries: `bounded` are the pairs still to test, `candidates` the pairs of
  /// leaf primitives that may be the closest.
  std::vector<BoundedPair> bounded, candidates;
  LastPairs lastPairs;  ///< the pairs that queries on 4-wide OBB trees test first
};

}  // namespace corridor
