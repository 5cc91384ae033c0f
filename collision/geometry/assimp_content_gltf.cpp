#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>

#include <nlohmann/json.hpp>

#include "collision/core/spelling.h"
#include "collision/geometry/assimp_content.h"

namespace corridor {
namespace {

using Json = nlohmann::json;

constexpr const char* kWithout = "; save the mesh without it";

/// Returns whether an extension is about the looks, the names or the sounds of a scene only.
bool isHarmless(std::string_view extension) {
  static constexpr std::array<std::string_view, 8> parts{"_materials_", "_texture_", "_lights_",
                                                         "_packing_",   "_xmp",      "_audio",
                                                         "_animation",  "_webgl"};
  static constexpr std::array<std::string_view, 3> names{
      "FB_ngon_encoding",     // assimp's polygons have the same triangles
      "KHR_node_visibility",  // hidden nodes are read, too
      "MSFT_lod"};            // the finest level is in the scene
  return std::find(names.begin(), names.end(), extension) != names.end() ||
         std::any_of(parts.begin(), parts.end(),
                     [&](std::string_view part) { return extension.find(part) != part.npos; });
}

/// Returns an element of an array by its index; null if there is none.
const Json* at(const Json& all, const Json& index) {
  const bool isIndex =
      all.is_array() && index.is_number_unsigned() && index.get<std::size_t>() < all.size();
  return isIndex ? &all[index.get<std::size_t>()] : nullptr;
}
/// Returns a member of an object; null if there is none.
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

/// Parses a text. Adds a fault if an object has a key twice: parsers differ in which they take.
std::optional<Json> parse(const std::string& file, std::string_view text, ContentReport& report) {
  std::vector<std::set<std::string>> open;
  const auto check = [&](int, Json::parse_event_t event, const Json& parsed) {
    if (event == Json::parse_event_t::object_start) open.emplace_back();
    if (event == Json::parse_event_t::object_end) open.pop_back();
    if (event == Json::parse_event_t::key && !open.back().insert(parsed.get<std::string>()).second)
      report.fault(file, 0, "an object has a key twice: " + parsed.dump());
    return true;
  };
  try {
    return Json::parse(text, check);
  } catch (const Json::parse_error& error) {
    report.fault(file, 0, "no valid JSON at byte " + std::to_string(error.byte));
  } catch (const Json::exception&) {  // a number beyond the doubles
    report.fault(file, 0, "no valid JSON: a number is beyond the range of doubles; correct it");
  }
  return std::nullopt;
}

class GltfCheck {
 public:
  GltfCheck(const std::string& file, const Json& root, bool isBinary, ContentReport& report)
      : file_(file), root_(root), isBinary_(isBinary), report_(report) {}

  void run() {
    if (!checkVersion()) return;
    for (const char* const list :
         {"accessors", "bufferViews", "buffers", "meshes", "nodes", "scenes"})
      if (const Json* const value = find(root_, list); value && !value->is_array())
        fault('"' + std::string(list) + "\" is not an array");
    for (const Json& name : member(root_, "extensionsRequired"))
      if (name.is_string() && !isHarmless(name.get<std::string>()) &&
          required_.insert(name.get<std::string>()).second)
        fault("the required extension " + name.dump() + " is not supported" + kWithout);
    for (const Json& name : member(root_, "extensionsUsed"))
      if (name.is_string()) checkExtension(name);
    checkValues();
    checkNodes();
    checkMeshes();
    checkData();
    checkBuffers();
    checkScene();
  }

 private:
  void fault(const std::string& text) { report_.fault(file_, 0, text); }

  /// Returns whether the file has version 2. assimp decides by the first character.
  bool checkVersion() {
    const Json& version = member(member(root_, "asset"), "version");
    const auto* const name = version.get_ptr<const std::string*>();
    const Json& least = member(member(root_, "asset"), "minVersion");
    if (!least.is_null() && least != "2.0" && least != "2") {
      fault("needs a reader of glTF " + least.dump().substr(0, 32) +
            ", which is not supported; save the mesh as glTF 2.0");
      return false;
    }
    if (name && (*name == "2" || name->starts_with("2."))) return true;
    // A string has quotes around it.
    const std::string text = version.dump().substr(0, 32);
    fault((name && !name->empty()
               ? "glTF " + text.substr(1, text.size() - 2)
               : std::string("glTF without a version such as \"2.0\" in its asset")) +
          " is not supported; save the mesh as glTF 2.0");
    return false;
  }

  void checkExtension(const std::string& name) {
    if (isHarmless(name) || required_.contains(name)) return;
    if (name.find("mesh") != name.npos || name == "CESIUM_RTC")
      fault("the extension \"" + name + "\" moves, copies or packs geometry, and is not supported" +
            kWithout);
    else
      report_.note("the optional extension \"" + name + "\" is not read");
  }

  /// Checks the extensions, skins, weights and positions of all objects.
  void checkValues() {
    std::vector<const Json*> open{&root_};
    while (!open.empty()) {
      const Json& value = *open.back();
      open.pop_back();
      for (const auto& [key, inner] : value.items()) {
        if (key == "extras") continue;  // the program's that wrote the file
        checkValue(key, inner);
        if (inner.is_structured()) open.push_back(&inner);
      }
    }
  }

  void checkValue(const std::string& key, const Json& value) {
    if (key == "extensions" && value.is_object())
      for (const auto& entry : value.items()) checkExtension(entry.key());
    if (key == "skin")
      fault(
          "a node has a skin, whose joints move its vertices, which is not supported; save the "
          "mesh in its pose, without a skin");
    if (key == "weights" && value.is_array() &&
        std::any_of(value.begin(), value.end(), [](const Json& w) { return w != 0; }))
      fault(
          "morph targets have weights other than 0, which is not supported; save the mesh in its "
          "shape, without morph targets");
    if (key != "attributes") return;
    const Json* const position = at(member(root_, "accessors"), member(value, "POSITION"));
    if (position && member(*position, "componentType") != kFloat)
      fault("positions are not stored as floats, which is not supported; save them as floats");
    if (position && member(*position, "type") != "VEC3")
      fault("positions are not of type VEC3; save three coordinates for each");
  }

  /// Checks an object's keys: assimp skips those whose letters have another case.
  void checkKeys(const Json& object, std::initializer_list<std::string_view> known) {
    if (!object.is_object()) return;
    for (const auto& entry : object.items())
      for (const std::string_view name : known)
        if (entry.key() != name && lowered(entry.key()) == lowered(name))
          fault("the key \"" + entry.key() + "\" is not read; write \"" + std::string(name) + '"');
  }

  static bool isInteger(const Json& value) {
    return value.is_number_unsigned() && value.get<std::uint64_t>() <= kMostInteger;
  }
  void faultInteger(const std::string& key, const Json& value) {
    fault('"' + key + "\" is " + value.dump() +
          "; a whole number of at least 0 is needed, without a point");
  }

  /// Checks that each of the keys, where an object has it, has a whole number. assimp replaces
  /// other values, such as 48.0, by a default, or skips what they belong to.
  void requireIntegers(const Json& object, std::initializer_list<const char*> keys) {
    for (const char* const key : keys)
      if (const Json* const value = find(object, key); value && !isInteger(*value))
        faultInteger(key, *value);
  }

  /// Checks that an object's member is an array of indices, if there is one. assimp refuses an
  /// index that is too large.
  void requireIndices(const Json& object, const char* key) {
    const Json* const values = find(object, key);
    if (!values) return;
    if (!values->is_array()) return fault('"' + std::string(key) + "\" is not an array");
    for (const Json& value : *values)
      if (!isInteger(value)) faultInteger(key, value);
  }

  void requireNumbers(const Json& node, const char* key, std::size_t size) {
    const Json* const numbers = find(node, key);
    if (numbers && !(numbers->is_array() && numbers->size() == size &&
                     std::all_of(numbers->begin(), numbers->end(),
                                 [](const Json& number) { return number.is_number(); })))
      fault("the " + std::string(key) + " of a node needs " + std::to_string(size) + " numbers");
  }

  /// Checks primitives.
  void checkMeshes() {
    for (const Json& mesh : member(root_, "meshes")) {
      checkKeys(mesh, {"primitives", "weights"});
      for (const Json& primitive : member(mesh, "primitives")) {
        checkKeys(primitive, {"attributes", "indices", "mode", "targets"});
        checkKeys(member(primitive, "attributes"), {"POSITION"});
        requireIntegers(primitive, {"indices", "mode"});
        requireIntegers(member(primitive, "attributes"), {"POSITION"});
        if (const Json& mode = member(primitive, "mode");
            mode.is_number_unsigned() && mode.get<std::uint64_t>() > 6)
          fault("the mode of a primitive is " + mode.dump() + "; 0 to 6 is needed");
        checkAccessor("POSITION", member(member(primitive, "attributes"), "POSITION"), 3);
        checkAccessor("indices", member(primitive, "indices"), 1);
      }
    }
  }

  static std::uint64_t unsignedOf(const Json& value) {
    return value.is_number_unsigned() ? value.get<std::uint64_t>() : 0;
  }

  /// Returns the bytes of a component of an accessor, or of a part of one.
  static std::uint64_t bytesOf(const Json& part) {
    const std::uint64_t kind = unsignedOf(member(part, "componentType"));
    return kind == 5120 || kind == 5121 ? 1 : kind == 5122 || kind == 5123 ? 2 : 4;
  }

  /// Returns the view of an accessor, or of a part of one; null if there is none.
  const Json* viewOf(const Json& part) const {
    return at(member(root_, "bufferViews"), member(part, "bufferView"));
  }
  /// Returns the byteStride of an accessor, or of a part of one; 0 if there is none.
  std::uint64_t strideOf(const Json& part) const {
    const Json* const view = viewOf(part);
    return view ? unsignedOf(member(*view, "byteStride")) : 0;
  }

  /// Checks where the elements of an accessor are. assimp reads sparse accessors as if there were
  /// no gaps. @param components the numbers of an element
  void checkAccessor(const std::string& name, const Json& key, std::uint64_t components) {
    const Json* const accessor = at(member(root_, "accessors"), key);
    if (!accessor) return;
    const std::uint64_t size = components * bytesOf(*accessor);
    const std::uint64_t stride = strideOf(*accessor);
    if (stride > 0 && stride < size)
      fault("the byteStride of " + name + " is " + std::to_string(stride) + "; at least " +
            std::to_string(size) + " is needed");
    const std::string label = name + " (accessor " + key.dump() + ")";
    requireInView(label, *accessor, unsignedOf(member(*accessor, "count")), size);
    const Json& sparse = member(*accessor, "sparse");
    if (!sparse.is_object()) return;
    const Json &indices = member(sparse, "indices"), &values = member(sparse, "values");
    if ((stride > 0 && stride != size) || strideOf(values) > 0 || strideOf(indices) > 0)
      fault(
          "a sparse accessor of " + name +
          " has a byteStride, which assimp does not apply; save the mesh without sparse accessors");
    if (member(indices, "bufferView").is_null() || member(values, "bufferView").is_null())
      fault("a sparse accessor of " + name + " needs indices and values, each with a bufferView");
    const std::uint64_t count = unsignedOf(member(sparse, "count"));
    requireInView("the sparse indices of " + label, indices, count, bytesOf(indices));
    requireInView("the sparse values of " + label, values, count, size);
  }

  /// Checks that elements of a size lie in their view, and the view in its buffer: assimp would
  /// read other memory.
  void requireInView(const std::string& name, const Json& part, std::uint64_t count,
                     std::uint64_t size) {
    const Json* const view = viewOf(part);
    if (!view || count == 0 || count > kMostInteger) return;
    for (const Json* const number : {&member(part, "byteOffset"), &member(*view, "byteOffset"),
                                     &member(*view, "byteLength"), &member(*view, "byteStride")})
      if (!number->is_null() && !isInteger(*number)) return;  // a fault of requireIntegers
    // All numbers are below 2^31, so that nothing overflows.
    const std::uint64_t end = unsignedOf(member(part, "byteOffset")) +
                              std::max(strideOf(part), size) * (count - 1) + size;
    const Json& length = member(*view, "byteLength");
    if (!length.is_null() && end > unsignedOf(length))
      fault("the elements of " + name +
            " lie beyond the byteLength of their bufferView; correct count, byteOffset or "
            "byteLength");
    const Json* const buffer = at(member(root_, "buffers"), member(*view, "buffer"));
    if (!buffer || member(*buffer, "byteLength").is_null()) return;
    if (unsignedOf(member(*view, "byteOffset")) + unsignedOf(length) >
        unsignedOf(member(*buffer, "byteLength")))
      fault("the bufferView of " + name +
            " lies beyond the byteLength of its buffer; correct its byteOffset or byteLength");
  }

  /// Checks the data in the file. assimp takes characters that Base64 does not have for zeros.
  void checkBuffers() {
    const Json* const first = at(member(root_, "buffers"), 0u);
    if (isBinary_ && first && !member(*first, "uri").is_null())
      fault(
          "assimp does not read the uri of a GLB file's first buffer; put the data into the file");
    for (const Json& buffer : member(root_, "buffers")) {
      const Json& uri = member(buffer, "uri");
      if (!uri.is_string() || !uri.get_ref<const std::string&>().starts_with("data:")) continue;
      std::string_view data = uri.get_ref<const std::string&>();
      const auto comma = data.find(',');
      if (comma == data.npos || !data.substr(0, comma).ends_with(";base64")) {
        fault("the data of a buffer are not in Base64");
        continue;
      }
      data.remove_prefix(comma + 1);
      const bool isWhole = data.size() % 4 == 0;
      for (int i = 0; i < 2 && data.ends_with('='); ++i) data.remove_suffix(1);
      if (!isWhole || std::any_of(data.begin(), data.end(), [](char c) {
            return !((c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
                     c == '+' || c == '/');
          }))
        fault(
            "the data of a buffer are no Base64: A to Z, a to z, 0 to 9, + and /, four characters "
            "for three bytes, with = at the end");
    }
  }

  /// Checks accessors and views of buffers.
  void checkData() {
    for (const Json& accessor : member(root_, "accessors")) {
      checkKeys(accessor, {"bufferView", "byteOffset", "componentType", "count", "type", "sparse"});
      requireIntegers(accessor, {"bufferView", "byteOffset", "componentType", "count"});
      const Json* const sparse = find(accessor, "sparse");
      if (!sparse) continue;
      if (!sparse->is_object()) fault("\"sparse\" is not an object");
      requireIntegers(*sparse, {"count"});
      for (const char* const part : {"indices", "values"})
        requireIntegers(member(*sparse, part), {"bufferView", "byteOffset", "componentType"});
    }
    for (const Json& view : member(root_, "bufferViews")) {
      checkKeys(view, {"buffer", "byteOffset", "byteLength", "byteStride"});
      requireIntegers(view, {"buffer", "byteOffset", "byteLength", "byteStride"});
    }
  }

  /// Checks nodes and scenes. assimp does not normalise rotations.
  void checkNodes() {
    requireIntegers(root_, {"scene"});
    for (const Json& scene : member(root_, "scenes")) {
      checkKeys(scene, {"nodes"});
      requireIndices(scene, "nodes");
    }
    for (const Json& node : member(root_, "nodes")) {
      checkKeys(node, {"mesh", "children", "matrix", "translation", "rotation", "scale", "skin",
                       "weights"});
      requireIntegers(node, {"mesh"});
      requireIndices(node, "children");
      requireNumbers(node, "matrix", 16);
      requireNumbers(node, "translation", 3);
      requireNumbers(node, "rotation", 4);
      requireNumbers(node, "scale", 3);
      bool hasParts = false;
      for (const char* const part : {"translation", "rotation", "scale"})
        hasParts |= !member(node, part).is_null();
      if (hasParts && !member(node, "matrix").is_null())
        fault("a node has a matrix and another transform, of which assimp reads one; keep one");
      std::vector<double> turn;
      for (const Json& number : member(node, "rotation"))
        if (number.is_number()) turn.push_back(number.get<double>());
      if (turn.size() == 4)
        report_.node.rounding =
            std::max(report_.node.rounding, 0x1p-21 + 2 * lengthError(turn.data(), 4));
      if (turn.size() == 4 && !hasLengthOne(turn.data(), 4))
        fault(
            "the rotation of a node is not of length 1, and assimp would distort the mesh; write a "
            "quaternion with length 1, with six digits or more");
    }
  }

  /// Returns the number of triangles of a primitive by its accessors.
  double trianglesOf(const Json& primitive) const {
    const Json& accessors = member(root_, "accessors");
    const Json* const indices = find(primitive, "indices");
    const Json* const accessor =
        at(accessors, indices ? *indices : member(member(primitive, "attributes"), "POSITION"));
    const Json& count = accessor ? member(*accessor, "count") : accessors;
    const Json& mode = member(primitive, "mode");
    if (!count.is_number_unsigned() || !(mode.is_null() || mode.is_number_unsigned())) return 0;
    const auto corners = count.get<std::uint64_t>();
    const auto kind = mode.is_null() ? kTriangles : mode.get<std::uint64_t>();
    return kind == kTriangles                 ? static_cast<double>(corners / 3)
           : kind > kTriangles && corners > 2 ? static_cast<double>(corners - 2)
                                              : 0;
  }

  /// Returns the number of triangles of a node and its children. @param known the numbers of nodes
  /// that are counted; a node that is being counted has 0.
  double trianglesOf(const Json& node, std::map<const Json*, double>& known) const {
    const auto [entry, isNew] = known.try_emplace(&node, 0);
    if (!isNew) return entry->second;
    double sum = 0;
    if (const Json* const mesh = at(member(root_, "meshes"), member(node, "mesh")))
      for (const Json& primitive : member(*mesh, "primitives")) sum += trianglesOf(primitive);
    for (const Json& key : member(node, "children"))
      if (const Json* const child = at(member(root_, "nodes"), key))
        sum += trianglesOf(*child, known);
    return entry->second = sum;
  }

  /// Counts the triangles of the scene that is read: the default one, else the first. Notes nodes
  /// with meshes that are not in it.
  void checkScene() {
    const Json& nodes = member(root_, "nodes");
    const Json& scene = member(root_, "scene");
    const Json* const read = at(member(root_, "scenes"), scene.is_null() ? Json(0u) : scene);
    if (!read) return;
    std::map<const Json*, double> known;
    report_.triangles = 0;
    std::set<const Json*> children;
    for (const Json& node : nodes)
      for (const Json& key : member(node, "children")) children.insert(at(nodes, key));
    for (const Json& key : member(*read, "nodes"))
      if (const Json* const node = at(nodes, key); node && children.contains(node))
        fault("a node is in a scene and the child of a node; a scene may name root nodes only");
    for (const Json& key : member(*read, "nodes"))
      if (const Json* const node = at(nodes, key)) *report_.triangles += trianglesOf(*node, known);
    for (const Json& node : nodes)
      if (!known.contains(&node) && !member(node, "mesh").is_null())
        report_.note("meshes outside the file's default scene are not read");
  }

  static constexpr int kFloat = 5126;
  static constexpr std::uint64_t kTriangles = 4;  // the mode; strips and fans are 5 and 6
  static constexpr std::uint64_t kMostInteger = INT32_MAX;

  const std::string& file_;
  const Json& root_;
  const bool isBinary_;
  ContentReport& report_;
  std::set<std::string> required_;  // extensions that are not supported
};

}  // namespace

void checkGltf(const std::string& file, std::string_view json, ContentReport& report,
               bool isBinary) {
  if (json.starts_with("\xEF\xBB\xBF"))
    return report.fault(file, 0,
                        "begins with a byte-order mark, which glTF doesn't allow; remove it");
  if (const auto root = parse(file, json, report)) GltfCheck(file, *root, isBinary, report).run();
}

void checkGlb(const std::string& file, std::string_view bytes, ContentReport& report) {
  // The word "glTF", the version and the file's size, then the size of the JSON, the word "JSON"
  // and the JSON itself.
  constexpr std::size_t kHead = 20;
  if (bytes.size() < kHead) return;
  const auto wordAt = [&](std::size_t at) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    return word;
  };
  if (!bytes.starts_with("glTF"))
    return report.fault(file, 0, "a GLB file begins with the word glTF; save the file again");
  if (const std::uint32_t version = wordAt(4); version != 2)
    return report.fault(
        file, 0,
        "binary glTF " + std::to_string(version) + " is not supported; save the mesh as glTF 2.0");
  if (bytes.substr(16, 4) != "JSON")
    return report.fault(file, 0, "the first chunk of a GLB file must be JSON; save the file again");
  checkGltf(file, bytes.substr(kHead, wordAt(12)), report, true);
}

}  // namespace corridor
