#include "collision/geometry/gltf_json.h"

#include <algorithm>
#include <array>
#include <set>

#include "collision/core/spelling.h"
#include "collision/core/text_encoding.h"
#include "collision/geometry/scene_mesh.h"

namespace corridor::gltf {
namespace {

constexpr const char* kWithout = "; save the mesh without it";

/// Returns whether an extension is about the looks, the names or the sounds of a scene only.
bool isHarmless(std::string_view extension) {
  const auto afterVendor = extension.substr(std::min(extension.find('_'), extension.size()));
  static constexpr std::array<std::string_view, 8> starts{
      "_materials_", "_texture_", "_lights_",   "_packing_",
      "_xmp",        "_audio",    "_animation", "_techniques_webgl"};
  static constexpr std::array<std::string_view, 7> names{
      "FB_ngon_encoding",   // which triangles were one polygon
      "EXT_mesh_features",  // numbers of features
      "EXT_mesh_manifold",  // which triangles make a closed surface
      "EXT_mesh_primitive_edge_visibility",
      "KHR_mesh_quantization",  // positions that are no floats are refused
      "KHR_node_visibility",    // hidden nodes are read, too
      "MSFT_lod"};              // the finest level is in the scene
  return std::find(names.begin(), names.end(), extension) != names.end() ||
         std::any_of(starts.begin(), starts.end(),
                     [&](std::string_view start) { return afterVendor.starts_with(start); });
}

/// Returns whether an extension has a prefix of Khronos or of a member, whose names say what the
/// extensions do.
bool hasKnownPrefix(std::string_view extension) {
  static constexpr std::array<std::string_view, 5> prefixes{"KHR_", "EXT_", "MSFT_", "ADOBE_",
                                                            "FB_"};
  return std::ranges::any_of(
      prefixes, [&](std::string_view prefix) { return extension.starts_with(prefix); });
}

/// Adds a fault for a number other than 0 that is 0 as a double, such as 1e-400: the parser does
/// not tell.
void checkNumbers(std::string_view text, MeshFaults& faults) {
  bool isInText = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') isInText = !isInText;
    if (text[i] == '\\') {
      ++i;
      continue;
    }
    if (isInText || text[i] < '0' || text[i] > '9') continue;
    const std::size_t end = std::min(text.find_first_not_of("0123456789.eE+-", i), text.size());
    double number = 1;
    const std::string_view word = text.substr(i, end - i);
    if (!parseCoordinate(word, number) && isRoundedToZero(word, number))
      faults.add(0, "the number " + inQuotes(word) + " is beyond the range of doubles; correct it");
    i = end - 1;
  }
}

}  // namespace

Json parse(std::string_view text, MeshFaults& faults) {
  text = withoutByteOrderMark(text);  // readers may skip it (RFC 8259, section 8.1)
  checkNumbers(text, faults);
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

void Document::note(const std::string& text) {
  addNote(notes_, text);
}

void Document::check(const Json& object, const std::string& what,
                     std::initializer_list<std::string_view> known) {
  if (!object.is_object()) return fault(what + " is no JSON object");
  for (const auto& entry : object.items()) {
    const std::string& key = entry.key();
    if (key == "name" || key == "extras" || key == "extensions" ||
        std::find(known.begin(), known.end(), key) != known.end())
      continue;
    const auto meant = std::find_if(known.begin(), known.end(), [&](std::string_view name) {
      return lowered(name) == lowered(key);
    });
    if (meant != known.end())
      fault("the key " + inQuotes(key) + " is not read; write " + inQuotes(*meant));
    else
      note("the key " + inQuotes(key) + " is not read");
  }
}

std::optional<std::uint32_t> Document::whole(const Json& object, const char* name,
                                             const std::string& what) {
  const Json* const value = find(object, name);
  if (!value) return std::nullopt;
  if (value->is_number_unsigned() && value->get<std::uint64_t>() <= INT32_MAX)
    return static_cast<std::uint32_t>(value->get<std::uint64_t>());
  fault('"' + std::string(name) + "\" of " + what + " is " + value->dump().substr(0, 32) +
        "; a whole number of at least 0 is needed, without a point");
  return std::nullopt;
}

std::vector<std::uint32_t> Document::wholes(const Json& object, const char* name,
                                            const std::string& what) {
  std::vector<std::uint32_t> found;
  const Json* const values = find(object, name);
  if (values && !values->is_array()) fault('"' + std::string(name) + "\" is not an array");
  if (!values || !values->is_array()) return found;
  for (const Json& value : *values)
    if (const auto index = whole(Json{{name, value}}, name, what)) found.push_back(*index);
  return found;
}

std::optional<std::vector<double>> Document::numbers(const Json& object, const char* name,
                                                     std::size_t count, const std::string& what) {
  const Json* const value = find(object, name);
  if (!value) return std::nullopt;
  std::vector<double> found;
  if (value->is_array() && value->size() == count)
    for (const Json& number : *value)
      if (number.is_number()) found.push_back(number.get<double>());
  if (found.size() != count) {
    fault("the " + std::string(name) + " of " + what + " needs " + std::to_string(count) +
          " numbers");
    return std::nullopt;
  }
  for (const double number : found)
    if (const std::string wrong = wrongMagnitude(number); !wrong.empty())
      fault("the " + std::string(name) + " of " + what + ": " + wrong);
  return found;
}

const Json* Document::elementOf(const char* list, std::uint32_t index, const std::string& what) {
  const Json& all = member(root_, list);
  if (index < all.size()) return &all[index];
  fault(what + " refers to number " + std::to_string(index) + " of \"" + list + "\", which has " +
        std::to_string(all.size()));
  return nullptr;
}

const Json* Document::referred(const Json& object, const char* name, const char* list,
                               const std::string& what) {
  const auto index = whole(object, name, what);
  return index ? elementOf(list, *index, what) : nullptr;
}

void Document::checkExtension(const std::string& name, bool isRequired) {
  // A required extension is known by its name only: others may do more than their names say.
  if (isHarmless(name) && (!isRequired || hasKnownPrefix(name))) return;
  if (isRequired)
    fault("the required extension \"" + printable(name) + "\" is not supported" + kWithout);
  else if (name.find("mesh") != name.npos || name == "CESIUM_RTC")
    fault("the extension \"" + printable(name) +
          "\" moves, copies or packs geometry, and is not supported" + kWithout);
  else
    note("the optional extension \"" + printable(name) + "\" is not read");
}

void Document::checkExtensions() {
  std::set<std::string> required, used;
  for (const auto& [key, names] :
       {std::pair("extensionsRequired", &required), std::pair("extensionsUsed", &used)}) {
    const Json* const list = find(root_, key);
    if (!list) continue;
    if (!list->is_array() || !std::ranges::all_of(*list, &Json::is_string))
      return fault('"' + std::string(key) + "\" is not an array of texts");
    for (const Json& name : *list) names->insert(name.get<std::string>());
  }
  std::vector<const Json*> open{&root_};
  while (!open.empty()) {
    const Json& value = *open.back();
    open.pop_back();
    for (const auto& [key, inner] : value.items()) {
      if (key == "extras") continue;  // the program's that wrote the file
      if (key == "extensions" && !inner.is_object())
        fault("\"extensions\" is no JSON object");
      else if (key == "extensions")
        for (const auto& entry : inner.items()) used.insert(entry.key());
      if (inner.is_structured()) open.push_back(&inner);
    }
  }
  for (const std::string& name : required) checkExtension(name, true);
  for (const std::string& name : used)
    if (!required.contains(name)) checkExtension(name, false);
}

}  // namespace corridor::gltf
