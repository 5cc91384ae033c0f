#pragma once

#include <cstddef>

namespace corridor {

/// Limits what this process, and those that it starts, may allocate from now on, in bytes beyond
/// what it has (heap, stacks and private mappings: RLIMIT_DATA, which works under sanitizers, too,
/// as RLIMIT_AS does not). Beyond it allocations fail.
void limitMemory(std::size_t bytes);

}  // namespace corridor
