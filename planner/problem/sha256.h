#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace corridor {

/// Computes SHA-256 (NIST FIPS 180-4) of bytes that are given in portions of any size. For digests
/// of input files, not for secrets.
class Sha256 {
 public:
  void update(std::string_view bytes);
  /// Returns the digest of all bytes so far: 32 bytes, big endian. The object can't be used
  /// afterwards.
  std::array<std::uint8_t, 32> finish();

 private:
  void block(const std::uint8_t* bytes);

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> pending_{};
  std::uint64_t length_ = 0;  ///< bytes so far
};

/// Returns the digest of `bytes` in 64 lower-case hexadecimal digits.
std::string sha256Hex(std::string_view bytes);

/// Returns 32 bytes as 64 lower-case hexadecimal digits.
std::string toHex(const std::array<std::uint8_t, 32>& digest);

}  // namespace corridor
