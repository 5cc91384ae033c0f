#pragma once

#include <cstdint>

namespace corridor {

constexpr std::uint64_t kNoWorkLimit = ~std::uint64_t{0};

/// Counts of the work of queries. N_v and N_p are those of the cost model T = N_v·C_v + N_p·C_p
/// (Gottschalk, Lin, Manocha 1996, eq. 1). Each thread has its own counters.
struct Counters {
  std::uint64_t boxTests = 0;        ///< N_v: pairs of bounding volumes tested
  std::uint64_t primitiveTests = 0;  ///< N_p: tested pairs of triangles or convex parts
  /// The number of `primitiveTests` that double could not decide. These tests are repeated in exact
  /// arithmetic, or in double-double for convex parts.
  std::uint64_t exactTests = 0;
  std::uint64_t poses = 0;   ///< poses computed along motions
  std::uint64_t splits = 0;  ///< time intervals halved
  // Only scenes and `certifyMotionBy` count the following three; queries of two shapes do not.
  std::uint64_t edges = 0;      ///< motion queries in which something moves
  std::uint64_t states = 0;     ///< static queries, and motion queries in which nothing moves
  std::uint64_t undecided = 0;  ///< motion queries that ended `undecided`

  /// Counts a tested pair of triangles or convex parts.
  void addTest(bool exact) {
    ++primitiveTests;
    exactTests += exact;
  }
  /// Returns the sum that work limits are compared with: box tests and triangle tests.
  std::uint64_t work() const { return boxTests + primitiveTests; }

  Counters& operator+=(const Counters& other);
};

inline Counters& Counters::operator+=(const Counters& other) {
  boxTests += other.boxTests;
  primitiveTests += other.primitiveTests;
  exactTests += other.exactTests;
  poses += other.poses;
  splits += other.splits;
  edges += other.edges;
  states += other.states;
  undecided += other.undecided;
  return *this;
}

}  // namespace corridor
