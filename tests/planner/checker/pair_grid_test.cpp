// Looking up an edge in a grid: every cell that the edge passes counts.
#include "planner/checker/pair_grid.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "collision/core/circle.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using Axis = PairGrid::Axis;
using Random = std::mt19937_64;

constexpr double kPi = std::numbers::pi, kSide = PairGrid::kSide;

Axis limited(std::size_t number, double lower, double upper) {
  return {number, lower, (upper - lower) / kSide, false, false};
}
Axis turn(std::size_t number, bool isCircle) {
  return {number, -kPi, 2 * kPi / kSide, isCircle, true};
}

/// A grid of which all cells are marked but these (column, row).
PairGrid allBut(const std::vector<Axis>& axes,
                const std::vector<std::array<std::int64_t, 2>>& cells) {
  PairGrid::Marks marks(PairGrid::wordsFor(axes.size()), ~std::uint64_t{0});
  PairGrid::Marks holes(marks.size());
  for (const auto& [column, row] : cells) PairGrid::mark(holes, column, row);
  for (std::size_t i = 0; i < marks.size(); ++i) marks[i] &= ~holes[i];
  return {axes, 0.001, marks};
}

Configuration state(double a, double b = 0) {
  Configuration q(2);
  q << a, b;
  return q;
}

/// The cell of a value; outside of limits, one that is never marked.
std::int64_t cellOf(const Axis& axis, long double value) {
  long double at = (value - axis.lower) / axis.cell;
  if (axis.isTurn) at -= kSide * std::floor(at / kSide);
  return static_cast<std::int64_t>(std::floor(at));
}

struct EdgeOfGrid {
  Configuration from, to;

  long double at(const Axis& axis, long double t) const {
    const auto i = static_cast<Eigen::Index>(axis.number);
    const long double along = axis.isCircle ? circleTurn(from[i], to[i]).angle
                                            : static_cast<long double>(to[i]) - from[i];
    return from[i] + t * along;
  }
};

/// Whether all cells are marked in which the edge is at 4,000 times.
bool areMarkedAtSamples(const PairGrid& grid, const EdgeOfGrid& edge) {
  for (int i = 0; i <= 4000; ++i) {
    std::array<std::int64_t, 2> cell{};
    for (std::size_t k = 0; k < grid.axes().size(); ++k) {
      cell[k] = cellOf(grid.axes()[k], edge.at(grid.axes()[k], i / 4000.0L));
      if (cell[k] < 0 || cell[k] >= PairGrid::kSide) return false;
    }
    if (!PairGrid::isMarked(grid.marks(), cell[0], cell[1])) return false;
  }
  return true;
}

TEST(PairGrid, NeverCoversAnEdgeThatPassesACellWithoutMark) {
  Random random(test::testSeed(91));
  const std::vector<std::vector<Axis>> all = {{limited(0, -2, 3), limited(1, 0.5, 1)},
                                              {turn(1, true), limited(0, -2, 3)},
                                              {turn(0, false), turn(1, true)},
                                              {limited(1, -2, 2)},
                                              {turn(0, true)}};
  int covered = 0, passing = 0;
  for (int n = 0; n < test::casesOf(3000, 100'000); ++n) {
    const std::vector<Axis>& axes = all[static_cast<std::size_t>(n) % all.size()];
    std::vector<std::array<std::int64_t, 2>> holes;
    std::uniform_int_distribution<std::int64_t> any(0, PairGrid::kSide - 1);
    for (int i = 0; i < 1 + n % 40; ++i)
      holes.push_back({any(random), axes.size() == 2 ? any(random) : 0});
    const PairGrid grid = allBut(axes, holes);
    const double part = std::array{0.0, 0.01, 0.3, 1.0}[random() % 4];
    std::uniform_real_distribution<double> value(-3.2, 3.2);
    EdgeOfGrid edge{state(value(random), value(random)), state(value(random), value(random))};
    edge.to = edge.from + part * (edge.to - edge.from);
    if (n % 5 == 0) {  // along an axis
      const auto i = static_cast<Eigen::Index>(random() % 2);
      edge.to[i] = edge.from[i];
    }
    const bool covers = grid.covers(edge.from, edge.to);
    const bool marked = areMarkedAtSamples(grid, edge);
    EXPECT_TRUE(marked || !covers) << "case " << n;
    covered += covers;
    passing += marked;
  }
  EXPECT_GT(covered, passing * 9 / 10) << "edges that pass marked cells only are mostly covered";
  EXPECT_LT(covered, passing + 1);
}

TEST(PairGrid, NeverCoversHalfATurn) {
  const PairGrid grid = allBut({turn(0, true)}, {});
  constexpr double pi = 3.141592653589793;
  EXPECT_TRUE(grid.covers(state(0, 0), state(3.1, 0)));
  EXPECT_FALSE(grid.covers(state(0, 0), state(pi, 0))) << "the way is not known";
  EXPECT_FALSE(grid.covers(state(1, 0), state(1 - pi, 0)));
  EXPECT_FALSE(grid.covers(state(0, 0), state(NAN, 0)));
}

/// Edges past the corner of a cell without mark, at distances down to the rounding of doubles.
TEST(PairGrid, SeesTheCornerOfACell) {
  Random random(test::testSeed(92));
  const std::vector<Axis> axes = {limited(0, -2, 3), limited(1, 0.5, 1.7)};
  int near = 0, entered = 0;
  for (int n = 0; n < test::casesOf(20'000, 1'000'000); ++n) {
    const auto c = static_cast<std::int64_t>(10 + random() % 100),
               r = static_cast<std::int64_t>(10 + random() % 100);
    const PairGrid grid = allBut(axes, {{c, r}});
    // A line past the lower left corner, across the diagonal.
    const double angle = std::uniform_real_distribution(0.1, 1.4)(random);
    const Configuration across = state(std::sin(angle), -std::cos(angle));
    const auto edgeAt = [&](double deep) {
      const Configuration corner =
          state(static_cast<double>(c) + deep, static_cast<double>(r) + deep);
      EdgeOfGrid edge{corner - 7.3 * across, corner + 5.1 * across};
      for (Configuration* const end : {&edge.from, &edge.to})
        for (const Axis& axis : axes) {
          double& value = (*end)[static_cast<Eigen::Index>(axis.number)];
          value = axis.lower + value * axis.cell;
        }
      return edge;
    };
    const EdgeOfGrid close =
        edgeAt(std::pow(10.0, -std::uniform_real_distribution(1.0, 16.0)(random)));
    // The edge enters the cell if it is above the corner where it reaches the column. The rounding
    // of long double is below 1e-18.
    const auto border = [&](const Axis& axis, std::int64_t cell) {
      return axis.lower + static_cast<long double>(axis.cell) * cell;
    };
    const long double x0 = close.from[0], y0 = close.from[1];
    const long double above = y0 - border(axes[1], r) +
                              (border(axes[0], c) - x0) * (close.to[1] - y0) / (close.to[0] - x0);
    if (above > 1e-17L) {
      EXPECT_FALSE(grid.covers(close.from, close.to)) << above;
      EXPECT_FALSE(grid.covers(close.to, close.from)) << above;
      ++entered;
    }
    const EdgeOfGrid past = edgeAt(-0.01);
    near += grid.covers(past.from, past.to);
  }
  EXPECT_GT(entered, 100);
  EXPECT_GT(near, 0) << "edges that stay a hundredth of a cell away";
}

TEST(PairGrid, EndsAtLimitsAndGoesOnBeyondATurn) {
  const PairGrid grid = allBut({limited(0, -2, 3)}, {});
  EXPECT_TRUE(grid.covers(state(-2), state(3)));
  EXPECT_FALSE(grid.covers(state(-2), state(3.001)));
  EXPECT_FALSE(grid.covers(state(-2.001), state(0)));
  const PairGrid round = allBut({turn(0, false)}, {{0, 0}});  // not just above −π
  EXPECT_TRUE(round.covers(state(-3), state(3)));
  EXPECT_FALSE(round.covers(state(3), state(3.3)));
  EXPECT_FALSE(round.covers(state(-3 - 4 * kPi), state(-3.3 - 4 * kPi)));
  EXPECT_TRUE(round.covers(state(3.3), state(3 + 2 * kPi)));
  EXPECT_FALSE(round.covers(state(0), state(8 * kPi))) << "several turns";
  const PairGrid circle = allBut({turn(0, true)}, {{0, 0}});
  EXPECT_FALSE(circle.covers(state(3), state(-3))) << "the shorter way crosses ±π";
  EXPECT_TRUE(circle.covers(state(-1.5), state(1.5)));
}

TEST(PairGrid, CoversNothingThatIsNoNumber) {
  const PairGrid grid = allBut({limited(0, -2, 3), turn(1, false)}, {});
  EXPECT_TRUE(grid.covers(state(0, 0), state(1, 1)));
  for (const double wrong : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300}) {
    EXPECT_FALSE(grid.covers(state(0, 0), state(1, wrong)));
    EXPECT_FALSE(grid.covers(state(wrong, 0), state(1, 1)));
  }
}

}  // namespace
}  // namespace corridor
