#include <algorithm>
#include <bit>
#include <cmath>

#include "collision/convex/gjk.h"
#include "collision/motion/chain_filter_kernel.h"

/// The second part of `ChainFilter`: the hulls of the pairs whose balls are not apart.
namespace corridor {
namespace {

/// Returns the pose of a joint in the middle of an interval, up to rounding.
Transform poseInLane(const ChainTables& tables, const ChainScratch& scratch, std::uint32_t joint,
                     int set, int lane) {
  if (joint == ChainTables::kNone) return {};
  const ChainScratch::JointLanes& lanes =
      scratch.joints[static_cast<std::size_t>(set) * tables.joints.size() + joint];
  Transform X;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) X.m(r, c) = double{lanes.m[3 * r + c][lane]};
    X.t[r] = double{lanes.t[r][lane]};
  }
  return X;
}

/// The hulls of one pair in the frame of a's joint (the world's, if it has none).
class PairOfHulls {
 public:
  PairOfHulls(const ChainTables& tables, const ChainScratch& scratch, std::uint32_t number)
      : tables_(tables),
        scratch_(scratch),
        number_(number),
        pair_(tables.scene.pairs[number]),
        b_(tables.scene.links[pair_.b]) {
    if (pair_.isWorld) {
      const ChainScene::Obstacle& obstacle = tables.scene.obstacles[pair_.a];
      hullA_ = obstacle.hull;
      X_JA_ = obstacle.X_WB;
    } else {
      const ChainScene::Link& link = tables.scene.links[pair_.a];
      hullA_ = link.hull;
      X_JA_ = link.X_JB;
      jointA_ = link.joint;
    }
  }

  /// Decides whether the hulls are proved apart in all open intervals. @param test may be null.
  HullsAnswer decide(TouchTest* test) {
    if (!pair_.testsHulls || !hullA_ || tables_.links[pair_.b].points.empty())
      return HullsAnswer::open;
    for (int set = 0; set < scratch_.edge.sets; ++set)
      if (const HullsAnswer answer = decideIn(set, test); answer != HullsAnswer::apart)
        return answer;
    return HullsAnswer::apart;
  }

 private:
  /// How many directions are tried in one set.
  static constexpr int kDirections = 3;

  HullsAnswer decideIn(int set, TouchTest* test) {
    unsigned open = scratch_.open[number_][static_cast<std::size_t>(set)];
    if (open == 0) return HullsAnswer::apart;
    int lane = middleOf(open);  // of all: a contact is most likely there
    // The direction that separated the hulls in the intervals before, or else a guess.
    if (direction_.isZero(0)) direction_ = guess(set, lane);
    if (!direction_.isZero(0)) open &= ~separated(set);
    for (int i = 0; open && i < kDirections; ++i) {
      if (!(open >> lane & 1)) lane = middleOf(open);
      const Transform X_AB = rigidInverse(poseInLane(tables_, scratch_, jointA_, set, lane)) *
                             poseInLane(tables_, scratch_, b_.joint, set, lane) * b_.X_JB;
      const gjk::Answer found = search(X_AB);
      if (!(found.lower > radii() + near())) {
        const bool meet = found.overlap || found.upper <= radii();
        return meet && test && test->touches(pair_.number, timeOf(scratch_.edge, set, lane))
                   ? HullsAnswer::touching
                   : HullsAnswer::open;
      }
      direction_ = found.direction;
      open &= ~separated(set);
      if (open >> lane & 1) return HullsAnswer::open;  // only shorter intervals may help
    }
    return open == 0 ? HullsAnswer::apart : HullsAnswer::open;
  }

  double near() const { return double{scratch_.edge.margins[number_]}; }
  double radii() const { return hullA_->ball + b_.hull->ball; }
  /// Searches for a direction that separates the hulls, up to a tenth of their distance.
  gjk::Answer search(const Transform& X_AB) {
    const PosedSet a(*hullA_, X_JA_), b(*b_.hull, X_AB);
    const double close = radii() + near();
    const auto enough = [&](double upper, double lower) {
      return upper <= close || upper - lower <= 0.1 * (lower - close);
    };
    gjk::Search<double> search(a, b, a.reach() + b.reach() + X_AB.t.norm() + X_JA_.t.norm());
    const gjk::Answer found =
        search.run(gjk::startOf<double>(&cache_), enough,
                   [](const Vec3&, double, std::uint32_t, std::uint32_t) { return false; });
    gjk::keep(search.simplex, &cache_);
    return found;
  }

  /// Returns the direction from a to the middle of b's ball, from the nearest point of an obstacle.
  Vec3 guess(int set, int lane) const {
    const Vec3 center = poseInLane(tables_, scratch_, b_.joint, set, lane) * (b_.X_JB * b_.center);
    Vec3 direction;
    if (pair_.isWorld) {
      const ChainScene::Obstacle& o = tables_.scene.obstacles[pair_.a];
      Vec3 local = o.X_WO.m.transpose() * (center - o.X_WO.t);
      if (o.isCylinder) {
        const double rho = std::hypot(local[0], local[1]);
        local.head<2>() *= std::max(rho - o.half[0], 0.0) / std::max(rho, 1e-20);
        local[2] -= std::clamp(local[2], -o.half[2], o.half[2]);
      } else {
        local -= local.cwiseMax(-o.half).cwiseMin(o.half);
      }
      direction = o.X_WO.m * local;
    } else {
      const ChainScene::Link& a = tables_.scene.links[pair_.a];
      const Transform X_WJ = poseInLane(tables_, scratch_, jointA_, set, lane);
      direction = X_WJ.m.transpose() * (center - X_WJ * (a.X_JB * a.center));
    }
    const double length = direction.norm();
    return length > 0 ? Vec3(direction / length) : Vec3(Vec3::Zero());
  }
  static int middleOf(unsigned lanes) {
    for (int skip = std::popcount(lanes) / 2; skip > 0; --skip) lanes &= lanes - 1;
    return std::countr_zero(lanes);
  }

  /// The lanes in which the hulls are separated by `direction_`.
  unsigned separated(int set) const {
    std::array<float, 3> n;
    Vec3 exact;
    for (int k = 0; k < 3; ++k) {
      n[static_cast<std::size_t>(k)] = static_cast<float>(direction_[k]);
      exact[k] = double{n[static_cast<std::size_t>(k)]};
    }
    const double length = exact.norm();
    if (!(length <= 1 + 0x1p-22)) return 0;
    const PosedSet a(*hullA_, X_JA_);
    // `PosedSet` requires a unit vector; its projections are linear in the vector's length.
    const double highest = length * a.highest(exact / length) + 2 * a.error();
    return separateHull(tables_, scratch_, number_, set, n,
                        upToFloat(highest + 8 * kFloatUnit * std::abs(highest)));
  }

  const ChainTables& tables_;
  const ChainScratch& scratch_;
  std::uint32_t number_;
  const ChainScene::Pair& pair_;
  const ChainScene::Link& b_;
  const ConvexSet* hullA_ = nullptr;
  Transform X_JA_;
  std::uint32_t jointA_ = ChainScene::kNone;
  Vec3 direction_ = Vec3::Zero();  // of the last success, in the frame of a's joint; or 0
  ConvexCache cache_;
};

}  // namespace

HullsAnswer decideHulls(const ChainTables& tables, const ChainScratch& scratch, std::uint32_t pair,
                        TouchTest* test) {
  return PairOfHulls(tables, scratch, pair).decide(test);
}

}  // namespace corridor
