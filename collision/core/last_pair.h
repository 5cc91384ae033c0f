#pragma once

#include <cstddef>
#include <cstdint>

namespace corridor {

/// The pair of triangles that decided the most recent query of two trees: the two triangles
/// touched, or were the closest. If bodies move in small steps, the same pair often decides the
/// next query.
///
/// The pair is only a guess: queries test it like any other pair, so no result relies on it.
/// Distance queries on 4-wide trees always start from it. Distance and tolerance queries on binary
/// trees, and all queries with a convex part, ignore it. All other queries test the pair first, but
/// only while `trusted()` is true. Trust begins when two searches in a row find the same pair.
/// Trust ends when the test of the guess fails `kTrust` times in a row. It ends even if searches
/// have replaced the pair by other pairs in between. Therefore unrelated queries waste at most a
/// few tests. A new `LastPair` holds no pair.
class LastPair {
 public:
  /// The triangles of both trees, as indices in the leaf order of each tree.
  std::uint32_t a = 0xffffffff, b = 0xffffffff;

  /// Returns whether both indices are in range for trees of `countA` and `countB` triangles. They
  /// are out of range if no pair was recorded, and may be out of range if the previous query was
  /// about other trees.
  bool isIn(std::size_t countA, std::size_t countB) const { return a < countA && b < countB; }
  bool trusted() const { return trust_ > 0; }
  /// Records the result of testing the guess: whether this pair decided the query.
  void recordTest(bool answers) { trust_ = answers ? kTrust : trust_ - 1; }
  /// Records the pair that a search has found.
  void recordFound(std::uint32_t s, std::uint32_t t) {
    if (s == a && t == b) trust_ = kTrust;
    a = s;
    b = t;
  }

 private:
  static constexpr int kTrust = 3;
  int trust_ = 0;
};

}  // namespace corridor
