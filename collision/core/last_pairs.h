#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace corridor {

/// The pair of triangles that decided the last query of two trees: they touched, or were the
/// closest. If bodies move in small steps, the same pair often decides the next query.
///
/// The pair is a guess: queries test it as any other pair, and no result relies on it. Distance
/// queries always start from it. Interference queries test it first only while it is `trusted`: two
/// searches in a row have found it, and it has not failed `kTrust` times in a row since. Thus
/// unrelated queries waste no test on it.
class LastPair {
 public:
  std::uint32_t a = 0xffffffff, b = 0xffffffff;  ///< numbers of triangles in the two trees

  /// True if both numbers are in range. They may not be: a larger tree, since destroyed, may have
  /// had the same address.
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

/// A hash table of fixed size: the last pairs of recently queried pairs of trees.
class LastPairs {
 public:
  /// Returns the last pair of two trees, in this order, given by their addresses. It may belong to
  /// other trees, which had the same addresses before or have the same key by chance.
  LastPair& of(const void* a, const void* b) {
    // Constants of Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014.
    const auto address = [](const void* p) {
      return static_cast<std::uint64_t>(reinterpret_cast<std::uintptr_t>(p));
    };
    const std::uint64_t key = (address(a) * 0xbf58476d1ce4e5b9U + address(b)) * 0x94d049bb133111ebU;
    Slot& slot = slots_[key >> (64 - kBits)];
    if (slot.key != key) slot = {key, {}};
    return slot.pair;
  }

 private:
  static constexpr int kBits = 6;
  struct Slot {
    std::uint64_t key = 0;
    LastPair pair;
  };
  std::array<Slot, 1 << kBits> slots_;
};

}  // namespace corridor
