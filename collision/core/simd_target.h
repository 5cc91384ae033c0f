#pragma once

namespace corridor {

/// The instruction set that the SIMD kernels use on this machine, by Highway's name ("AVX2"; "AVX3"
/// is AVX-512): what a figure of speed has to name.
const char* simdTarget();

}  // namespace corridor
