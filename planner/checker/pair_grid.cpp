#include "planner/checker/pair_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "collision/core/circle.h"

/// Rounding. Values are computed in cells; for all that `covers` accepts, they are below 2^25 cells
/// on the way, and each has fewer than 16 roundings of at most 2^-28 cells. The turn round a circle
/// has a rounding of its own, below 2^-25 cells. All together this is below 2^-23. A line is
/// therefore searched `kSlop` cells around. So a real value is in a cell that was looked up, or,
/// at the end of an axis that is no turn, at most 2·kSlop beyond the last cell. With a tube of
/// `kWidestTube` this is within `kReach`; kReach − kWidestTube − 2·kSlop, a quarter of `kReach`, is
/// left for the rounding of the cells' own values (`kLeastRange`, pair_grids.cpp).
namespace corridor {
namespace {

constexpr double kSlop = 0x1p-9;
static_assert(2 * kSlop + PairGrid::kWidestTube <= PairGrid::kReach);
constexpr double kMostCells = 0x1p24;

std::int64_t floorOf(double x) {
  return static_cast<std::int64_t>(std::floor(x));
}

}  // namespace

PairGrid::PairGrid(std::vector<Axis> axes, double clearance, Marks marks)
    : axes_(std::move(axes)), clearance_(clearance), marks_(std::move(marks)) {}

PairGrid::Line PairGrid::lineOf(const Axis& axis, const Configuration& from,
                                const Configuration& to) {
  const auto i = static_cast<Eigen::Index>(axis.number);
  double along = to[i] - from[i];
  if (axis.isCircle) {
    const CircleTurn turn = circleTurn(from[i], to[i]);
    along = turn.ambiguous() ? HUGE_VAL : turn.angle;  // `covers` refuses infinity
  }
  return {(from[i] - axis.lower) / axis.cell, along / axis.cell};
}

bool PairGrid::covers(const Configuration& from, const Configuration& to) const {
  // x is the number that changes more, in cells, so that a column has few cells.
  Line x = lineOf(axes_[0], from, to), y;
  bool xIsTurn = axes_[0].isTurn, yIsTurn = false, isSwapped = false;
  if (axes_.size() == 2) {
    y = lineOf(axes_[1], from, to);
    yIsTurn = axes_[1].isTurn;
    if (std::abs(y.along) > std::abs(x.along)) {
      isSwapped = true;
      std::swap(x, y);
      std::swap(xIsTurn, yIsTurn);
    }
  }
  for (const double value : {x.at, x.along, y.at, y.along})
    if (!(std::abs(value) < kMostCells)) return false;  // true for NaN
  // Returns the cell in the grid.
  const auto inGrid = [](std::int64_t cell, bool isTurn) {
    return isTurn ? cell & (kSide - 1) : std::clamp<std::int64_t>(cell, 0, kSide - 1);
  };
  for (const auto& [line, isTurn] : {std::pair(x, xIsTurn), std::pair(y, yIsTurn)})
    if (!isTurn && (std::min(line.at, line.at + line.along) < -kSlop ||
                    std::max(line.at, line.at + line.along) > kSide + kSlop))
      return false;
  const double low = std::min(x.at, x.at + x.along), high = std::max(x.at, x.at + x.along);
  if (high - low > 4 * kSide) return false;  // several turns: rare, and long to look up
  for (std::int64_t column = floorOf(low - kSlop), last = floorOf(high + kSlop); column <= last;
       ++column) {
    double begin = 0, end = 1;  // when the edge is in the column
    if (x.along != 0) {
      const double one = (static_cast<double>(column) - 2 * kSlop - x.at) / x.along,
                   other = (static_cast<double>(column + 1) + 2 * kSlop - x.at) / x.along;
      begin = std::clamp(std::min(one, other), 0.0, 1.0);
      end = std::clamp(std::max(one, other), 0.0, 1.0);
    }
    const double atBegin = y.at + begin * y.along, atEnd = y.at + end * y.along;
    const std::int64_t c = inGrid(column, xIsTurn),
                       lastRow = floorOf(std::max(atBegin, atEnd) + kSlop);
    for (std::int64_t row = floorOf(std::min(atBegin, atEnd) - kSlop); row <= lastRow; ++row) {
      const std::int64_t r = inGrid(row, yIsTurn);
      if (!(isSwapped ? isMarked(marks_, r, c) : isMarked(marks_, c, r))) return false;
    }
  }
  return true;
}

}  // namespace corridor
