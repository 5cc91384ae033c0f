#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "planner/checker/checker.h"
#include "planner/robot/tangent_step.h"

namespace corridor {

/// Why edges of a path miss a clearance target.
enum class WhyOffTarget {
  unknown,
  detour,    ///< edges that keep all targets were found, but make the path longer than allowed
  notFound,  ///< no search found edges that keep all targets
  time       ///< the time ran out before all searches were made
};
/// Returns "", "detour", "not found" or "time".
const char* nameOf(WhyOffTarget why);

/// The distances that the pairs of a scene should keep along a path from a start to a goal. The
/// target of a pair is the smallest of three lengths: `clearance`, 70 % of the pair's distance at
/// the start, and 70 % of its distance at the goal. The reason for the last two: a path can't keep
/// a larger distance than its ends have. A target is never below the pair's padding. (With 70 %, it
/// takes little work to prove that the edges at the ends keep the targets.)
///
/// Edges are proved to keep the targets with a reserve of a fiftieth (`areKept`), so that curves
/// near them keep the targets, too.
///
/// The *share* of a pair in a state is the pair's distance divided by the pair's target, at most 1.
class ClearanceTargets {
 public:
  /// @param checker must have the margin 0, and must outlive the object.
  /// @param clearance metres, above 0. @pre start and goal are free and finite.
  ClearanceTargets(const Checker& checker, double clearance, const Configuration& start,
                   const Configuration& goal);

  double clearance() const { return clearance_; }
  /// Returns the smallest target, metres.
  double least() const;
  /// Returns the smallest distance of a pair at the start and at the goal, metres; infinite if no
  /// pair is closer than `clearance()` there.
  double smallestAtEnds() const { return smallestAtEnds_; }
  /// Returns the targets, metres, one for each pair of `Scene::pairs()`.
  const PairMargins& all() const { return targets_; }

  /// Returns whether every pair is proved to keep its target, and the reserve, on the whole edge.
  bool areKept(const Configuration& from, const Configuration& to) const {
    return checker_.certifyEdge(from, to, {.margins = &reserved_}).verdict == MotionVerdict::free;
  }
  /// The reserve, as a fraction of the targets.
  static constexpr double kReserve = 0.02;
  /// Returns the targets, multiplied by a factor, but not below the paddings. A target that is no
  /// more than the padding stays as it is.
  PairMargins scaled(double factor) const;
  /// The pair with the smallest share on an edge, and the time at which it has this share.
  struct Worst {
    double share = 1;     ///< 1: no pair is below its target at a sample
    double t = 0;         ///< time on the edge, in [0, 1]
    double distance = 0;  ///< metres; 0 if no pair is below its target
    std::size_t pair = 0;
  };
  /// Returns nullopt if every pair is proved to keep its target on the whole edge. Otherwise
  /// returns the pair with the smallest share at samples of the edge. (Pairs whose hulls keep the
  /// target are not sampled.)
  /// If no sampled distance is below its target, returns the time at which the proof failed, with a
  /// share just below 1: the target is missed by little, or only because of the tube. If the proof
  /// gives no time either, the share is 1.
  /// @param enough a share; the samples end once one is below it.
  std::optional<Worst> missedOn(const Configuration& from, const Configuration& to,
                                double enough = 0) const;
  /// Returns the pair with the smallest distance at samples of an edge, whatever the targets are.
  /// Returns nullopt if no pair is closer than `clearance()` at a sample. In this result, `share`
  /// is the distance divided by `clearance()`.
  std::optional<Worst> closestOn(const Configuration& from, const Configuration& to) const;
  /// The same, at samples near the time t.
  std::optional<Worst> closestNear(const Configuration& from, const Configuration& to,
                                   double t) const;

  /// Returns a configuration near q at which pairs that are closer than 1.5 times their targets are
  /// farther apart: to first order, they reach 1.5 times their targets, or less if other pairs are
  /// in the way. Up to three Newton steps lead there. Each step is the shortest one, in the space's
  /// distance, that has this effect. A step is cut at a length of 0.5, and at joint limits. Returns
  /// nullopt if no step helps, or if none is needed.
  std::optional<Configuration> movedApart(const Configuration& q) const;

 private:
  void sampleAt(const Configuration& from, const Configuration& to, double t,
                const PairMargins& lengths, const std::vector<std::uint32_t>* pairs,
                Worst& worst) const;
  Worst worstOn(const Configuration& from, const Configuration& to, const PairMargins& lengths,
                const std::vector<std::uint32_t>& pairs, double enough = 0,
                std::optional<double> first = {}) const;

  const Checker& checker_;
  double clearance_, smallestAtEnds_;
  PairMargins targets_, reserved_, clearances_, near_;
  TangentStep weights_;
};

}  // namespace corridor
