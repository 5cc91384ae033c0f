#include "collision/geometry/assimp_content.h"

#include <cmath>

namespace corridor {
ContentKind contentKindOf(std::string_view extension) {
  return extension == ".dae"    ? ContentKind::Collada
         : extension == ".gltf" ? ContentKind::Gltf
         : extension == ".glb"  ? ContentKind::BinaryGltf
         : extension == ".3mf"  ? ContentKind::ThreeMf
                                : ContentKind::Other;
}

double lengthError(const double* numbers, int size) {
  double square = 0;
  for (int i = 0; i < size; ++i) square += numbers[i] * numbers[i];
  return std::abs(square - 1);
}

bool hasLengthOne(const double* numbers, int size) {
  // Coordinates of d digits behind the point are off by h = 10^-d / 2 at most, so the square of a
  // length is off by 2 h sqrt(size) + size h^2 <= 4 h + 4 h^2: 2e-6 for the six digits that files
  // commonly have. The slack also covers most axes of five digits, such as 0.57735.
  constexpr double kSlack = 1e-5;
  return lengthError(numbers, size) <= kSlack;
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
  switch (kind) {
    case ContentKind::Collada:
      return checkCollada(file, bytes, report);
    case ContentKind::Gltf:
      return checkGltf(file, bytes, report);
    case ContentKind::BinaryGltf:
      return checkGlb(file, bytes, report);
    case ContentKind::ThreeMf:
      return checkThreeMf(file, report);
    case ContentKind::Other:
      return;
  }
}

}  // namespace corridor
