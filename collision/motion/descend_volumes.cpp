#include "collision/motion/descend_volumes.h"

#include <algorithm>
#include <cmath>

#include "collision/core/rounding.h"
#include "collision/hierarchy/traverse.h"
#include "collision/motion/moving_parts.h"
#include "collision/volumes/pair_tests.h"

/// The pad. Let X̂ be the rounded map at the window's middle, taken as exact, under which volumes
/// are tested (`PairTest`, with no other error). A point p of b is, anywhere in the window and in
/// the tube, within cap + pad of X̂p (`PointTravel`, of a ball that holds p). So volumes that are
/// apart by more than margin + cap + pad under X̂ hold nothing that comes nearer than the margin.
///
/// The ball is the volume's own, mapped: its centre c, off by 2u of |c| and the radius, goes to
/// M c + t, off by less than 8u of its terms a coordinate; 16u of all the terms as a length.
namespace corridor {
namespace {

/// Time is split before space where b's volume goes farther than so much of the larger one's
/// radius. Measured on plans with boxes and k-DOPs; soundness needs no such number. With 1, arms
/// take three times as many tests, rigid bodies a tenth to a third more; with 1/64 these take twice
/// as many.
constexpr double kTravelOfSize = 0.125;

template <class Volume, class Overlap>
class MovingVolumes {
 public:
  using Tree = VolumeTree<Volume>;
  using Node = typename Tree::Node;
  using Item = QueryContext::NodePair;

  MovingVolumes(const Tree& a, const Tree& b, const MotionWindow& window,
                const DescentOptions& options, std::vector<QueryContext::WideItem>& later,
                Counters& counters)
      : a_(a),
        b_(b),
        window_(window),
        test_(a.bounds(), b.bounds(), window.X_AB, 0),
        options_(options),
        later_(later),
        counters_(counters) {}

  // What `traverse` asks.

  bool enter(const Item& item, const Node& na, const Node& nb) {
    item_ = item;
    if (outOfWork()) return false;
    if (left_ >= options_.mostLeft) return leave();
    ++counters_.boxTests;
    const Travel travel = travelOfVolume(item.b, nb);
    if (apart(na.box, nb.box, travel.pad)) return false;
    const double size = kTravelOfSize * std::max(na.radius, nb.radius);
    const bool coarse = travel.far && travel.cap > std::max(size, travel.fixed);
    return coarse && !options_.shortest ? leave() : true;
  }

  bool leaves(const Node& na, const Node& nb) {
    for (std::uint32_t s = na.first; s < na.first + na.count; ++s)
      for (std::uint32_t t = nb.first; t < nb.first + nb.count; ++t) {
        if (outOfWork()) return true;
        const LeafPair pair =
            judged(decide(s, t), a_.meshTriangle(s), b_.meshTriangle(t), options_, result_);
        if (pair == LeafPair::left) return leave();
        if (pair == LeafPair::last) return true;
      }
    return false;
  }

  void push(std::vector<Item>& stack, std::uint32_t i, std::uint32_t k) {
    stack.push_back({i, k, 0});
  }
  void opened(std::vector<Item>&, std::size_t) {}

  /// Leaves the pair that was looked at last to shorter windows. @return false: its nodes are not
  /// gone into.
  bool leave() {
    leave(item_);
    ++left_;
    return false;
  }
  void leave(const Item& item) {
    later_.push_back({item.a, item.b, 0, QueryContext::kWholeTrees.pairs});
  }

  const Descent& result() const { return result_; }

 private:
  /// How far b's volume goes in the window. Metres.
  struct Travel {
    double cap = 0;    ///< by the motion: half of it in half of the window
    double fixed = 0;  ///< tube, rounding and reserve besides: no window has less
    double pad = 0;    ///< margin and both, rounded up
    bool far = false;  ///< shorter windows are worth it: more than the tolerance
  };

  /// Children of a's nodes are tested against one of b's after the other: the last one is kept.
  const Travel& travelOfVolume(std::uint32_t number, const Node& nb) {
    if (number == travelNode_) return travel_;
    travelNode_ = number;
    const Vec3 y = window_.X_AB.m * nb.box.ballCenter();
    const double terms = y.cwiseAbs().sum() + nb.radius + window_.X_AB.t.cwiseAbs().sum();
    const PointTravel goes =
        travelOf(window_, y + window_.X_AB.t, roundedUp(nb.radius + 16 * kUnit * terms));
    travel_ = {goes.cap, goes.pad, roundedUp(options_.margin + goes.cap + goes.pad),
               goes.cap > options_.tolerance};
    return travel_;
  }

  bool apart(const Volume& a, const Volume& b, double pad) {
    if (!options_.clearance) return test_.separated(a, b, pad);
    const double gap = test_.distanceBound(a, b) - pad;
    if (!(gap > 0)) return false;
    result_.clearance = std::min(result_.clearance, roundedDown(gap));
    return true;
  }

  MovingTrianglesAnswer decide(std::uint32_t s, std::uint32_t t) {
    const ConvexPart *pa = a_.part(s), *pb = b_.part(t);
    const double margin = options_.margin;
    if (pa && pb) return decideMovingParts(*pa, *pb, window_, margin, counters_);
    if (pa) return decideMovingParts(*pa, b_.triangle(t), window_, margin, counters_);
    if (pb) return decideMovingParts(a_.triangle(s), *pb, window_, margin, counters_);
    return decideMovingTriangles(a_.triangle(s), b_.triangle(t), window_, margin, counters_);
  }

  bool outOfWork() {
    if (counters_.work() < options_.workEnd) return false;
    result_.kind = Descent::Kind::workLimit;
    return true;
  }

  const Tree &a_, &b_;
  const MotionWindow& window_;
  const PairTest<Volume, Overlap> test_;
  const DescentOptions& options_;
  std::vector<QueryContext::WideItem>& later_;
  Counters& counters_;
  Item item_{};  // looked at last
  std::uint32_t travelNode_ = ~std::uint32_t{0};
  Travel travel_;      // of that node of b
  unsigned left_ = 0;  // pairs that `later_` has of this window
  Descent result_;
};

}  // namespace

template <class Overlap, BoundingVolume Volume>
Descent descend(const VolumeTree<Volume>& a, const VolumeTree<Volume>& b,
                const MotionWindow& window, const DescentOptions& options, std::size_t count,
                std::vector<QueryContext::WideItem>& later, QueryContext& context) {
  MovingVolumes<Volume, Overlap> query(a, b, window, options, later, context.counters);
  context.stackFrom(count);
  traverseFrom(a, b, context.stack, query);
  if (query.result().kind == Descent::Kind::contact) {
    query.leave();
    for (const QueryContext::NodePair& item : context.stack) query.leave(item);
  }
  return query.result();
}

#define CORRIDOR_DESCEND(Volume, Overlap)                                                    \
  template Descent descend<Overlap>(const VolumeTree<Volume>&, const VolumeTree<Volume>&,    \
                                    const MotionWindow&, const DescentOptions&, std::size_t, \
                                    std::vector<QueryContext::WideItem>&, QueryContext&);
CORRIDOR_EACH_OVERLAP(CORRIDOR_DESCEND)
#undef CORRIDOR_DESCEND

}  // namespace corridor
