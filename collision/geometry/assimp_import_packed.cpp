#include <cstdint>
#include <cstring>
#include <type_traits>

#include "collision/geometry/assimp_import.h"

namespace corridor {
namespace {

constexpr std::uint64_t kMagic = 0x32706d6973736132;  // "2assimp2"

/// The header of the packed bytes.
struct Head {
  std::uint64_t magic = kMagic;
  std::uint64_t vertices = 0, triangles = 0, polygons = 0;  // counts
  std::uint64_t faults = 0, notes = 0, otherFiles = 0;      // counts
  double fileUnit = 0;
  std::uint64_t isCollada = 0;
  std::int64_t up = 0;
};

using Indices = std::array<std::uint32_t, 3>;
static_assert(sizeof(PolygonFan) == 16 && std::is_trivially_copyable_v<PolygonFan>);
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

bool takeFaults(std::string_view& bytes, std::uint64_t count, std::vector<Fault>& faults) {
  for (; count > 0; --count) {
    Fault& fault = faults.emplace_back();
    if (!takeText(bytes, fault.file) || bytes.size() < sizeof fault.line) return false;
    take(bytes, &fault.line, 1);
    if (!takeText(bytes, fault.text)) return false;
  }
  return true;
}

}  // namespace

std::string packed(const AssimpImport& import) {
  const Head head{kMagic,
                  import.mesh.vertices.size(),
                  import.mesh.triangles.size(),
                  import.polygons.size(),
                  import.faults.size(),
                  import.notes.size(),
                  import.otherFiles.size(),
                  import.fileUnit,
                  import.isCollada,
                  import.up};
  std::string bytes;
  bytes.reserve(sizeof head + head.vertices * sizeof(Vec3) + head.triangles * sizeof(Indices) +
                head.polygons * sizeof(PolygonFan));
  append(bytes, &head, 1);
  append(bytes, import.mesh.vertices.data(), import.mesh.vertices.size());
  append(bytes, import.mesh.triangles.data(), import.mesh.triangles.size());
  append(bytes, import.polygons.data(), import.polygons.size());
  for (const Fault& fault : import.faults) {
    appendText(bytes, fault.file);
    append(bytes, &fault.line, 1);
    appendText(bytes, fault.text);
  }
  for (const auto* const texts : {&import.notes, &import.otherFiles})
    for (const std::string& text : *texts) appendText(bytes, text);
  appendText(bytes, import.format);
  appendText(bytes, import.error);
  return bytes;
}

bool unpack(std::string_view bytes, AssimpImport& import) {
  Head head;
  if (bytes.size() < sizeof head) return false;
  take(bytes, &head, 1);
  // The counts are compared with the size first, so that the products below cannot overflow.
  if (head.magic != kMagic || head.vertices > bytes.size() || head.triangles > bytes.size() ||
      head.polygons > bytes.size() ||
      bytes.size() < head.vertices * sizeof(Vec3) + head.triangles * sizeof(Indices) +
                         head.polygons * sizeof(PolygonFan))
    return false;
  import.mesh.vertices.resize(head.vertices);
  import.mesh.triangles.resize(head.triangles);
  import.polygons.resize(head.polygons);
  take(bytes, import.mesh.vertices.data(), head.vertices);
  take(bytes, import.mesh.triangles.data(), head.triangles);
  take(bytes, import.polygons.data(), head.polygons);
  std::uint64_t end = 0;  // of the last fan
  for (const PolygonFan& fan : import.polygons) {
    if (fan.triangles < 2 || fan.firstTriangle < end) return false;
    end = std::uint64_t{fan.firstTriangle} + fan.triangles;
  }
  if (end > head.triangles) return false;
  for (const PolygonFan& fan : import.polygons)
    for (std::uint32_t k = fan.firstTriangle + 1; k < fan.firstTriangle + fan.triangles; ++k) {
      const Indices &before = import.mesh.triangles[k - 1], &triangle = import.mesh.triangles[k];
      if (triangle[0] != before[0] || triangle[1] != before[2]) return false;
    }
  if (!takeFaults(bytes, head.faults, import.faults) ||
      !takeTexts(bytes, head.notes, import.notes) ||
      !takeTexts(bytes, head.otherFiles, import.otherFiles) || !takeText(bytes, import.format) ||
      !takeText(bytes, import.error) || !bytes.empty())
    return false;
  import.fileUnit = head.fileUnit;
  import.isCollada = head.isCollada != 0;
  import.up = static_cast<char>(head.up);
  return true;
}

}  // namespace corridor
