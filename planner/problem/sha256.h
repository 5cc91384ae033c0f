#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace corridor {

/// Returns the SHA-256 (NIST FIPS 180-4) of the bytes: 32 bytes, big endian. For digests of input
/// files, not for secrets. OpenSSL's libcrypto computes it. The first call opens this library,
/// which takes 1 to 2 ms. It is not opened earlier, because most commands need no digest.
/// @throws std::runtime_error if the library is not installed.
std::array<std::uint8_t, 32> sha256(std::string_view bytes);

/// Returns `sha256` as 64 lower-case hexadecimal digits.
std::string sha256Hex(std::string_view bytes);

}  // namespace corridor
