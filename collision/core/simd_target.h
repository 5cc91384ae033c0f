#pragma once

namespace corridor {

/// Returns the instruction set that the SIMD kernels use on this machine, by Highway's name
/// ("AVX2"; "AVX3" is AVX-512). Reports of measured times must name this instruction set.
const char* simdTarget();

}  // namespace corridor
