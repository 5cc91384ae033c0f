#pragma once

#include <cfenv>
#include <fpu_control.h>
#include <xmmintrin.h>

namespace corridor::audit {

/// Floating-point modes that a program may have set when it calls the library.
enum class Mode {
  usual,
  flushToZero,  ///< subnormal operands and results are replaced by 0
  upward,
  downward,
  towardZero,
  shortX87,  ///< long double is rounded to 53 bits
};

/// Sets a floating-point mode. The destructor restores the previous mode.
class Surroundings {
 public:
  explicit Surroundings(Mode mode) : csr_(_mm_getcsr()) {
    std::fegetenv(&environment_);
    switch (mode) {
      case Mode::usual:
        break;
      case Mode::flushToZero:
        _mm_setcsr(csr_ | 0x8040);
        break;
      case Mode::upward:
        std::fesetround(FE_UPWARD);
        break;
      case Mode::downward:
        std::fesetround(FE_DOWNWARD);
        break;
      case Mode::towardZero:
        std::fesetround(FE_TOWARDZERO);
        break;
      case Mode::shortX87: {
        fpu_control_t word;
        _FPU_GETCW(word);
        word = static_cast<fpu_control_t>((word & ~_FPU_EXTENDED) | _FPU_DOUBLE);
        _FPU_SETCW(word);
        break;
      }
    }
  }
  ~Surroundings() {
    std::fesetenv(&environment_);
    _mm_setcsr(csr_);
  }
  Surroundings(const Surroundings&) = delete;
  Surroundings& operator=(const Surroundings&) = delete;

 private:
  unsigned csr_;
  std::fenv_t environment_;
};

}  // namespace corridor::audit
