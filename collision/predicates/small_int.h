#pragma once

#include <compare>
#include <cstdint>

/// Signed integers whose width grows with the degree of an expression. Coordinates have 64 bits,
/// their products 128, and products of these with coordinates 192. 192 bits hold every orientation
/// determinant of points whose grid coordinates have 61 bits. Shapes that touch by construction
/// (boxes, CAD models under rotations by 90°) have such coordinates. These types are ten times
/// faster than integers of one large width. Results that need more bits wrap, except those of
/// `Int53`, which are rounded.
namespace corridor::exact {

__extension__ using SignedWide = __int128;
__extension__ using UnsignedWide = unsigned __int128;

/// Integers stored as doubles. A computation may store all of its integers times one common power
/// of two. Results are exact as long as the integers are below 2^53 in magnitude.
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

/// Values of degree three, stored as `high_`·2^64 + `low_`.
class Int192 {
 public:
  Int192() = default;
  Int192(SignedWide high, std::uint64_t low) : high_(high), low_(low) {}

  bool is_zero() const { return high_ == 0 && low_ == 0; }  // NOLINT: Boost's name
  int sign() const { return high_ < 0 ? -1 : is_zero() ? 0 : 1; }
  friend Int192 operator+(const Int192& a, const Int192& b) {
    const std::uint64_t low = a.low_ + b.low_;
    return {a.high_ + b.high_ + (low < a.low_), low};
  }

 private:
  SignedWide high_ = 0;
  std::uint64_t low_ = 0;
};

class Int64;

/// Values of degree two.
class Int128 {
 public:
  Int128() = default;
  explicit Int128(SignedWide value) : value_(value) {}

  bool is_zero() const { return value_ == 0; }  // NOLINT: Boost's name
  int sign() const { return value_ > 0 ? 1 : value_ < 0 ? -1 : 0; }
  friend Int128 operator+(Int128 a, Int128 b) { return Int128(a.value_ + b.value_); }
  friend Int128 operator-(Int128 a, Int128 b) { return Int128(a.value_ - b.value_); }
  friend Int192 operator*(Int128 a, Int64 b);
  friend Int192 operator*(Int64 a, Int128 b);

 private:
  SignedWide value_ = 0;
};

/// Values of degree one.
class Int64 {
 public:
  Int64() = default;
  explicit Int64(std::int64_t value) : value_(value) {}

  bool is_zero() const { return value_ == 0; }  // NOLINT: Boost's name
  std::int64_t value() const { return value_; }
  /// @pre the product fits into 64 bits.
  Int64& operator*=(Int64 other) {
    value_ *= other.value_;
    return *this;
  }
  Int64& operator+=(Int64 other) {
    value_ += other.value_;
    return *this;
  }
  Int64& operator<<=(unsigned bits) {  // C++20 defines this shift for negative values, too
    value_ <<= bits;
    return *this;
  }
  friend Int64 operator-(Int64 a, Int64 b) { return Int64(a.value_ - b.value_); }
  friend Int128 operator*(Int64 a, Int64 b) {
    return Int128(static_cast<SignedWide>(a.value_) * b.value_);
  }
  friend auto operator<=>(const Int64&, const Int64&) = default;  // NOLINT: no null pointer here

 private:
  std::int64_t value_ = 0;
};

inline Int192 operator*(Int128 a, Int64 b) {
  // a = h·2^64 + l with l ≥ 0; l·b has 127 bits and a sign.
  const auto l = static_cast<std::uint64_t>(a.value_);
  auto low = static_cast<UnsignedWide>(l) * static_cast<std::uint64_t>(b.value());
  if (b.value() < 0) low -= static_cast<UnsignedWide>(l) << 64;
  const auto carry = static_cast<SignedWide>(low) >> 64;
  return {(a.value_ >> 64) * b.value() + carry, static_cast<std::uint64_t>(low)};
}
inline Int192 operator*(Int64 a, Int128 b) {
  return b * a;
}

}  // namespace corridor::exact
