// Primitive references for building a 4-wide OBB tree. Included once per SIMD target by
// foreach_target.h.

// clang-format off
#if defined(CORRIDOR_PRIMITIVE_REFERENCES_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_PRIMITIVE_REFERENCES_INL_H_
#undef CORRIDOR_PRIMITIVE_REFERENCES_INL_H_
#else
#define CORRIDOR_PRIMITIVE_REFERENCES_INL_H_
#endif
// clang-format on

#include <algorithm>
#include <bit>
#include <cstdint>
#include <memory>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// One record per triangle or convex part, in the tree's frame and unit. The records are stored as
/// columns of floats, and splitting a cluster reorders them. Second moments are about the centroid
/// of the record's own triangle or part, so that sums over few and small triangles far from the
/// origin don't cancel (NUMERICS.md, "Moments").
///
/// Sums are over eight lanes in one fixed order. Every instruction set and number of threads
/// therefore builds the same tree. The sums only choose the tree's shape; no proof depends on them.
class PrimitiveReferences {
 public:
  enum Column { kX, kY, kZ, kWeight, kXX, kXY, kXZ, kYY, kYZ, kZZ, kTriangle, kColumns };

  explicit PrimitiveReferences(std::size_t count)
      // The additional 48 floats keep the stride from being a multiple of 1024 (a page of floats)
      // where the count is such a multiple. Columns at such a stride would compete for the same
      // cache sets.
      : stride_((count + 15) / 16 * 16 + 48),
        data_(std::make_unique_for_overwrite<float[]>(kColumns * stride_)) {}

  float* column(int k) { return data_.get() + k * stride_; }
  std::uint32_t triangle(std::size_t i) const {
    return std::bit_cast<std::uint32_t>(data_[kTriangle * stride_ + i]);
  }

  /// Computes the mean of the centroids of the records [first, first + count), weighted, or
  /// unweighted if their weights are 0 or tiny. Also computes the sum of their second moments about
  /// the mean: xx, xy, xz, yy, yz, zz.
  void moments(std::size_t first, std::size_t count, float (&mean)[3], double (&second)[6]) const {
    double s[4];
    const auto none = hn::Set(d_, 1.0F);
    bool flat = false;
    const auto weighted = [&](const auto& load, V* term) {
      const V w = flat ? load.only(none) : load(kWeight);
      term[0] = w;
      for (int k = 0; k < 3; ++k) term[1 + k] = hn::Mul(w, load(kX + k));
    };
    sum<4>(first, count, s, weighted);
    flat = !(s[0] > 0x1p-100);
    if (flat) sum<4>(first, count, s, weighted);
    for (int k = 0; k < 3; ++k) mean[k] = static_cast<float>(s[1 + k] / s[0]);
    const V x0 = hn::Set(d_, mean[0]), y0 = hn::Set(d_, mean[1]), z0 = hn::Set(d_, mean[2]);
    sum<6>(first, count, second, [&](const auto& load, V* term) {
      const V w = flat ? load.only(none) : load(kWeight);
      const V x = hn::Sub(load(kX), x0), y = hn::Sub(load(kY), y0), z = hn::Sub(load(kZ), z0);
      const V wx = hn::Mul(w, x), wy = hn::Mul(w, y), wz = hn::Mul(w, z);
      term[0] = hn::Add(hn::Mul(wx, x), load(kXX));
      term[1] = hn::Add(hn::Mul(wx, y), load(kXY));
      term[2] = hn::Add(hn::Mul(wx, z), load(kXZ));
      term[3] = hn::Add(hn::Mul(wy, y), load(kYY));
      term[4] = hn::Add(hn::Mul(wy, z), load(kYZ));
      term[5] = hn::Add(hn::Mul(wz, z), load(kZZ));
    });
  }

  /// Reorders the records [first, first + count) so that the records below the plane, normal·x <
  /// offset, come first. Both groups keep their order. Returns the number of records below. `spare`
  /// is temporary memory for the records above the plane, and grows as needed.
  std::size_t partition(std::size_t first, std::size_t count, const float (&normal)[3],
                        float offset, PrimitiveReferences& spare) {
    if (spare.stride_ < count + kLanes) spare = PrimitiveReferences(count + kLanes);
    const V nx = hn::Set(d_, normal[0]), ny = hn::Set(d_, normal[1]), nz = hn::Set(d_, normal[2]),
            c = hn::Set(d_, offset);
    std::size_t below = 0, above = 0;
    for (std::size_t i = 0; i < count; i += kLanes) {
      const Loader load(*this, first + i, count - i);
      V v[kColumns];
      for (int k = 0; k < kColumns; ++k) v[k] = load(k);
      const V x = hn::Add(hn::Add(hn::Mul(nx, v[kX]), hn::Mul(ny, v[kY])), hn::Mul(nz, v[kZ]));
      const auto all = hn::FirstN(d_, std::min(count - i, kLanes));
      const auto low = hn::And(hn::Lt(x, c), all), high = hn::AndNot(low, all);
      const std::size_t lows = hn::CountTrue(d_, low), highs = hn::CountTrue(d_, high);
      alignas(64) std::int32_t lanes[2 * kLanes];
      const auto toLow = compressed(low, lanes);
      if (count <= kLanes) {  // one step suffices, as for most clusters
        compressed(high, lanes + lows);
        const auto both = hn::SetTableIndices(d_, lanes);
        for (int k = 0; k < kColumns; ++k)
          store(hn::TableLookupLanes(v[k], both), column(k) + first, count);
        return lows;
      }
      const auto toHigh = compressed(high, lanes);
      for (int k = 0; k < kColumns; ++k) {
        // Lanes beyond `lows` overwrite only records that have been read. If the last step is
        // partial, these lanes are not stored.
        store(hn::TableLookupLanes(v[k], toLow), column(k) + first + below,
              count - i >= kLanes ? kLanes : lows);
        hn::StoreU(hn::TableLookupLanes(v[k], toHigh), d_, spare.column(k) + above);
      }
      below += lows;
      above += highs;
    }
    for (int k = 0; k < kColumns; ++k)
      for (std::size_t i = 0; i < above; i += kLanes)
        store(hn::LoadU(d_, spare.column(k) + i), column(k) + first + below + i, above - i);
    return below;
  }

 private:
  using D = hn::CappedTag<float, 8>;
  using V = hn::Vec<D>;
  using Indices = decltype(hn::SetTableIndices(D(), static_cast<const std::int32_t*>(nullptr)));
  static constexpr D d_{};
  static constexpr std::size_t kLanes = hn::MaxLanes(D());
  // So many records are summed in float. The sums of such blocks are added in double.
  static constexpr std::size_t kBlock = 4096;
  static constexpr bool kMasked = HWY_TARGET <= HWY_AVX2;  // the target has masked loads and stores

  /// Loads lanes of records from `at` on. `rest` is the number of records that are left. Lanes
  /// beyond them become 0 and are not read, because that memory may belong to another thread.
  struct Loader {
    HWY_INLINE Loader(const PrimitiveReferences& records, std::size_t at, std::size_t rest)
        : from(records.data_.get() + at), stride(records.stride_), left(rest) {}
    const float* from;
    std::size_t stride, left;
    HWY_INLINE V operator()(int column) const {
      const float* p = from + column * stride;
      if (left >= kLanes) return hn::LoadU(d_, p);
      if constexpr (kMasked) return hn::MaskedLoad(hn::FirstN(d_, left), d_, p);
      alignas(64) float lanes[kLanes] = {};
      std::copy_n(p, left, lanes);
      return hn::Load(d_, lanes);
    }
    HWY_INLINE V only(V v) const {
      return hn::IfThenElseZero(hn::FirstN(d_, std::min(left, kLanes)), v);
    }
  };

  HWY_INLINE static void store(V v, float* to, std::size_t count) {
    if (count >= kLanes) {
      hn::StoreU(v, d_, to);
    } else if constexpr (kMasked) {
      hn::BlendedStore(v, hn::FirstN(d_, count), d_, to);
    } else {
      alignas(64) float lanes[kLanes];
      hn::Store(v, d_, lanes);
      std::copy_n(lanes, count, to);
    }
  }

  /// Returns the indices that bring the lanes of a mask to the front, and writes them to `lanes`.
  template <class Mask>
  HWY_INLINE static Indices compressed(Mask mask, std::int32_t* lanes) {
    const hn::RebindToSigned<D> i;
    const auto indices = hn::Compress(hn::Iota(i, 0), hn::RebindMask(i, mask));
    hn::StoreU(indices, i, lanes);
    return hn::IndicesFromVec(d_, indices);
  }

  /// Computes the sums of K terms over the records [first, first + count). `terms` computes the
  /// terms of each record.
  template <int K, class Terms>
  HWY_INLINE void sum(std::size_t first, std::size_t count, double (&total)[K],
                      const Terms& terms) const {
    std::fill_n(total, K, 0.0);
    for (std::size_t block = 0; block < count; block += kBlock) {
      const std::size_t size = std::min(count - block, kBlock);
      alignas(64) float lanes[K][8];
      for (std::size_t at = 0; at < 8; at += kLanes) {
        V sums[K];
        for (V& s : sums) s = hn::Zero(d_);
        for (std::size_t i = at; i < size; i += 8) {
          V term[K];
          terms(Loader(*this, first + block + i, size - i), term);
          for (int k = 0; k < K; ++k) sums[k] = hn::Add(sums[k], term[k]);
        }
        for (int k = 0; k < K; ++k) hn::Store(sums[k], d_, lanes[k] + at);
      }
      for (int k = 0; k < K; ++k) {
        const hn::FixedTag<float, 4> four;
        auto s = hn::Add(hn::Load(four, lanes[k]), hn::Load(four, lanes[k] + 4));
        s = hn::Add(s, hn::Shuffle1032(s));
        total[k] += hn::GetLane(hn::Add(s, hn::Shuffle2301(s)));
      }
    }
  }

  std::size_t stride_;
  std::unique_ptr<float[]> data_;
};

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
