#pragma once

#include <cstddef>
#include <vector>

namespace corridor {

/// The limits at the nodes of a grid of path parameters s, in terms of x = ṡ² and u = s̈:
///   x ≤ xMax  and  |a_k·u + b_k·x| ≤ 1 for each band k.
/// The nodes of an interval have limits of their own, since q″ may jump at a node: the node where
/// two pieces meet is in the grid twice, with an interval of length 0 between.
struct LimitGrid {
  std::size_t bands = 0;     ///< per node
  std::vector<double> s;     ///< ascending; equal only where pieces meet
  std::vector<double> xMax;  ///< for each node; may be infinite if a band bounds x
  std::vector<double> a, b;  ///< bands values for each node
  std::size_t size() const { return s.size(); }
};

/// The result of a reachability analysis.
struct Profile {
  std::vector<double> x;  ///< ṡ² at each node
  std::vector<double> u;  ///< s̈ in each interval, one less; 0 in intervals of length 0
  enum class Failure { none, start, end, stuck } failure = Failure::none;
  /// `start` and `end`: the interval of x at the node from which a profile exists; empty if lower >
  /// upper. `end`: the largest x that the limits at the node allow.
  double lower = 0, upper = 0;
  std::size_t node = 0;  ///< where no profile exists; `stuck`: where x can only be 0
};

/// Returns the profile with the largest x at every node (Pham and Pham 2018, algorithm 1).
/// @param start, end x at the ends; infinity: any.
Profile fastestProfile(const LimitGrid& grid, double start, double end);

}  // namespace corridor
