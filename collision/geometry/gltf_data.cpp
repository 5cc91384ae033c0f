#include "collision/geometry/gltf_data.h"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "collision/core/read_file.h"
#include "collision/core/spelling.h"

namespace corridor::gltf {
namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;

std::uint64_t bytesOf(std::uint32_t type) {
  return type == 5120 || type == 5121 ? 1 : type == 5122 || type == 5123 ? 2 : 4;
}

/// Returns whether a type is an unsigned integer of 1, 2 or 4 bytes.
bool isUnsigned(std::uint32_t type) {
  return type == 5121 || type == 5123 || type == 5125;
}

std::uint32_t unsignedAt(const char* at, std::uint32_t type) {
  std::uint32_t value = 0;  // glTF is little-endian, as the processors are for which this is built
  std::memcpy(&value, at, bytesOf(type));
  return value;
}

/// Returns the bytes of a Base64 text; nullopt if it is none.
std::optional<std::string> fromBase64(std::string_view text) {
  if (text.size() % 4 != 0) return std::nullopt;
  const std::size_t whole = text.size() / 4 * 3;
  std::size_t padding = 0;
  while (padding < 2 && text.ends_with('=')) text.remove_suffix(1), ++padding;
  std::string bytes;
  bytes.reserve(whole);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int value = c >= 'A' && c <= 'Z'   ? c - 'A'
                      : c >= 'a' && c <= 'z' ? c - 'a' + 26
                      : c >= '0' && c <= '9' ? c - '0' + 52
                      : c == '+'             ? 62
                      : c == '/'             ? 63
                                             : -1;
    if (value < 0) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes += static_cast<char>(bits >> count & 0xFF);
    }
  }
  return bytes;
}

}  // namespace

/// Returns where `count` elements of `size` bytes are; null without a bufferView. Adds a fault,
/// and returns null, if they are not all in their view and its buffer.
Data::Elements Data::elements(const Json& part, std::uint64_t count, std::uint64_t size,
                              const std::string& what) {
  const Json* const view = document_.referred(part, "bufferView", "bufferViews", what);
  if (!view) return {};
  document_.check(*view, "a bufferView",
                  {"buffer", "byteLength", "byteOffset", "byteStride", "target"});
  const auto number = document_.whole(*view, "buffer", "a bufferView");
  const auto length = document_.whole(*view, "byteLength", "a bufferView");
  if (!number || !length) {
    document_.fault("a bufferView has no buffer or no byteLength");
    return {};
  }
  const std::string* const bytes = buffer(*number);
  const std::uint64_t start = document_.whole(*view, "byteOffset", "a bufferView").value_or(0);
  const std::uint64_t own = document_.whole(part, "byteOffset", what).value_or(0);
  const std::uint64_t stride = document_.whole(*view, "byteStride", "a bufferView")
                                   .value_or(static_cast<std::uint32_t>(size));
  if (!bytes) return {};
  if (stride < size) {
    document_.fault("the byteStride of " + what + " is " + std::to_string(stride) + "; at least " +
                    std::to_string(size) + " is needed");
    return {};
  }
  // All numbers are below 2^31, so that nothing overflows.
  if (count > 0 && own + stride * (count - 1) + size > *length) {
    document_.fault("the elements of " + what +
                    " lie beyond the byteLength of their bufferView; correct count, byteOffset or "
                    "byteLength");
    return {};
  }
  if (start + *length > bytes->size()) {
    document_.fault(
        "the bufferView of " + what +
        " lies beyond the byteLength of its buffer; correct its byteOffset or byteLength");
    return {};
  }
  return {bytes->data() + start + own, stride};
}

/// Returns the bytes of a buffer; null, after a fault, if it can't be read.
const std::string* Data::buffer(std::uint32_t number) {
  if (const auto known = buffers_.find(number); known != buffers_.end()) return &known->second;
  const Json* const found = document_.elementOf("buffers", number, "a bufferView");
  if (!found) return nullptr;
  const std::string what = "buffer " + std::to_string(number);
  document_.check(*found, what, {"byteLength", "uri"});
  const auto length = document_.whole(*found, "byteLength", what);
  if (!length) {
    document_.fault(what + " has no byteLength");
    return nullptr;
  }
  std::string bytes;
  const Json& uri = member(*found, "uri");
  if (uri.is_null()) {
    if (!chunk_ || number != 0) {
      document_.fault(what + " has no uri");
      return nullptr;
    }
    bytes = *chunk_;
  } else if (!uri.is_string()) {
    document_.fault("the uri of " + what + " is no text");
    return nullptr;
  } else {
    bytes = contentsOf(uri.get<std::string>(), what);
    document_.faults().throwIfAny();
  }
  if (bytes.size() < *length) {
    document_.fault(what + " has " + std::to_string(bytes.size()) +
                    " bytes, and its byteLength is " + std::to_string(*length));
    return nullptr;
  }
  bytes.resize(*length);
  return &(buffers_[number] = std::move(bytes));
}

std::string Data::contentsOf(const std::string& uri, const std::string& what) {
  if (lowered(std::string_view(uri).substr(0, 5)) == "data:") {
    const auto comma = uri.find(',');
    if (comma == uri.npos || !std::string_view(uri).substr(0, comma).ends_with(";base64")) {
      document_.fault("the data of a buffer are not in Base64");
      return {};
    }
    auto bytes = fromBase64(std::string_view(uri).substr(comma + 1));
    if (!bytes)
      document_.fault(
          "the data of a buffer are no Base64: A to Z, a to z, 0 to 9, + and /, four characters "
          "for three bytes, with = at the end");
    return std::move(bytes).value_or("");
  }
  // By the format, the name is encoded. Some programs write it as it is.
  const std::filesystem::path folder = std::filesystem::path(file_).parent_path();
  std::filesystem::path path = folder / percentDecoded(uri);
  if (std::error_code error; !std::filesystem::exists(path, error)) path = folder / uri;
  if (const std::string why = whyNotOrdinaryFile(path); !why.empty()) {
    document_.fault("the file " + inQuotes(uri) + " of " + what + ": " + why +
                    "; put it beside the mesh file, or save the mesh as GLB, which is one file");
    return {};
  }
  otherFiles_.push_back(path.string());
  return readFile(path, "a buffer of a glTF file", kMostBytes);
}

/// Checks an accessor's keys and type, and returns its number of elements.
std::uint32_t Data::checkAccessor(const Json& accessor, const char* type, const std::string& what) {
  document_.check(accessor, what,
                  {"bufferView", "byteOffset", "componentType", "count", "max", "min", "normalized",
                   "sparse", "type"});
  if (member(accessor, "type") != type)
    document_.fault(what + " is of type " + member(accessor, "type").dump().substr(0, 32) +
                    ", and " + type + " is needed");
  const Json& normalized = member(accessor, "normalized");
  if (!normalized.is_null() && normalized != false)
    document_.fault(what + " may not be normalized");
  const auto count = document_.whole(accessor, "count", what);
  if (!count) document_.fault(what + " has no count");
  if (!find(accessor, "bufferView") && find(accessor, "byteOffset"))
    document_.fault(what + " has a byteOffset without a bufferView");
  document_.faults().requireFew(count.value_or(0), "vertices", 0);
  document_.faults().throwIfAny();
  return *count;
}

/// Calls take(i, data) for each element of an accessor that is stored, and then for each that a
/// sparse accessor replaces. Elements that are not stored are 0.
template <class Take>
void Data::forElements(const Json& accessor, const Elements& stored, std::uint32_t count,
                       std::uint64_t size, const std::string& what, const Take& take) {
  if (stored.first)
    for (std::uint32_t i = 0; i < count; ++i) take(i, stored.first + stored.stride * i);
  const Json* const sparse = find(accessor, "sparse");
  if (!sparse) return;
  document_.check(*sparse, "\"sparse\" of " + what, {"count", "indices", "values"});
  const Json &indices = member(*sparse, "indices"), &values = member(*sparse, "values");
  document_.check(indices, "the sparse indices of " + what,
                  {"bufferView", "byteOffset", "componentType"});
  document_.check(values, "the sparse values of " + what, {"bufferView", "byteOffset"});
  document_.faults().throwIfAny();
  const auto replaced = document_.whole(*sparse, "count", "\"sparse\" of " + what);
  const auto type = document_.whole(indices, "componentType", "the sparse indices of " + what);
  if (!replaced || !type || !isUnsigned(*type) || !find(indices, "bufferView") ||
      !find(values, "bufferView"))
    return document_.fault("\"sparse\" of " + what +
                           " needs a count, indices of an unsigned type, and values");
  const Elements places =
      elements(indices, *replaced, bytesOf(*type), "the sparse indices of " + what);
  const Elements data = elements(values, *replaced, size, "the sparse values of " + what);
  document_.faults().throwIfAny();
  std::optional<std::uint32_t> last;
  for (std::uint32_t i = 0; i < *replaced; ++i) {
    const std::uint32_t place = unsignedAt(places.first + places.stride * i, *type);
    if (last && place <= *last)
      return document_.fault("the sparse indices of " + what + " do not increase");
    last = place;
    if (place >= count)
      return document_.fault("a sparse index of " + what + " is beyond its count");
    take(place, data.first + data.stride * i);
  }
}

void Data::readPositions(const Json& accessor, std::vector<Vec3>& vertices) {
  const std::string what = "an accessor of POSITION";
  if (member(accessor, "componentType") != 5126)
    document_.fault(
        "positions are not stored as floats, which is not supported; save them as floats");
  const std::uint32_t count = checkAccessor(accessor, "VEC3", what);
  if (!find(accessor, "bufferView") && (unstored_ += count) > 1'000'000)
    return document_.fault(what + " brings the elements without a bufferView to more than 10^6");
  const Elements stored = elements(accessor, count, 12, what);
  document_.faults().throwIfAny();  // before there is memory for so many
  const std::size_t first = vertices.size();
  vertices.resize(first + count, Vec3::Zero());
  document_.faults().requireFew(vertices.size(), "vertices", 0);
  forElements(accessor, stored, count, 12, what, [&](std::uint32_t i, const char* at) {
    float xyz[3];
    std::memcpy(xyz, at, sizeof xyz);
    vertices[first + i] = {xyz[0], xyz[1], xyz[2]};
  });
}

std::vector<std::uint32_t> Data::readIndices(const Json& accessor) {
  const std::string what = "an accessor of indices";
  const auto type = document_.whole(accessor, "componentType", what);
  if (!type || !isUnsigned(*type)) {
    document_.fault("indices are not of an unsigned type");
    return {};
  }
  if (!find(accessor, "bufferView")) {
    document_.fault(what + " has no bufferView");
    return {};
  }
  const std::uint32_t count = checkAccessor(accessor, "SCALAR", what);
  const Elements stored = elements(accessor, count, bytesOf(*type), what);
  document_.faults().throwIfAny();  // before there is memory for so many
  std::vector<std::uint32_t> indices(count, 0);
  forElements(accessor, stored, count, bytesOf(*type), what,
              [&](std::uint32_t i, const char* at) { indices[i] = unsignedAt(at, *type); });
  // It would restart a strip in some programs, and is forbidden.
  const std::uint32_t greatest = *type == 5121 ? 0xFF : *type == 5123 ? 0xFFFF : 0xFFFFFFFF;
  if (std::ranges::count(indices, greatest) > 0)
    document_.fault(what + " has the greatest index of its type, which glTF forbids");
  return indices;
}

}  // namespace corridor::gltf
