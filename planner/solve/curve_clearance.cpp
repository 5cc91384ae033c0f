#include "planner/solve/curve_clearance.h"

#include <algorithm>

#include "planner/solve/prove_clearance.h"

namespace corridor {
namespace {

constexpr double kFractions[] = {1, 0.8, 0.6, 0.4, 0.2, 0.1, 0.05, 0};
/// Pieces keep this part of the path's clearance, at least.
constexpr double kFloor = 0.98;
/// Each further clearance that is tried for a curve is this fraction of the one before: at first,
/// and after kFine tries.
constexpr double kNextOfCurve = 0.97, kLaterOfCurve = 0.85;
constexpr int kFine = 3;
/// A curve with less than this part of the path's clearance loses clearance.
constexpr double kLost = 0.94;
constexpr int kTriesOfCurve = 20;

}  // namespace

CurveClearance::CurveClearance(const Checker& checker, const ClearanceTargets& targets, double most)
    : checker_(checker), targets_(targets), most_(most) {
  for (const double fraction : kFractions) {
    ofEdges_.push_back(targets.scaled((1 + ClearanceTargets::kReserve) * fraction));
    std::vector<double> lengths =
        targets.scaled((1 + ClearanceTargets::kReserve / 2) * fraction).all();
    for (double& length : lengths) length = std::max(length, kFloor * most);
    ofPieces_.emplace_back(std::move(lengths));
  }
}

double CurveClearance::fractionKept(const Configuration& from, const Configuration& to) const {
  for (std::size_t i = 0; i < ofEdges_.size(); ++i)
    if (checker_.certifyEdge(from, to, {.margins = &ofEdges_[i]}).verdict == MotionVerdict::free)
      return kFractions[i];
  return 0;
}

bool CurveClearance::isKept(const CurvePiece& piece, double fraction) const {
  const auto known = std::ranges::find(kFractions, fraction);
  const PairMargins& margins = known == std::end(kFractions)
                                   ? ofPieces_.back()
                                   : ofPieces_[static_cast<std::size_t>(known - kFractions)];
  return checker_.certifyCurve(piece, false, &margins).verdict == MotionVerdict::free;
}

bool CurveClearance::keepsTargets(const CurvePiece& piece) const {
  return checker_.certifyCurve(piece, false, &targets_.all()).verdict == MotionVerdict::free;
}

CurveProof CurveClearance::prove(const Curve& curve, const std::vector<char>& kept) const {
  const std::vector<CurvePiece>& pieces = curve.pieces;
  const auto onTarget = static_cast<std::size_t>(std::ranges::count(kept, 1));
  double time = 0;
  for (std::size_t k = 0; k < pieces.size(); ++k)
    time += kept[k] ? curve.knots[k + 1] - curve.knots[k] : 0;
  CurveProof proof;
  proof.shareOnTarget =
      onTarget == pieces.size() ? 1 : time / (curve.knots.back() - curve.knots.front());
  const double least = onTarget == pieces.size() ? targets_.least() : 0;
  double tried = std::max(most_, least);
  // All pieces before this one are proved to keep the clearance that is tried.
  std::size_t piece = 0;
  for (int n = 0; n < kTriesOfCurve && tried > least; ++n) {
    const PairMargins margins(std::vector(targets_.all().size(), tried));
    while (piece < pieces.size() &&
           ((kept[piece] && tried <= targets_.least()) ||
            checker_.certifyCurve(pieces[piece], false, &margins).verdict == MotionVerdict::free))
      ++piece;
    if (piece == pieces.size()) break;
    tried *= n < kFine ? kNextOfCurve : kLaterOfCurve;
  }
  const double proved = piece == pieces.size() ? tried : least;
  proof.isLess = proved < kLost * most_;
  proof.proved = roundedDownTo3Digits(proved);
  return proof;
}

}  // namespace corridor
