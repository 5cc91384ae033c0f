#pragma once

#include <cfenv>
#include <cstdint>
#include <string>
#include <vector>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace corridor::test {

/// A floating-point mode of the processor.
struct FloatingPointSetting {
  std::string name;
  int rounding = FE_TONEAREST;  ///< of all operations, unless `sseOnly` or `x87Only` is set
  bool flushToZero = false;     ///< subnormal results and operands become zero
  bool sseOnly = false;         ///< `rounding` applies only to vectors and doubles
  bool x87Only = false;         ///< `rounding` applies only to long double
  bool shortExtended = false;   ///< the x87 keeps 53 bits
  bool bits24 = false;          ///< with `shortExtended`: the x87 keeps 24 bits

  /// Returns whether all operations round to nearest, with full precision. Ignores `flushToZero`.
  bool standard() const { return rounding == FE_TONEAREST && !shortExtended; }
};

/// Returns the modes that this machine supports.
inline std::vector<FloatingPointSetting> floatingPointSettings() {
  std::vector<FloatingPointSetting> all = {{"nearest"},
                                           {"upward", FE_UPWARD},
                                           {"downward", FE_DOWNWARD},
                                           {"towards_zero", FE_TOWARDZERO}};
#if defined(__x86_64__)
  all.push_back({.name = "flush_to_zero", .flushToZero = true});
  all.push_back({.name = "short_extended", .shortExtended = true});
  all.push_back({.name = "single_extended", .shortExtended = true, .bits24 = true});
  for (const int rounding : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    all.push_back(
        {.name = "vectors_" + std::to_string(rounding), .rounding = rounding, .sseOnly = true});
    all.push_back(
        {.name = "x87_" + std::to_string(rounding), .rounding = rounding, .x87Only = true});
  }
#endif
  return all;
}

/// Sets a floating-point mode. The destructor restores the previous mode.
class WithFloatingPoint {
 public:
  explicit WithFloatingPoint(const FloatingPointSetting& setting) {
    std::fegetenv(&before_);
#if defined(__x86_64__)
    std::uint16_t control = 0;
    asm volatile("fnstcw %0" : "=m"(control));
    const unsigned vectors = _mm_getcsr();
    std::fesetround(setting.rounding);
    if (setting.sseOnly) asm volatile("fldcw %0" : : "m"(control));
    if (setting.x87Only) _mm_setcsr(vectors);
    if (setting.flushToZero) _mm_setcsr(_mm_getcsr() | 0x8040);
    if (setting.shortExtended) {
      asm volatile("fnstcw %0" : "=m"(control));
      control = static_cast<std::uint16_t>((control & ~0x300) | (setting.bits24 ? 0 : 0x200));
      asm volatile("fldcw %0" : : "m"(control));
    }
#else
    std::fesetround(setting.rounding);
#endif
  }
  ~WithFloatingPoint() {
    std::fesetenv(&before_);
  }
  WithFloatingPoint(const WithFloatingPoint&) = delete;
  WithFloatingPoint& operator=(const WithFloatingPoint&) = delete;

 private:
  std::fenv_t before_;
};

}  // namespace corridor::test
