// Eight floats in SIMD lanes, and vectors of them, for every SIMD target: foreach_target.h includes
// this file once per target.

// clang-format off
#if defined(CORRIDOR_FLOAT_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_FLOAT_LANES_INL_H_
#undef CORRIDOR_FLOAT_LANES_INL_H_
#else
#define CORRIDOR_FLOAT_LANES_INL_H_
#endif
// clang-format on

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, 8>;
constexpr std::size_t kParts = 8 / hn::MaxLanes(Tag());
constexpr unsigned kAll = 0xff;

/// Eight floats. Products are rounded before they are added (no fused multiply-add), so results are
/// the same on every target.
struct F8 {
  hn::Vec<Tag> part[kParts];

  static F8 of(float x) {
    F8 r;
    for (auto& p : r.part) p = hn::Set(Tag(), x);
    return r;
  }
  static F8 load(const float* x) {
    F8 r;
    for (std::size_t i = 0; i < kParts; ++i) r.part[i] = hn::Load(Tag(), x + i * 8 / kParts);
    return r;
  }
  static F8 loadAny(const float* x) {  // not aligned
    F8 r;
    for (std::size_t i = 0; i < kParts; ++i) r.part[i] = hn::LoadU(Tag(), x + i * 8 / kParts);
    return r;
  }
  void store(float* x) const {
    for (std::size_t i = 0; i < kParts; ++i) hn::Store(part[i], Tag(), x + i * 8 / kParts);
  }
};

template <class Op>
HWY_INLINE F8 each(const F8& a, const F8& b, const Op& op) {
  F8 r;
  for (std::size_t i = 0; i < kParts; ++i) r.part[i] = op(a.part[i], b.part[i]);
  return r;
}
using V = hn::Vec<Tag>;
HWY_INLINE F8 operator+(const F8& a, const F8& b) {
  return each(a, b, [](V x, V y) HWY_ATTR { return hn::Add(x, y); });
}
HWY_INLINE F8 operator-(const F8& a, const F8& b) {
  return each(a, b, [](V x, V y) HWY_ATTR { return hn::Sub(x, y); });
}
HWY_INLINE F8 operator*(const F8& a, const F8& b) {
  return each(a, b, [](V x, V y) HWY_ATTR { return hn::Mul(x, y); });
}
HWY_INLINE F8 operator/(const F8& a, const F8& b) {
  return each(a, b, [](V x, V y) HWY_ATTR { return hn::Div(x, y); });
}
HWY_INLINE F8 operator*(float a, const F8& b) {
  return F8::of(a) * b;
}
HWY_INLINE F8 operator+(const F8& a, float b) {
  return a + F8::of(b);
}
HWY_INLINE F8 operator-(const F8& a, float b) {
  return a - F8::of(b);
}
HWY_INLINE F8 larger(const F8& a, const F8& b) {
  return each(a, b, [](V x, V y) HWY_ATTR { return hn::Max(x, y); });
}
HWY_INLINE F8 smaller(const F8& a, const F8& b) {
  return each(a, b, [](V x, V y) HWY_ATTR { return hn::Min(x, y); });
}
HWY_INLINE F8 root(const F8& a) {
  return each(a, a, [](V x, V) HWY_ATTR { return hn::Sqrt(x); });
}
HWY_INLINE F8 magnitude(const F8& a) {
  return each(a, a, [](V x, V) HWY_ATTR { return hn::Abs(x); });
}
/// The lanes, as bits, in which a > b; comparisons with NaN are false.
HWY_INLINE unsigned isGreater(const F8& a, const F8& b) {
  unsigned bits = 0;
  for (std::size_t i = 0; i < kParts; ++i) {
    std::uint8_t byte[8] = {};
    hn::StoreMaskBits(Tag(), hn::Gt(a.part[i], b.part[i]), byte);
    bits |= static_cast<unsigned>(byte[0]) << (i * 8 / kParts);
  }
  return bits;
}
HWY_INLINE float least(const F8& a) {
  float x = hn::GetLane(hn::MinOfLanes(Tag(), a.part[0]));
  for (std::size_t i = 1; i < kParts; ++i)
    x = std::min(x, hn::GetLane(hn::MinOfLanes(Tag(), a.part[i])));
  return x;
}
HWY_INLINE float largest(const F8& a) {
  float x = hn::GetLane(hn::MaxOfLanes(Tag(), a.part[0]));
  for (std::size_t i = 1; i < kParts; ++i)
    x = std::max(x, hn::GetLane(hn::MaxOfLanes(Tag(), a.part[i])));
  return x;
}

struct V3 {
  F8 x, y, z;

  static V3 load(const float v[3][8]) { return {F8::load(v[0]), F8::load(v[1]), F8::load(v[2])}; }
  void store(float v[3][8]) const { x.store(v[0]), y.store(v[1]), z.store(v[2]); }
};
HWY_INLINE V3 operator+(const V3& a, const V3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE V3 operator-(const V3& a, const V3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE V3 operator*(const F8& s, const V3& a) {
  return {s * a.x, s * a.y, s * a.z};
}
HWY_INLINE F8 dot(const V3& a, const V3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE V3 cross(const V3& a, const V3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // CORRIDOR_FLOAT_LANES_INL_H_
