#pragma once

#include <cstdint>

namespace corridor {

/// Sixteen pairs of four things and four others as SIMD lanes: lane l is the pair (l / 4, l % 4).
/// The second is a row of four, repeated; the first takes element kRowOfLane[l] of its row.
alignas(64) inline constexpr std::int32_t kRowOfLane[16] = {0, 0, 0, 0, 1, 1, 1, 1,
                                                            2, 2, 2, 2, 3, 3, 3, 3};

}  // namespace corridor
