#pragma once

#include <cstddef>
#include <vector>

namespace corridor {

/// The limits at the nodes of a grid of path parameters s, in terms of x = ṡ² and u = s̈:
///   x ≤ xMax  and  |a_k·u + b_k·x| ≤ 1 for each band k.
/// q″ may jump where two pieces meet. So a node where two pieces meet is in the grid twice, once
/// with the limits of each piece, and an interval of length 0 is between the two.
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
  std::vector<double> u;  ///< s̈ in each interval, one fewer than nodes; 0 if its length is 0
  enum class Failure { none, start, end, stuck } failure = Failure::none;
  /// `start`: the interval of x at node 0 from which a profile exists. `end` at the last node: 0,
  /// and the largest x that the limits there allow. `end` at another node, and `stuck`: the
  /// interval of x at the next node from which the rest of a profile exists.
  double lower = 0, upper = 0;
  std::size_t node = 0;  ///< where no profile exists; `stuck`: where x can only be 0
};

/// Returns the profile with the largest x at every node (Pham and Pham 2018, algorithm 1).
/// @param start, end x at the ends; infinity: any.
Profile fastestProfile(const LimitGrid& grid, double start, double end);

}  // namespace corridor
