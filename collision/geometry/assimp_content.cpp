#include "collision/geometry/assimp_content.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace corridor {
ContentKind contentKindOf(std::string_view extension) {
  return extension == ".dae"    ? ContentKind::Collada
         : extension == ".gltf" ? ContentKind::Gltf
         : extension == ".glb"  ? ContentKind::BinaryGltf
         : extension == ".x3d"  ? ContentKind::X3d
         : extension == ".amf"  ? ContentKind::Amf
         : extension == ".3mf"  ? ContentKind::ThreeMf
         : extension == ".fbx"  ? ContentKind::Fbx
                                : ContentKind::Other;
}

bool hasLengthOne(const double* numbers, int size) {
  // Coordinates of d digits behind the point are off by h = 10^-d / 2 at most, so the square of a
  // length is off by 2 h sqrt(size) + size h^2 <= 4 h + 4 h^2: 2e-6 for the six digits that files
  // commonly have. The slack also covers most axes of five digits, such as 0.57735.
  constexpr double kSlack = 1e-5;
  double square = 0;
  for (int i = 0; i < size; ++i) square += numbers[i] * numbers[i];
  return std::abs(square - 1) <= kSlack;
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
  if (kind == ContentKind::Fbx) return checkFbx(file, bytes, report);
  if (kind == ContentKind::ThreeMf) return checkThreeMf(file, report);
  if (kind != ContentKind::BinaryGltf) return checkXml(kind, file, bytes, report);
  // In both versions of the format, the JSON begins at byte 20, and its size is at byte 12.
  std::uint32_t size = 0;
  if (bytes.size() < 20) return;
  std::memcpy(&size, bytes.data() + 12, sizeof size);
  const std::string_view json = bytes.substr(20, size);
  checkGltf(file, json, report, bytes.size() - 20 - json.size());
}

}  // namespace corridor
