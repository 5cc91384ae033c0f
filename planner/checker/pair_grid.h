#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "planner/robot/configuration_space.h"

namespace corridor {

/// A grid over the one or two numbers of a Configuration that move two bodies against each other. A
/// cell is marked if the two keep a clearance wherever the numbers are in the cell. Then an edge is
/// proved for this pair by looking up the cells that it passes.
class PairGrid {
 public:
  /// Cells along each number.
  static constexpr std::int64_t kSide = 128;
  /// How far the proof of a cell reaches beyond each of its sides, in cells. It covers tubes and
  /// rounding.
  static constexpr double kReach = 0x1p-6;
  /// The widest tube that is covered, in cells. The rest of `kReach` is for rounding.
  static constexpr double kWidestTube = 0x1p-7;

  /// The values of one number: kSide cells from `lower` on.
  struct Axis {
    std::size_t number = 0;      ///< in a Configuration
    double lower = 0, cell = 1;  ///< of the first cell; rad or m
    bool isCircle =
        false;            ///< whether the number is a circle coordinate, which goes the shorter way
    bool isTurn = false;  ///< whether the cells are a full turn, and go on beyond it
  };
  /// Marked cells: kSide bits for each of kSide rows (one row for one axis). The first axis is
  /// along the rows.
  using Marks = std::vector<std::uint64_t>;

  /// @pre one or two axes; `marks` has `wordsFor(axes.size())` words.
  PairGrid(std::vector<Axis> axes, double clearance, Marks marks);

  static std::size_t wordsFor(std::size_t axes) { return axes == 1 ? kWords : kWords * kSide; }
  static bool isMarked(const Marks& marks, std::int64_t column, std::int64_t row) {
    return marks[static_cast<std::size_t>(kWords * row + column / 64)] >> (column % 64) & 1;
  }
  static void mark(Marks& marks, std::int64_t column, std::int64_t row) {
    marks[static_cast<std::size_t>(kWords * row + column / 64)] |= std::uint64_t{1}
                                                                   << (column % 64);
  }

  /// The clearance of marked cells, metres: the two bodies are farther apart.
  double clearance() const { return clearance_; }
  const std::vector<Axis>& axes() const { return axes_; }
  const Marks& marks() const { return marks_; }

  /// Returns whether all cells are marked that an edge passes (collision/PROMISES.md defines the
  /// edge). If so, the two bodies keep the clearance on the whole edge, and also on every curve
  /// whose numbers differ from the edge's by at most `kWidestTube` cells. The answer for an edge
  /// that is not finite, or that goes half a turn round a circle, is false.
  bool covers(const Configuration& from, const Configuration& to) const;

 private:
  static constexpr std::int64_t kWords = kSide / 64;  // of a row
  /// The values of an edge, in cells: at + t·along.
  struct Line {
    double at = 0, along = 0;
  };
  static Line lineOf(const Axis& axis, const Configuration& from, const Configuration& to);

  std::vector<Axis> axes_;
  double clearance_ = 0;
  Marks marks_;
};

}  // namespace corridor
