#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace corridor {

/// The pair of triangles, by their numbers in two trees, that last answered a query of these trees:
/// touched, or were the closest. Of bodies that move in small steps it often answers the next one.
///
/// A guess, to be tested as any other pair: nothing that is told rests on it. It is worth a test
/// once a search has found it twice running, and until it has failed as often as `kTrust`: where
/// queries have nothing to do with each other, none is spent on it.
class LastPair {
 public:
  std::uint32_t a = 0xffffffff, b = 0xffffffff;

  /// Are these numbers of triangles? Not those of a tree that was larger, and has gone.
  bool isIn(std::size_t countA, std::size_t countB) const { return a < countA && b < countB; }
  bool trusted() const { return trust_ > 0; }
  /// What the test of the guess has told,
  void tested(bool answers) { trust_ = answers ? kTrust : trust_ - 1; }
  /// or, without it, a search.
  void found(std::uint32_t s, std::uint32_t t) {
    if (s == a && t == b) trust_ = kTrust;
    a = s;
    b = t;
  }

 private:
  static constexpr int kTrust = 3;
  int trust_ = 0;
};

/// The last pairs of some pairs of trees, those asked about last: a table of fixed size.
class LastPairs {
 public:
  /// Of two trees, in this order, by their addresses. May be another's: of trees that were there
  /// before, or that have the same key by chance.
  LastPair& of(const void* a, const void* b) {
    // Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014: its constants.
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
