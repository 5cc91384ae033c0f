#pragma once

#include <cstddef>
#include <cstdint>

namespace corridor {

/// The pair of triangles that decided the last query of two trees: they touched, or were the
/// closest. If bodies move in small steps, the same pair often decides the next query.
///
/// The pair is a guess: queries test it as any other pair, and no result relies on it. Distance
/// queries on 4-wide trees always start from it; those on binary trees ignore it, as do all queries
/// with a convex part. Other queries test it first only while it is `trusted`: two searches in a
/// row have found it, and it has not failed `kTrust` times in a row since. Thus unrelated queries
/// waste no test on it. A new object knows no pair.
class LastPair {
 public:
  std::uint32_t a = 0xffffffff, b = 0xffffffff;  ///< numbers in the two trees, in leaf order

  /// Returns whether both numbers are in range. They need not be: the last query may have been of
  /// other trees.
  bool isIn(std::size_t countA, std::size_t countB) const { return a < countA && b < countB; }
  bool trusted() const { return trust_ > 0; }
  /// Records the test of the guess: whether this pair decided the query.
  void tested(bool answers) { trust_ = answers ? kTrust : trust_ - 1; }
  /// Records the pair that a search has found.
  void found(std::uint32_t s, std::uint32_t t) {
    if (s == a && t == b) trust_ = kTrust;
    a = s;
    b = t;
  }

 private:
  static constexpr int kTrust = 3;
  int trust_ = 0;
};

}  // namespace corridor
