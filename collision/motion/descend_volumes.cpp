#include "collision/motion/descend_volumes.h"

#include <algorithm>
#include <cmath>

#include "collision/core/rounding.h"
#include "collision/hierarchy/traverse.h"
#include "collision/motion/moving_parts.h"
#include "collision/volumes/pair_tests.h"

/// Derivation of the pad. Let X̂ be the rounded map at the interval's middle. Volumes are tested
/// under X̂, taken as exact (`PairTest` with an `error` of 0). Anywhere in the interval and in the
/// tube, a point p of b is within isotropic + pad of X̂p, by the `MotionBound` of a sphere that
/// contains p. Suppose that two volumes are farther apart than margin + isotropic + pad under X̂.
/// Then their contents never come nearer than the margin.
///
/// The sphere is the mapped bounding sphere of the volume. Its centre c is off by 2u of |c| and of
/// the radius. The mapped centre M c + t is off by less than 8u of its terms per coordinate. 16u of
/// all the terms, as a length, covers both errors.
namespace corridor {
namespace {

/// Time is split before space if b's volume moves farther than this fraction of the larger volume's
/// radius. Soundness does not depend on the fraction. Measured on plans, with boxes and k-DOPs:
/// compared with this fraction, the fraction 1 needs three times as many tests for arms, and 1.1 to
/// 1.3 times as many for rigid bodies; the fraction 1/64 needs twice as many for rigid bodies.
constexpr double kTravelOfSize = 0.125;

/// The query that `traverseFrom` runs for `descend`: two binary trees in one time interval.
template <class Volume, class Overlap>
class MovingVolumes {
 public:
  using Tree = VolumeTree<Volume>;
  using Node = typename Tree::Node;
  using Item = NodePair;

  MovingVolumes(const Tree& a, const Tree& b, const RelativeMotion& relative,
                const DescentOptions& options, std::vector<NodePair4>& later, Counters& counters)
      : a_(a),
        b_(b),
        relative_(relative),
        test_(a.bounds(), b.bounds(), relative.X_AB, 0),
        options_(options),
        later_(later),
        counters_(counters) {}

  // The members that `traverse` calls.

  bool enter(const Item& item, const Node& na, const Node& nb) {
    item_ = item;
    if (outOfWork()) return false;
    if (deferred_ >= options_.deferAllAfter) return defer();
    ++counters_.boxTests;
    const Travel bound = motionBoundOfVolume(item.b, nb);
    if (apart(na.box, nb.box, bound.pad)) return false;
    const double size = kTravelOfSize * std::max(na.radius, nb.radius);
    const bool coarse = bound.far && bound.isotropic > std::max(size, bound.fixed);
    return coarse && !options_.shortest ? defer() : true;
  }

  bool leaves(const Node& na, const Node& nb) {
    for (std::uint32_t s = na.first; s < na.first + na.count; ++s)
      for (std::uint32_t t = nb.first; t < nb.first + nb.count; ++t) {
        if (outOfWork()) return true;
        const MovingPairAnswer answer = decide(s, t);
        counters_.addTest(answer.exact);
        const LeafOutcome pair =
            outcomeOf(answer, a_.meshTriangle(s), b_.meshTriangle(t), options_, result_);
        if (pair == LeafOutcome::deferred) return defer();
        if (pair == LeafOutcome::last) return true;
      }
    return false;
  }

  void push(std::vector<Item>& stack, std::uint32_t i, std::uint32_t k) { stack.push_back({i, k}); }
  void opened(std::vector<Item>&, std::size_t) {}

  /// Leaves the current node pair to shorter intervals. Returns false: `traverse` then neither
  /// opens the pair nor ends.
  bool defer() {
    defer(item_);
    ++deferred_;
    return false;
  }
  void defer(const Item& item) { later_.push_back({item.a, item.b, 0, kWholeTrees[0].pairs}); }

  const Descent& result() const { return result_; }

 private:
  /// The motion bound of b's volume in the interval, metres.
  struct Travel {
    double isotropic = 0;  ///< isotropic motion bound: smaller in shorter intervals
    double fixed = 0;      ///< tube, rounding and clearance slack: the same in every interval
    double pad = 0;        ///< the margin, `isotropic` and `fixed` together, rounded up
    bool far = false;      ///< `isotropic` exceeds the tolerance: shorter intervals may help
  };

  /// Returns the motion bound of the volume of node `number` of b. Keeps the result of the last
  /// call, because several nodes of a are tested against one node of b in succession.
  const Travel& motionBoundOfVolume(std::uint32_t number, const Node& nb) {
    if (number == travelNode_) return bound_;
    travelNode_ = number;
    const Vec3 y = relative_.X_AB.m * nb.box.ballCenter();
    const double terms = y.cwiseAbs().sum() + nb.radius + relative_.X_AB.t.cwiseAbs().sum();
    const MotionBound goes =
        motionBound(relative_, y + relative_.X_AB.t, roundedUp(nb.radius + 16 * kUnit * terms));
    bound_ = {goes.isotropic, goes.pad, roundedUp(options_.margin + goes.isotropic + goes.pad),
              goes.isotropic > options_.tolerance};
    return bound_;
  }

  bool apart(const Volume& a, const Volume& b, double pad) {
    if (!options_.clearance) return test_.separated(a, b, pad);
    const double gap = test_.distanceBound(a, b) - pad;
    if (!(gap > 0)) return false;
    result_.clearance = std::min(result_.clearance, roundedDown(gap));
    return true;
  }

  MovingPairAnswer decide(std::uint32_t s, std::uint32_t t) {
    const bool partsA = a_.hasParts(), partsB = b_.hasParts();
    const double margin = options_.margin;
    if (partsA && partsB) return decideMovingParts(a_.part(s), b_.part(t), relative_, margin);
    if (partsA) return decideMovingParts(a_.part(s), b_.triangle(t), relative_, margin);
    if (partsB) return decideMovingParts(a_.triangle(s), b_.part(t), relative_, margin);
    return decideMovingTriangles(a_.triangle(s), b_.triangle(t), relative_, margin);
  }

  bool outOfWork() {
    if (counters_.work() < options_.workEnd) return false;
    result_.kind = Descent::Kind::workLimit;
    return true;
  }

  const Tree &a_, &b_;
  const RelativeMotion& relative_;
  const PairTest<Volume, Overlap> test_;
  const DescentOptions& options_;
  std::vector<NodePair4>& later_;
  Counters& counters_;
  Item item_{};  // the current node pair
  std::uint32_t travelNode_ = ~std::uint32_t{0};
  Travel bound_;           // bound of node `travelNode_` of b
  unsigned deferred_ = 0;  // node pairs of this interval in `later_`
  Descent result_;
};

}  // namespace

template <class Overlap, BoundingVolume Volume>
Descent descend(std::span<const NodePair4> start, const VolumeTree<Volume>& a,
                const VolumeTree<Volume>& b, const RelativeMotion& relative,
                const DescentOptions& options, std::vector<NodePair4>& later,
                QueryContext& context) {
  MovingVolumes<Volume, Overlap> query(a, b, relative, options, later, context.counters);
  const auto use = context.scratch.use<NodePairs>();
  NodePairs& stack = *use;
  fillStack(start, stack);
  traverseFrom(a, b, stack, query);
  if (query.result().kind == Descent::Kind::contact) {
    query.defer();
    for (const NodePair& item : stack) query.defer(item);
  }
  return query.result();
}

#define CORRIDOR_DESCEND(kind, Volume, Overlap, volumeName, overlapName)                \
  template Descent descend<Overlap>(                                                    \
      std::span<const NodePair4>, const VolumeTree<Volume>&, const VolumeTree<Volume>&, \
      const RelativeMotion&, const DescentOptions&, std::vector<NodePair4>&, QueryContext&);
CORRIDOR_EACH_OVERLAP(CORRIDOR_DESCEND)
#undef CORRIDOR_DESCEND

}  // namespace corridor
