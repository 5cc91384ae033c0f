#pragma once

#include <array>
#include <compare>
#include <cstdint>

/// Signed integers of few bits, for grids of few bits: all that touches by construction (boxes, CAD
/// parts on a grid, under quarter turns). Several times faster than what Boost has, which looks at
/// the length of every number. Results that need more bits wrap (of `Int53`, round).
namespace corridor::exact {

__extension__ using SignedPair = __int128;
__extension__ using UnsignedPair = unsigned __int128;

/// Integers times a power of two that all of an expression's coordinates share: doubles are exact
/// below 2^53 of it.
class Int53 {
 public:
  Int53() = default;
  explicit Int53(double value) : value_(value) {}

  bool is_zero() const { return value_ == 0; }  // NOLINT: Boost's name
  int sign() const { return value_ > 0 ? 1 : value_ < 0 ? -1 : 0; }
  friend Int53 operator*(Int53 a, Int53 b) { return Int53(a.value_ * b.value_); }
  friend Int53 operator+(Int53 a, Int53 b) { return Int53(a.value_ + b.value_); }
  friend Int53 operator-(Int53 a, Int53 b) { return Int53(a.value_ - b.value_); }
  friend auto operator<=>(const Int53&, const Int53&) = default;  // NOLINT: no null pointer here

 private:
  double value_ = 0;
};

class Int128 {
 public:
  Int128() = default;
  explicit Int128(std::int64_t value) : value_(value) {}

  bool is_zero() const { return value_ == 0; }  // NOLINT: Boost's name
  int sign() const { return value_ > 0 ? 1 : value_ < 0 ? -1 : 0; }
  Int128& operator*=(const Int128& other) {
    value_ *= other.value_;
    return *this;
  }
  Int128& operator+=(const Int128& other) {
    value_ += other.value_;
    return *this;
  }
  Int128& operator<<=(unsigned bits) {  // of a negative number, too: a product in C++20
    value_ <<= bits;
    return *this;
  }
  friend Int128 operator*(Int128 a, const Int128& b) { return a *= b; }
  friend Int128 operator+(Int128 a, const Int128& b) { return a += b; }
  friend Int128 operator-(Int128 a, const Int128& b) {
    a.value_ -= b.value_;
    return a;
  }
  friend auto operator<=>(const Int128&, const Int128&) = default;  // NOLINT: no null pointer here

 private:
  SignedPair value_ = 0;
};

/// In two's complement, the least limb first.
class Int256 {
 public:
  Int256() = default;
  explicit Int256(std::int64_t value) {
    limbs_.fill(value < 0 ? ~0ULL : 0);
    limbs_[0] = static_cast<std::uint64_t>(value);
  }

  bool is_zero() const {  // NOLINT: Boost's name
    return (limbs_[0] | limbs_[1] | limbs_[2] | limbs_[3]) == 0;
  }
  int sign() const { return top() < 0 ? -1 : is_zero() ? 0 : 1; }

  Int256& operator*=(const Int256& other) { return *this = *this * other; }
  Int256& operator+=(const Int256& other) { return *this = *this + other; }
  Int256& operator<<=(unsigned bits) {
    const unsigned whole = bits / 64, part = bits % 64;
    for (unsigned i = 4; i-- > 0;) {
      std::uint64_t limb = i >= whole ? limbs_[i - whole] << part : 0;
      if (part && i > whole) limb |= limbs_[i - whole - 1] >> (64 - part);
      limbs_[i] = limb;
    }
    return *this;
  }
  friend Int256 operator+(const Int256& a, const Int256& b) {
    Int256 sum;
    UnsignedPair carry = 0;
    for (int i = 0; i < 4; ++i) {
      carry += static_cast<UnsignedPair>(a.limbs_[i]) + b.limbs_[i];
      sum.limbs_[i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    return sum;
  }
  friend Int256 operator-(const Int256& a, const Int256& b) {
    Int256 difference;
    UnsignedPair carry = 1;  // a + ~b + 1
    for (int i = 0; i < 4; ++i) {
      carry += static_cast<UnsignedPair>(a.limbs_[i]) + ~b.limbs_[i];
      difference.limbs_[i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    return difference;
  }
  friend Int256 operator*(const Int256& a, const Int256& b) {
    Int256 product(0);
    for (int i = 0; i < 4; ++i) {
      UnsignedPair carry = 0;
      for (int j = 0; i + j < 4; ++j) {
        carry += static_cast<UnsignedPair>(a.limbs_[i]) * b.limbs_[j] + product.limbs_[i + j];
        product.limbs_[i + j] = static_cast<std::uint64_t>(carry);
        carry >>= 64;
      }
    }
    return product;
  }
  friend bool operator==(const Int256&, const Int256&) = default;
  friend std::strong_ordering operator<=>(const Int256& a, const Int256& b) {
    if (a.top() != b.top()) return a.top() <=> b.top();
    for (int i = 2; i >= 0; --i)
      if (a.limbs_[i] != b.limbs_[i]) return a.limbs_[i] <=> b.limbs_[i];
    return std::strong_ordering::equal;
  }

 private:
  std::int64_t top() const { return static_cast<std::int64_t>(limbs_[3]); }
  std::array<std::uint64_t, 4> limbs_{};
};

}  // namespace corridor::exact
