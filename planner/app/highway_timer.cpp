#include <cstdint>

/// Highway's shared library measures the resolution of the processor's timer when it is loaded, for
/// its benchmark of functions. That takes 4 to 5 ms of each start of a program, and Corridor has no
/// use for the result. The library calls the function through its procedure linkage table, so the
/// dynamic linker takes the definition of the program, this one, instead of the library's own.
/// (The test CommandLine.HighwayMeasuresNoTimer checks it. If a later version of the library does
/// not call it in this way, the only effect is that starting takes longer.)
namespace hwy::platform {

std::uint64_t TimerResolution();
std::uint64_t TimerResolution() {
  return 1;  // tick
}

}  // namespace hwy::platform
