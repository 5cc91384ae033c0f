#include "planner/problem/sha256.h"

#include <dlfcn.h>
#include <openssl/opensslv.h>
#include <openssl/sha.h>
#include <stdexcept>

#define CORRIDOR_TEXT_OF(macro) CORRIDOR_TEXT(macro)
#define CORRIDOR_TEXT(words) #words

namespace corridor {
namespace {

using Function = decltype(&::SHA256);

/// Opens libcrypto at run time, and leaves it open. If the program were linked to libcrypto, the
/// library would be loaded at every start of the program.
Function functionOfLibrary() {
  constexpr const char* kLibrary = "libcrypto.so." CORRIDOR_TEXT_OF(OPENSSL_SHLIB_VERSION);
  void* const library = ::dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL);
  void* const function = library ? ::dlsym(library, "SHA256") : nullptr;
  if (!function) {
    const char* const why = ::dlerror();
    throw std::runtime_error("digests need OpenSSL's libcrypto (Debian: libssl3): " +
                             std::string(why ? why : kLibrary));
  }
  return reinterpret_cast<Function>(function);
}

}  // namespace

std::array<std::uint8_t, 32> sha256(std::string_view bytes) {
  static const Function compute = functionOfLibrary();
  std::array<std::uint8_t, 32> digest{};
  compute(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), digest.data());
  return digest;
}

std::string sha256Hex(std::string_view bytes) {
  std::string text;
  for (const std::uint8_t byte : sha256(bytes))
    for (const int digit : {byte >> 4, byte & 15}) text += "0123456789abcdef"[digit];
  return text;
}

}  // namespace corridor
