#include <algorithm>
#include <array>
#include <optional>

#include <nlohmann/json.hpp>

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
  static constexpr std::array<std::string_view, 4> names{
      "FB_ngon_encoding",     // assimp's polygons have the same triangles
      "KHR_binary_glTF",      // the form of binary files of version 1
      "KHR_node_visibility",  // hidden nodes are read, too
      "MSFT_lod"};            // the finest level is in the scene
  return std::find(names.begin(), names.end(), extension) != names.end() ||
         std::any_of(parts.begin(), parts.end(),
                     [&](std::string_view part) { return extension.find(part) != part.npos; });
}

/// Returns an element of an array by its index, or of an object by its key (version 1 of glTF).
/// Returns null if there is none.
const Json* at(const Json& all, const Json& key) {
  if (all.is_array() && key.is_number_unsigned() && key.get<std::size_t>() < all.size())
    return &all[key.get<std::size_t>()];
  if (!all.is_object() || !key.is_string()) return nullptr;
  const auto found = all.find(key.get_ref<const std::string&>());
  return found == all.end() ? nullptr : &*found;
}
const Json& member(const Json& object, const char* name) {
  static const Json none;
  const Json* const value = at(object, name);
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
    return std::nullopt;
  }
}

class GltfCheck {
 public:
  GltfCheck(const std::string& file, const Json& root, ContentReport& report)
      : file_(file), root_(root), report_(report) {}

  void run() {
    for (const Json& name : member(root_, "extensionsRequired"))
      if (name.is_string() && !isHarmless(name.get<std::string>()) &&
          required_.insert(name.get<std::string>()).second)
        fault("the required extension " + name.dump() + " is not supported" + kWithout);
    for (const Json& name : member(root_, "extensionsUsed"))
      if (name.is_string()) checkExtension(name);
    checkValues();
    checkTransforms();
    checkScene();
  }

 private:
  void fault(const std::string& text) { report_.fault(file_, 0, text); }

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

  /// Checks the transforms of the nodes. assimp does not normalise rotations.
  void checkTransforms() {
    for (const Json& node : member(root_, "nodes")) {
      bool hasParts = false;
      for (const char* const part : {"translation", "rotation", "scale"})
        hasParts |= !member(node, part).is_null();
      if (hasParts && !member(node, "matrix").is_null())
        fault("a node has a matrix and another transform, of which assimp reads one; keep one");
      std::vector<double> turn;
      for (const Json& number : member(node, "rotation"))
        turn.push_back(number.is_number() ? number.get<double>() : 0);
      if (!turn.empty() && (turn.size() != 4 || !hasLengthOne(turn.data(), 4)))
        fault(
            "the rotation of a node is not of length 1, and assimp would distort the mesh; write a "
            "quaternion with length 1, with six digits or more");
    }
  }

  /// Notes nodes with meshes that are not in the scene that is read: the default one, else the
  /// first.
  void checkScene() {
    const Json& nodes = member(root_, "nodes");
    const Json& scene = member(root_, "scene");
    const Json* const read = at(member(root_, "scenes"), scene.is_null() ? Json(0u) : scene);
    if (!read) return;
    std::set<const Json*> reached;
    std::vector<const Json*> open{read};
    while (!open.empty()) {
      const Json& parent = *open.back();
      open.pop_back();
      for (const Json& key : member(parent, &parent == read ? "nodes" : "children"))
        if (const Json* const node = at(nodes, key); node && reached.insert(node).second)
          open.push_back(node);
    }
    for (const Json& node : nodes)
      if (!reached.contains(&node) &&
          !(member(node, "mesh").is_null() && member(node, "meshes").is_null()))
        report_.note("meshes outside the file's default scene are not read");
  }

  static constexpr int kFloat = 5126;

  const std::string& file_;
  const Json& root_;
  ContentReport& report_;
  std::set<std::string> required_;  // extensions that are not supported
};

}  // namespace

void checkGltf(const std::string& file, std::string_view json, ContentReport& report) {
  if (const auto root = parse(file, json, report)) GltfCheck(file, *root, report).run();
}

}  // namespace corridor
