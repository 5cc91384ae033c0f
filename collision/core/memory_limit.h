#pragma once

#include <cstddef>

namespace corridor {

/// Limits the memory of this process, and of each process that it starts, to the present size plus
/// `bytes`. Allocations beyond the limit fail. The limit counts heap, stacks and private mappings
/// (RLIMIT_DATA, which works under sanitizers, unlike RLIMIT_AS). If /proc cannot be read, this
/// function sets no limit.
void limitMemory(std::size_t bytes);

}  // namespace corridor
