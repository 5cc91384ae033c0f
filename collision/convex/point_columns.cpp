#include "collision/convex/point_columns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collision/convex/point_columns.cpp"
#include "hwy/foreach_target.h"
// Highway requires this include after foreach_target.h.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The columns of a PointColumns: x, then y, then z.
struct Columns {
  const double* x;
  std::size_t stride;
};

/// Products are rounded before they are added (no fused multiply-add), on every target.
template <class D>
hn::Vec<D> dot(D d, const Columns& c, std::size_t i, const double* m) {
  const auto term = [&](std::size_t k) {
    return hn::Mul(hn::LoadU(d, c.x + k * c.stride + i), hn::Set(d, m[k]));
  };
  return hn::Add(hn::Add(term(0), term(1)), term(2));
}

/// The columns are filled up to a multiple of eight numbers, so vectors have no more.
using Tag = hn::CappedTag<double, 8>;

std::uint32_t farthestPoint(const double* columns, std::size_t stride, const double* m) {
  const Tag d;
  const Columns c{columns, stride};
  auto highest = dot(d, c, 0, m);
  auto number = hn::Iota(d, 0), best = number;
  const auto step = hn::Set(d, static_cast<double>(hn::Lanes(d)));
  for (std::size_t i = hn::Lanes(d); i < stride; i += hn::Lanes(d)) {
    number = hn::Add(number, step);
    const auto along = dot(d, c, i, m);
    const auto higher = hn::Gt(along, highest);
    highest = hn::IfThenElse(higher, along, highest);
    best = hn::IfThenElse(higher, number, best);
  }
  double heights[8], numbers[8];
  hn::StoreU(highest, d, heights);
  hn::StoreU(best, d, numbers);
  std::size_t lane = 0;
  for (std::size_t k = 1; k < hn::Lanes(d); ++k)
    if (heights[k] > heights[lane] || (heights[k] == heights[lane] && numbers[k] < numbers[lane]))
      lane = k;
  return static_cast<std::uint32_t>(numbers[lane]);
}

double leastAround(const double* columns, std::size_t stride, const double* m, const double* v,
                   double shift) {
  const Tag d;
  const Columns c{columns, stride};
  const auto at = [&](std::size_t i) {
    return hn::Sub(dot(d, c, i, m), hn::Abs(hn::Add(dot(d, c, i, v), hn::Set(d, shift))));
  };
  auto least = at(0);
  for (std::size_t i = hn::Lanes(d); i < stride; i += hn::Lanes(d)) least = hn::Min(least, at(i));
  return hn::GetLane(hn::MinOfLanes(d, least));
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corridor {

HWY_EXPORT(farthestPoint);
HWY_EXPORT(leastAround);

PointColumns::PointColumns(std::vector<Vec3> points)
    : points_(std::move(points)), stride_((points_.size() + 7) / 8 * 8) {
  columns_.resize(3 * stride_);
  for (std::size_t i = 0; i < stride_; ++i) {
    const Vec3& p = points_[std::min(i, points_.size() - 1)];
    for (std::size_t k = 0; k < 3; ++k) columns_[k * stride_ + i] = p[static_cast<int>(k)];
  }
  for (const Vec3& p : points_) {
    center_ += p / static_cast<double>(points_.size());
    reachSquared_ = std::max(reachSquared_, p.squaredNorm());
  }
}

std::uint32_t PointColumns::farthest(const Vec3& m) const {
  const std::uint32_t found =
      HWY_DYNAMIC_DISPATCH(farthestPoint)(columns_.data(), stride_, m.data());
  // After an overflow to NaN, it may be a copy of the last point.
  return std::min(found, static_cast<std::uint32_t>(points_.size() - 1));
}

double PointColumns::leastAround(const Vec3& m, const Vec3& v, double shift) const {
  if (!m.allFinite() || !v.allFinite() || !std::isfinite(shift))
    return std::numeric_limits<double>::quiet_NaN();
  return HWY_DYNAMIC_DISPATCH(leastAround)(columns_.data(), stride_, m.data(), v.data(), shift);
}

}  // namespace corridor
#endif
