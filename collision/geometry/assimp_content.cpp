#include "collision/geometry/assimp_content.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "collision/core/spelling.h"

namespace corridor {
namespace {

/// Checks the directory of a ZIP archive: objects may be in models other than the one that assimp
/// reads. The model itself is packed, and assimp's ZIP reader is not exported, so it is not
/// checked.
void checkThreeMf(const std::string& file, std::string_view bytes, ContentReport& report) {
  constexpr std::string_view sign("PK\x01\x02", 4);  // of an entry; its name begins at byte 46
  int models = 0;
  for (auto at = bytes.find(sign); at != bytes.npos; at = bytes.find(sign, at + 4)) {
    std::uint16_t size = 0;
    if (bytes.size() < at + 46) break;
    std::memcpy(&size, bytes.data() + at + 28, sizeof size);
    models += lowered(std::string(bytes.substr(at + 46, size))).ends_with(".model");
  }
  if (models > 1)
    report.fault(file, 0,
                 "the archive has " + std::to_string(models) +
                     " models, of which assimp reads one; save the mesh as OBJ, STL, PLY or OFF");
  report.note(
      "the model in the archive is not searched for beam lattices, slices and other extensions, "
      "which would not be read");
}

}  // namespace

ContentKind contentKindOf(std::string_view extension) {
  return extension == ".dae"    ? ContentKind::Collada
         : extension == ".gltf" ? ContentKind::Gltf
         : extension == ".glb"  ? ContentKind::BinaryGltf
         : extension == ".x3d"  ? ContentKind::X3d
         : extension == ".amf"  ? ContentKind::Amf
         : extension == ".3mf"  ? ContentKind::ThreeMf
                                : ContentKind::Other;
}

void ContentReport::fault(const std::string& file, int line, const std::string& text) {
  if (faults.size() < 10 && known_.insert(file + '\n' + text).second)
    faults.push_back({file, line, text});
}

void ContentReport::note(const std::string& text) {
  if (known_.insert(text).second) notes.push_back(text);
}

void checkContent(ContentKind kind, const std::string& file, std::string_view bytes,
                  ContentReport& report) {
  if (kind == ContentKind::Other) return;
  if (kind == ContentKind::Gltf) return checkGltf(file, bytes, report);
  if (kind == ContentKind::ThreeMf) return checkThreeMf(file, bytes, report);
  if (kind != ContentKind::BinaryGltf) return checkXml(kind, file, bytes, report);
  // In both versions of the format, the JSON begins at byte 20, and its size is at byte 12.
  std::uint32_t size = 0;
  if (bytes.size() < 20) return;
  std::memcpy(&size, bytes.data() + 12, sizeof size);
  checkGltf(file, bytes.substr(20, size), report);
}

}  // namespace corridor
