#include "collision/course/front.h"

#include <algorithm>
#include <cmath>

#include "collision/core/rounding.h"
#include "collision/hierarchy/traverse.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/closest_points.h"
#include "collision/queries/touching_pairs.h"
#include "collision/volumes/pair_tests.h"

namespace corridor {
namespace {

/// Returns an upper bound of the distance between the images, under two maps, of a point x within
/// `reach` of the origin: |(M' − M)x + t' − t|. Differences, products, sums and roots are off by
/// less than 16u, relatively. Squares below 2^-1022 vanish, and so do lengths below 2^-511.
double displacementBound(const Transform& from, const Transform& to, double reach) {
  const double turn = (to.m - from.m).norm() + 0x1p-500, shift = (to.t - from.t).norm() + 0x1p-500;
  return roundedUp((1 + 32 * kUnit) * (turn * reach + shift));
}

}  // namespace

/// One query. Descends only from the pairs that are due: their gap may be used up
/// (`Front::Pair::until`).
template <BoundingVolume Volume>
class FrontQuery {
 public:
  using Tree = VolumeTree<Volume>;

  FrontQuery(const Tree& a, const Posed<Tree>& b, Front& front, QueryContext& context)
      : a_(a),
        b_(b.shape),
        X_AB_(b.X_W),
        front_(front),
        counters_(context.counters),
        useOfStack_(context.scratch.use<NodePairs>()),
        stack_(*useOfStack_),
        volumes_(pairTestOf<Volume>(Posed<Tree>(a), b)),
        triangles_({}, a.reach(), b.X_W, b.shape.reach()) {}

  std::optional<PrimitivePair> run() {
    if (front_.X_AB_)
      front_.moved_ =
          roundedUp(front_.moved_ + displacementBound(*front_.X_AB_, X_AB_, b_.reach()));
    // After a long path, the rounding of `moved_` would use up small gaps. If a front has grown
    // much, many of its pairs are deep in the trees although their volumes are far apart. In both
    // cases the query starts from the roots.
    const double size = a_.reach() + b_.reach();
    const bool start = !front_.X_AB_ || !(front_.moved_ < 0x1p20 * size) ||
                       front_.size() > 4 * front_.sizeAfterStart_ + 256;
    if (start) {
      front_.clear();
      keep({0, 0}, -HUGE_VAL);
    }
    front_.X_AB_ = X_AB_;
    // All pairs that are due are taken from the front before any of them is tested. A pair that is
    // found to have no gap is put back as due at once, but only for the next query.
    stack_.clear();
    while (!front_.pairs_.empty() && !(front_.pairs_.front().until > front_.moved_)) {
      std::pop_heap(front_.pairs_.begin(), front_.pairs_.end());
      stack_.push_back({front_.pairs_.back().a, front_.pairs_.back().b});
      front_.pairs_.pop_back();
    }
    std::reverse(stack_.begin(), stack_.end());
    const std::optional<PrimitivePair> found = descend();
    if (start) front_.sizeAfterStart_ = front_.size();
    return found;
  }

 private:
  /// Tests the pairs on the stack and those below them. Returns the first contact. If there is one,
  /// the pairs that are left on the stack are kept as due.
  std::optional<PrimitivePair> descend() {
    while (!stack_.empty()) {
      const NodePair pair = stack_.back();
      stack_.pop_back();
      const auto &na = a_.node(pair.a), &nb = b_.node(pair.b);
      ++counters_.boxTests;
      if (const double gap = volumes_.distanceBound(na.box, nb.box); gap > 0) {
        keepFor(pair, gap);
      } else if (na.isLeaf() && nb.isLeaf()) {
        if (const auto found = leaves(pair, na, nb)) {
          for (const NodePair& left : stack_) keep(left, -HUGE_VAL);
          return found;
        }
      } else if (nb.isLeaf() || (!na.isLeaf() && na.radius >= nb.radius)) {
        a_.forEachChildBackwards(pair.a, [&](std::uint32_t child) {
          stack_.push_back({child, pair.b});
        });
      } else {
        b_.forEachChildBackwards(pair.b, [&](std::uint32_t child) {
          stack_.push_back({pair.a, child});
        });
      }
    }
    return std::nullopt;
  }

  /// Tests the triangles of two leaves, and keeps the pair. Returns the first contact.
  template <class Node>
  std::optional<PrimitivePair> leaves(const NodePair& pair, const Node& na, const Node& nb) {
    double gap = HUGE_VAL;
    for (std::uint32_t s = na.first; s < na.first + na.count; ++s)
      for (std::uint32_t t = nb.first; t < nb.first + nb.count; ++t) {
        const PredicateResult touch = trianglesTouch(a_.triangle(s), {}, b_.triangle(t), X_AB_);
        counters_.addTest(touch.exact);
        if (touch) {
          keep(pair, -HUGE_VAL);
          return PrimitivePair{a_.meshTriangle(s), b_.meshTriangle(t)};
        }
        gap = std::min(gap, triangles_(a_.triangle(s), b_.triangle(t)).lower);
      }
    keepFor(pair, gap);
    return std::nullopt;
  }

  /// Keeps a pair that is proved to be at least `gap` apart now.
  void keepFor(const NodePair& pair, double gap) {
    keep(pair, gap > 0 ? roundedDown(front_.moved_ + gap) : -HUGE_VAL);
  }
  void keep(const NodePair& pair, double until) {
    front_.pairs_.push_back({pair.a, pair.b, until});
    std::push_heap(front_.pairs_.begin(), front_.pairs_.end());
  }

  const Tree &a_, &b_;
  const Transform& X_AB_;
  Front& front_;
  Counters& counters_;
  Scratch::Use<NodePairs> useOfStack_;
  NodePairs& stack_;
  PairTest<Volume> volumes_;
  TriangleDistances triangles_;
};

template <BoundingVolume Volume>
std::optional<PrimitivePair> interference(const VolumeTree<Volume>& a,
                                          const Posed<VolumeTree<Volume>>& b, Front& front,
                                          QueryContext& context) {
  return FrontQuery<Volume>(a, b, front, context).run();
}

#define CORRIDOR_FRONT(Volume)                        \
  template std::optional<PrimitivePair> interference( \
      const VolumeTree<Volume>&, const Posed<VolumeTree<Volume>>&, Front&, QueryContext&);
CORRIDOR_FRONT(Obb)
CORRIDOR_FRONT(Rss)
#undef CORRIDOR_FRONT

}  // namespace corridor
