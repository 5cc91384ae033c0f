#pragma once

#include <cstdint>

namespace corridor {

constexpr std::uint64_t kNoWorkLimit = ~std::uint64_t{0};

/// What queries cost, in the terms of T = N_v·C_v + N_p·C_p (Gottschalk, Lin, Manocha 1996, eq. 1):
/// counts, one set a thread.
struct Counters {
  std::uint64_t boxTests = 0;       ///< N_v: pairs of bounding volumes tested
  std::uint64_t triangleTests = 0;  ///< N_p: pairs of triangles tested
  std::uint64_t exactTests =
      0;                     ///< of these, decided by exact arithmetic because the filter could not
  std::uint64_t poses = 0;   ///< poses computed along motions
  std::uint64_t splits = 0;  ///< windows of time that were halved
  std::uint64_t edges = 0;   ///< motion queries
  std::uint64_t states = 0;  ///< static queries
  std::uint64_t undecided = 0;  ///< motion queries that ended `undecided`

  /// Box and triangle tests: what limits of work are about.
  std::uint64_t work() const { return boxTests + triangleTests; }

  Counters& operator+=(const Counters& other);
};

inline Counters& Counters::operator+=(const Counters& other) {
  boxTests += other.boxTests;
  triangleTests += other.triangleTests;
  exactTests += other.exactTests;
  poses += other.poses;
  splits += other.splits;
  edges += other.edges;
  states += other.states;
  undecided += other.undecided;
  return *this;
}

}  // namespace corridor
