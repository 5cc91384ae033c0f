#include "collision/geometry/gltf_json.h"

#include <algorithm>
#include <array>
#include <set>

#include "collision/core/spelling.h"
#include "collision/geometry/scene_mesh.h"

namespace corridor::gltf {
namespace {

constexpr const char* kWithout = "; save the mesh without it";

/// Returns whether an extension is about the looks, the names or the sounds of a scene only.
bool isHarmless(std::string_view extension) {
  static constexpr std::array<std::string_view, 8> parts{"_materials_", "_texture_", "_lights_",
                                                         "_packing_",   "_xmp",      "_audio",
                                                         "_animation",  "_webgl"};
  static constexpr std::array<std::string_view, 7> names{
      "FB_ngon_encoding",   // which triangles were one polygon
      "EXT_mesh_features",  // numbers of features
      "EXT_mesh_manifold",  // which triangles make a closed surface
      "EXT_mesh_primitive_edge_visibility",
      "KHR_mesh_quantization",  // positions that are no floats are refused
      "KHR_node_visibility",    // hidden nodes are read, too
      "MSFT_lod"};              // the finest level is in the scene
  return std::find(names.begin(), names.end(), extension) != names.end() ||
         std::any_of(parts.begin(), parts.end(),
                     [&](std::string_view part) { return extension.find(part) != part.npos; });
}

void checkExtension(const std::string& name, bool isRequired, MeshFaults& faults,
                    std::vector<std::string>& notes) {
  if (isHarmless(name)) return;
  if (isRequired)
    faults.add(0, "the required extension \"" + printable(name) + "\" is not supported" + kWithout);
  else if (name.find("mesh") != name.npos || name == "CESIUM_RTC")
    faults.add(0, "the extension \"" + printable(name) +
                      "\" moves, copies or packs geometry, and is not supported" + kWithout);
  else
    addNote(notes, "the optional extension \"" + printable(name) + "\" is not read");
}

}  // namespace

Json parse(std::string_view text, MeshFaults& faults) {
  if (text.starts_with("\xEF\xBB\xBF"))
    faults.fail(0, "begins with a byte-order mark, which glTF doesn't allow; remove it");
  std::vector<std::set<std::string>> open;
  const auto check = [&](int depth, Json::parse_event_t event, const Json& parsed) {
    if (depth > 500) faults.fail(0, "its JSON nests deeper than 500");
    if (event == Json::parse_event_t::object_start) open.emplace_back();
    if (event == Json::parse_event_t::object_end) open.pop_back();
    if (event == Json::parse_event_t::key && !open.back().insert(parsed.get<std::string>()).second)
      faults.add(0, "an object has a key twice: " + inQuotes(parsed.get<std::string>()));
    return true;
  };
  // The parser takes a byte 0 for the end of the text. GLB files may be filled up with them.
  if (const auto end = text.find('\0');
      end != text.npos && text.find_first_not_of('\0', end) != text.npos)
    faults.fail(0, "no valid JSON: it has a byte 0");
  try {
    Json root = Json::parse(text, check);
    faults.throwIfAny();
    return root;
  } catch (const Json::parse_error& error) {
    faults.fail(0, "no valid JSON at byte " + std::to_string(error.byte));
  } catch (const Json::exception&) {  // a number beyond the doubles
    faults.fail(0, "no valid JSON: a number is beyond the range of doubles; correct it");
  }
}

const Json* find(const Json& object, const char* name) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(name);
  return found == object.end() ? nullptr : &*found;
}

const Json& member(const Json& object, const char* name) {
  static const Json none;
  const Json* const value = find(object, name);
  return value ? *value : none;
}

void checkKeys(const Json& object, const std::string& what,
               std::initializer_list<std::string_view> known, MeshFaults& faults,
               std::vector<std::string>& notes) {
  if (!object.is_object()) return faults.add(0, what + " is no JSON object");
  for (const auto& entry : object.items()) {
    const std::string& key = entry.key();
    if (key == "name" || key == "extras" || key == "extensions" ||
        std::find(known.begin(), known.end(), key) != known.end())
      continue;
    const auto meant = std::find_if(known.begin(), known.end(), [&](std::string_view name) {
      return lowered(name) == lowered(key);
    });
    if (meant != known.end())
      faults.add(0, "the key " + inQuotes(key) + " is not read; write " + inQuotes(*meant));
    else
      addNote(notes, "the key " + inQuotes(key) + " is not read");
  }
}

std::optional<std::uint32_t> whole(const Json& object, const char* name, const std::string& what,
                                   MeshFaults& faults) {
  const Json* const value = find(object, name);
  if (!value) return std::nullopt;
  if (value->is_number_unsigned() && value->get<std::uint64_t>() <= INT32_MAX)
    return static_cast<std::uint32_t>(value->get<std::uint64_t>());
  faults.add(0, '"' + std::string(name) + "\" of " + what + " is " + value->dump().substr(0, 32) +
                    "; a whole number of at least 0 is needed, without a point");
  return std::nullopt;
}

std::optional<std::vector<double>> numbers(const Json& object, const char* name, std::size_t count,
                                           const std::string& what, MeshFaults& faults) {
  const Json* const value = find(object, name);
  if (!value) return std::nullopt;
  std::vector<double> found;
  if (value->is_array() && value->size() == count)
    for (const Json& number : *value)
      if (number.is_number()) found.push_back(number.get<double>());
  if (found.size() != count) {
    faults.add(0, "the " + std::string(name) + " of " + what + " needs " + std::to_string(count) +
                      " numbers");
    return std::nullopt;
  }
  for (const double number : found)
    if (const std::string wrong = wrongMagnitude(number); !wrong.empty())
      faults.add(0, "the " + std::string(name) + " of " + what + ": " + wrong);
  return found;
}

void checkExtensions(const Json& root, MeshFaults& faults, std::vector<std::string>& notes) {
  std::set<std::string> required, used;
  for (const Json& name : member(root, "extensionsRequired"))
    if (name.is_string()) required.insert(name.get<std::string>());
  for (const Json& name : member(root, "extensionsUsed"))
    if (name.is_string()) used.insert(name.get<std::string>());
  std::vector<const Json*> open{&root};
  while (!open.empty()) {
    const Json& value = *open.back();
    open.pop_back();
    for (const auto& [key, inner] : value.items()) {
      if (key == "extras") continue;  // the program's that wrote the file
      if (key == "extensions" && inner.is_object())
        for (const auto& entry : inner.items()) used.insert(entry.key());
      if (inner.is_structured()) open.push_back(&inner);
    }
  }
  for (const std::string& name : required) checkExtension(name, true, faults, notes);
  for (const std::string& name : used)
    if (!required.contains(name)) checkExtension(name, false, faults, notes);
}

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

}  // namespace corridor::gltf
