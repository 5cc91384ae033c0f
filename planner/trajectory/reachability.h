#pragma once

#include <cstddef>
#include <vector>

namespace corridor {

/// The limits at the nodes of a grid of path parameters s, in terms of x = ṡ² and u = s̈:
///   x ≤ xMax  and  |a_k·u + b_k·x| ≤ 1 for each band k.
/// q″ may jump where two pieces meet. So a point where two pieces meet has two nodes, one with the
/// limits of each piece, and the interval between these two nodes has length 0.
struct LimitGrid {
  std::size_t bands = 0;     ///< per node
  std::vector<double> s;     ///< ascending; equal only where pieces meet
  std::vector<double> xMax;  ///< for each node; may be infinite if a band bounds x
  std::vector<double> a, b;  ///< `bands` values for each node
  std::size_t size() const { return s.size(); }
};

/// The result of a reachability analysis.
struct Profile {
  std::vector<double> x;  ///< ṡ² at each node
  std::vector<double> u;  ///< s̈ in each interval between two nodes; 0 in intervals of length 0
  enum class Failure { none, start, end, stuck } failure = Failure::none;
  /// For a failure, an interval of x. `start`: the x at node 0 from which a profile exists. `end`,
  /// if `node` is the last node: from 0 to the largest x that the limits allow there. `end` at
  /// another node, and `stuck`: the x at node + 1 from which a profile to the last node exists.
  double lower = 0, upper = 0;
  /// The node of the failure; `stuck`: x can only be 0 from this node to the next.
  std::size_t node = 0;
};

/// Returns the profile with the largest x at every node (Pham and Pham 2018, algorithm 1), or a
/// failure.
/// @param start, end x at the first and at the last node; infinity: any x.
Profile fastestProfile(const LimitGrid& grid, double start, double end);

}  // namespace corridor
