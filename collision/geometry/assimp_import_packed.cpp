#include <cstdint>
#include <cstring>

#include "collision/geometry/assimp_import.h"

namespace corridor {
namespace {

constexpr std::uint64_t kMagic = 0x33706d6973736133;  // "3assimp3"

/// The header of the packed bytes.
struct Head {
  std::uint64_t magic = kMagic;
  std::uint64_t vertices = 0, triangles = 0, otherFiles = 0;  // counts
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

void appendText(std::string& bytes, const std::string& text) {
  const std::uint64_t size = text.size();
  append(bytes, &size, 1);
  bytes += text;
}

/// Takes a text that `appendText` appended. Returns false if the bytes are incomplete.
bool takeText(std::string_view& bytes, std::string& text) {
  std::uint64_t size = 0;
  if (bytes.size() < sizeof size) return false;
  take(bytes, &size, 1);
  if (bytes.size() < size) return false;
  text = bytes.substr(0, size);
  bytes.remove_prefix(size);
  return true;
}

bool takeTexts(std::string_view& bytes, std::uint64_t count, std::vector<std::string>& texts) {
  for (; count > 0; --count)
    if (!takeText(bytes, texts.emplace_back())) return false;
  return true;
}

}  // namespace

std::string packed(const AssimpImport& import) {
  const Head head{kMagic, import.mesh.vertices.size(), import.mesh.triangles.size(),
                  import.otherFiles.size()};
  std::string bytes;
  bytes.reserve(sizeof head + head.vertices * sizeof(Vec3) + head.triangles * sizeof(Indices));
  append(bytes, &head, 1);
  append(bytes, import.mesh.vertices.data(), import.mesh.vertices.size());
  append(bytes, import.mesh.triangles.data(), import.mesh.triangles.size());
  for (const std::string& text : import.otherFiles) appendText(bytes, text);
  appendText(bytes, import.error);
  return bytes;
}

bool unpack(std::string_view bytes, AssimpImport& import) {
  Head head;
  if (bytes.size() < sizeof head) return false;
  take(bytes, &head, 1);
  // The counts are compared with the size first, so that the products below cannot overflow.
  if (head.magic != kMagic || head.vertices > bytes.size() || head.triangles > bytes.size() ||
      bytes.size() < head.vertices * sizeof(Vec3) + head.triangles * sizeof(Indices))
    return false;
  import.mesh.vertices.resize(head.vertices);
  import.mesh.triangles.resize(head.triangles);
  take(bytes, import.mesh.vertices.data(), head.vertices);
  take(bytes, import.mesh.triangles.data(), head.triangles);
  return takeTexts(bytes, head.otherFiles, import.otherFiles) && takeText(bytes, import.error) &&
         bytes.empty();
}

}  // namespace corridor
