#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "collision/core/counters.h"
#include "collision/core/last_pairs.h"
#include "collision/core/swept_ball.h"
#include "collision/core/transform.h"

namespace corridor {

/// What a query may write: scratch memory, counters and guesses of one thread. No verdict depends
/// on what it holds, and no distance beyond the error that it may have; which of several triangles
/// are named for it may.
class QueryContext {
 public:
  Counters counters;

  /// A pair of tree nodes, of the pair of bodies numbered `bodies` where several share a list.
  struct NodePair {
    std::uint32_t a, b, bodies;
  };
  std::vector<NodePair> stack;  ///< of the traversal under way
  /// Two nodes of wide trees, the least key of their boxes' pairs, and which of these are asked
  /// about: bit 4·i + j for a's i-th and b's j-th.
  struct WideItem {
    std::uint32_t a, b;
    float key;
    std::uint32_t pairs;
  };
  /// All of two trees.
  static constexpr WideItem kWholeTrees = {0, 0, -HUGE_VALF, 0xffff};
  std::vector<WideItem> wideStack;  ///< what a walk begins with, and what it has left
  void startAtRoots() {
    if (wideStack.empty()) wideStack.resize(1);
    wideStack[0] = kWholeTrees;
  }
  /// The pairs of nodes of its first `count` items on `stack`, for binary trees.
  void stackFrom(std::size_t count) {
    stack.clear();
    for (std::size_t i = 0; i < count; ++i) stack.push_back({wideStack[i].a, wideStack[i].b, 0});
  }
  /// Pairs of nodes of one pair of bodies: a range of `pending`.
  struct PairItems {
    std::uint32_t bodies;
    std::size_t begin, end;
    double clearance = 0;  ///< of what longer windows told apart already, metres; where asked for
  };
  std::vector<WideItem> pending;  ///< what motion queries hand down to shorter windows of time,
  std::vector<PairItems> groups;  ///< and whose it is
  /// Balls around the bodies of a scene, as the world sees them in one window of time; each is made
  /// where it is first asked for.
  class Balls {
   public:
    void makeRoom(std::size_t bodies) {
      if (balls_.size() < bodies) balls_.resize(bodies);
    }
    void forget() { ++stamp_; }
    /// @pre room for it. `make` asks for no ball.
    template <class Make>
    const SweptBall& of(std::size_t body, const Make& make) {
      Stamped& known = balls_[body];
      if (known.stamp != stamp_) known = {make(), stamp_};
      return known.ball;
    }

   private:
    struct Stamped {
      SweptBall ball;
      std::uint64_t stamp = 0;
    };
    std::vector<Stamped> balls_;
    std::uint64_t stamp_ = 0;
  };
  Balls balls;
  /// What distance queries have left to look at, and pairs of triangles (in leaf order) that may be
  /// the closest, each with a lower bound of its distance, metres.
  struct BoundedPair {
    std::uint32_t a, b;
    double bound;
  };
  std::vector<BoundedPair> bounded, candidates;
  LastPairs lastPairs;  ///< of wide trees: where their queries look first
};

}  // namespace corridor
