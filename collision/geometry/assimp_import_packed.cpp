#include <cstdint>
#include <cstring>
#include <type_traits>

#include "collision/geometry/assimp_import.h"

namespace corridor {
namespace {

constexpr std::uint64_t kMagic = 0x31706d6973736131;  // "1assimp1"

/// The header of the packed bytes.
struct Head {
  std::uint64_t magic = kMagic;
  std::uint64_t vertices = 0, triangles = 0;  // counts
  std::uint64_t format = 0, error = 0;        // lengths of the texts in bytes
  double fileUnit = 0;
  std::uint64_t isCollada = 0;
};

using Indices = std::array<std::uint32_t, 3>;
static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Indices) == 12);

template <class T>
void append(std::string& bytes, const T* from, std::size_t count) {
  if (count > 0) bytes.append(reinterpret_cast<const char*>(from), count * sizeof(T));
}

template <class T>
void take(std::string_view& bytes, T* to, std::size_t count) {
  if (count > 0) std::memcpy(static_cast<void*>(to), bytes.data(), count * sizeof(T));
  bytes.remove_prefix(count * sizeof(T));
}

}  // namespace

std::string packed(const AssimpImport& import) {
  const Head head{kMagic,
                  import.mesh.vertices.size(),
                  import.mesh.triangles.size(),
                  import.format.size(),
                  import.error.size(),
                  import.fileUnit,
                  import.isCollada};
  std::string bytes;
  bytes.reserve(sizeof head + head.vertices * sizeof(Vec3) + head.triangles * sizeof(Indices) +
                head.format + head.error);
  append(bytes, &head, 1);
  append(bytes, import.mesh.vertices.data(), import.mesh.vertices.size());
  append(bytes, import.mesh.triangles.data(), import.mesh.triangles.size());
  bytes += import.format;
  return bytes += import.error;
}

bool unpack(std::string_view bytes, AssimpImport& import) {
  Head head;
  if (bytes.size() < sizeof head) return false;
  take(bytes, &head, 1);
  // The counts and lengths are compared with the size first, so that the products below cannot
  // overflow.
  if (head.magic != kMagic || head.vertices > bytes.size() || head.triangles > bytes.size() ||
      head.format > bytes.size() || head.error > bytes.size() ||
      bytes.size() != head.vertices * sizeof(Vec3) + head.triangles * sizeof(Indices) +
                          head.format + head.error)
    return false;
  import.mesh.vertices.resize(head.vertices);
  import.mesh.triangles.resize(head.triangles);
  take(bytes, import.mesh.vertices.data(), head.vertices);
  take(bytes, import.mesh.triangles.data(), head.triangles);
  import.format = bytes.substr(0, head.format);
  import.error = bytes.substr(head.format);
  import.fileUnit = head.fileUnit;
  import.isCollada = head.isCollada != 0;
  return true;
}

}  // namespace corridor
