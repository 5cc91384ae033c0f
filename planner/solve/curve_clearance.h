#pragma once

#include <vector>

#include "planner/robot/curve.h"
#include "planner/solve/clearance_targets.h"

namespace corridor {

/// How far the curve of a trajectory stays away from contact.
struct CurveProof {
  /// Every tested pair is proved to keep more than this distance, metres, on the whole curve, tube
  /// and errors of the pieces included. Rounded down to three significant digits; 0: none is
  /// proved.
  double proved = 0;
  /// A lower bound of the fraction of the time in which every pair is proved to keep its target.
  double shareOnTarget = 0;
  bool isLess =
      false;  ///< whether `proved` is less than that of the path, by more than a few percent
};

/// The clearance targets of a path, for curves that replace parts of it. An edge keeps a *fraction*
/// of the targets; a curve must keep the smallest fraction of the edges that it replaces.
class CurveClearance {
 public:
  /// Both must outlive the object.
  /// @param most the proved clearance of the path, metres; the first that is tried for a curve
  CurveClearance(const Checker& checker, const ClearanceTargets& targets, double most);

  /// Returns a fraction of the targets that every pair is proved to keep on the whole edge, with
  /// the reserve of `ClearanceTargets::areKept`: 1, or one of a few smaller ones, or 0.
  double fractionKept(const Configuration& from, const Configuration& to) const;
  /// Returns whether every pair is proved to keep a fraction of its target and half of the reserve
  /// on a piece, and nearly the clearance of the path. @param fraction as `fractionKept` returns it
  bool isKept(const CurvePiece& piece, double fraction) const;

  /// Proves whether every pair keeps its target on a piece, without a reserve.
  bool keepsTargets(const CurvePiece& piece) const;
  /// Proves a clearance of a whole curve. @param kept for each piece, whether it keeps the targets.
  CurveProof prove(const Curve& curve, const std::vector<char>& kept) const;

 private:
  const Checker& checker_;
  const ClearanceTargets& targets_;
  double most_;
  std::vector<PairMargins> ofEdges_, ofPieces_;  // by the index of the fraction
};

}  // namespace corridor
