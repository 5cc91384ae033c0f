#include "planner/trajectory/path_runs.h"

#include <algorithm>
#include <cmath>

namespace corridor {
namespace {

/// A tangent counts as 0 if its length is below this fraction of the bound of |dq/dτ| on its piece.
/// The fraction exceeds the rounding of computed coefficients, some tens of 2^-52.
constexpr double kNoTangent = 1e-13;

struct End {
  Configuration first, second;  // dq/dτ and d²q/dτ²
  double size = 0;              // |first|; 0 if negligible
};

End endOf(const PathView& view, std::size_t piece, double tau, double bound) {
  End end;
  view.derivatives(piece, tau, end.first, end.second);
  end.size = end.first.stableNorm();
  if (end.size <= kNoTangent * bound) end.size = 0;
  return end;
}

bool isFree(const End& end, double bound) {
  return end.size == 0 && end.second.stableNorm() > 1e-6 * bound;
}

}  // namespace

std::vector<PathRun> runsOf(const PathView& view, double cornerAngle, bool smooth) {
  std::vector<PathRun> runs;
  End before;  // the end of the piece before
  double boundOfBefore = 0;
  for (std::size_t piece = 0; piece < view.path().size(); ++piece) {
    const double bound = view.speedBound(piece);
    if (!(bound > 0)) continue;
    const End start = endOf(view, piece, 0, bound);
    bool joined = !runs.empty() && before.size > 0 && start.size > 0;
    double length = bound;  // so that |dq/ds| ≤ 1
    if (joined) {
      // The norm of the difference of two unit vectors is the angle between them, up to a term of
      // third order.
      const Configuration jump = start.first / start.size - before.first / before.size;
      joined = jump.stableNorm() <= cornerAngle;
      const double last = runs.back().parts.back().length;
      length = last * (start.size / before.size);
      joined = joined && std::isfinite(length) && length > 0;
      if (joined && smooth) {
        // If d²q/ds² jumps by this tolerance, q̈ jumps by 10^-6 of |dq/ds|·ṡ²/length.
        const Configuration bend = start.second / (length * length) - before.second / (last * last);
        joined = bend.stableNorm() <= 1e-6 * (before.size / last) / std::max(length, last);
      }
      if (!joined) length = bound;
    }
    if (!joined) {
      if (!runs.empty()) runs.back().restsAtEnd = isFree(before, boundOfBefore);
      runs.emplace_back();
      runs.back().restsAtStart = isFree(start, bound);
    }
    runs.back().parts.push_back({piece, length});
    before = endOf(view, piece, 1, bound);
    boundOfBefore = bound;
  }
  if (!runs.empty()) runs.back().restsAtEnd = isFree(before, boundOfBefore);
  return runs;
}

std::vector<double> beginsOf(const PathRun& run) {
  std::vector<double> begins{0};
  for (const PathRun::Part& part : run.parts) begins.push_back(begins.back() + part.length);
  return begins;
}

}  // namespace corridor
