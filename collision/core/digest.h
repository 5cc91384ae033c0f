#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "collision/core/transform.h"

namespace corridor {

using Bytes = std::span<const std::byte>;

/// Whether the bytes of a type are its value: not of pointers and views. (A struct must have no
/// padding.) The copy constructor of Eigen's vectors is not trivial, but a `Vec3` is three doubles.
template <class T>
inline constexpr bool kIsBytes = (std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> &&
                                  !std::ranges::view<T>) ||
                                 std::is_same_v<T, Vec3>;

/// Returns the bytes of a list, of a value, or of a text.
template <class T>
Bytes bytesOf(const std::vector<T>& list) {
  static_assert(kIsBytes<T>);
  return std::as_bytes(std::span(list));
}
template <class T>
Bytes bytesOf(const T& value) {
  static_assert(kIsBytes<T>);
  return std::as_bytes(std::span(&value, 1));
}
inline Bytes bytesOf(std::string_view text) {
  return std::as_bytes(std::span(text));
}
inline Bytes bytesOf(const std::string& text) {
  return std::as_bytes(std::span(text));
}

/// A digest of 128 bits: XXH3 (Y. Collet, xxHash 0.8). It is fast, but not made against an
/// attacker. Two inputs that were not chosen for this purpose have the same digest with a
/// probability of about 2^-128.
struct Digest {
  std::uint64_t high = 0, low = 0;
  bool operator==(const Digest&) const = default;
};

/// Computes the digest of a list of byte strings. The length of each is part of the digest.
class Digester {
 public:
  Digester();
  ~Digester();

  Digester& add(Bytes bytes);
  /// Returns the digest of what was added so far.
  Digest result() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace corridor
