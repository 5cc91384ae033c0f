#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace corridor::view {

/// A buffer with all arrays of a page: little-endian, each array starting at a multiple of 4 bytes.
class PageBuffers {
 public:
  /// Where an array is in the buffer, and the type of its elements, for a typed array of
  /// JavaScript.
  struct View {
    const char* type;    ///< "f4" (float), "u4", "u2" or "u1" (unsigned integers of 4, 2, 1 bytes)
    std::size_t offset;  ///< bytes
    std::size_t count;
  };

  template <class Number>
  View add(const std::vector<Number>& numbers) {
    static_assert(sizeof(Number) == 1 || sizeof(Number) == 2 || sizeof(Number) == 4);
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    const View view{typeOf(Number()), bytes_.size(), numbers.size()};
    bytes_.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
    return view;
  }
  /// Adds indices below `limit`, in two bytes each if `limit` allows that, else in four. @pre All
  /// indices are below `limit`.
  View addIndices(const std::vector<std::uint32_t>& indices, std::size_t limit) {
    if (limit > 0x10000) return add(indices);
    return add(std::vector<std::uint16_t>(indices.begin(), indices.end()));
  }
  const std::string& bytes() const { return bytes_; }

 private:
  static const char* typeOf(float) { return "f4"; }
  static const char* typeOf(std::uint32_t) { return "u4"; }
  static const char* typeOf(std::uint16_t) { return "u2"; }
  static const char* typeOf(std::uint8_t) { return "u1"; }

  std::string bytes_;
};

}  // namespace corridor::view
