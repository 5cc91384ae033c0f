#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "collision/geometry/mesh_text.h"
#include "collision/geometry/stated_unit.h"

namespace corridor {

enum class PlyType { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };

int plySize(PlyType type);
inline bool isInteger(PlyType type) {
  return type < PlyType::Float32;
}

struct PlyProperty {
  std::string name;
  PlyType type;
  /// Set only for lists: a list stores its length in this type, and then its values in `type`.
  std::optional<PlyType> countType;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

enum class PlyEncoding { Ascii, LittleEndian, BigEndian };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::Ascii;
  std::vector<PlyElement> elements;
  std::size_t size = 0;                 ///< bytes before the first element
  int lines = 0;                        ///< lines of the header
  std::vector<StatedUnit> statedUnits;  ///< in comments
};

/// Reads the header of a PLY file. Throws if vertices do not have the scalar properties x, y and z.
/// If `isMesh` is true, also throws if there is no element `face` with a list of integer indices.
PlyHeader readPlyHeader(std::string_view bytes, bool isMesh, MeshFaults& faults);

/// Returns whether the property has one of the two common names of the list of a face's corners.
inline bool isCornerList(const PlyProperty& property) {
  return property.name == "vertex_indices" || property.name == "vertex_index";
}

}  // namespace corridor
