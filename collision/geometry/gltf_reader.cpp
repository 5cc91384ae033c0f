// Reads glTF 2.0 (Khronos, glTF 2.0 Specification, ISO/IEC 12113:2022): the triangles of the
// default scene, under the transforms of its nodes.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>

#include "collision/core/read_file.h"
#include "collision/core/spelling.h"
#include "collision/geometry/gltf_json.h"
#include "collision/geometry/mesh_readers.h"
#include "collision/geometry/scene_mesh.h"

namespace corridor {
namespace {

using gltf::Json;
using gltf::member;

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;

/// Returns the name of a file with the bytes that URIs write as %20 and the like.
std::string decoded(std::string name) {
  for (auto at = name.find('%'); at != name.npos; at = name.find('%', at + 1)) {
    unsigned char byte = 0;
    const char* const digits = name.data() + at + 1;
    if (at + 3 > name.size() || std::from_chars(digits, digits + 2, byte, 16).ptr != digits + 2 ||
        byte == 0)
      continue;
    name.replace(at, 3, 1, static_cast<char>(byte));
  }
  return name;
}

class GltfReader {
 public:
  GltfReader(const std::string& file, const Json& root, std::optional<std::string_view> chunk,
             MeshFaults& faults)
      : file_(file), root_(root), chunk_(chunk), faults_(faults), scene_(faults) {}

  ReadMesh read() {
    checkVersion();
    check(root_, "the file",
          {"asset", "accessors", "animations", "bufferViews", "buffers", "cameras",
           "extensionsRequired", "extensionsUsed", "images", "materials", "meshes", "nodes",
           "samplers", "scene", "scenes", "skins", "textures"});
    for (const char* const list :
         {"accessors", "bufferViews", "buffers", "meshes", "nodes", "scenes"})
      if (const Json* const value = gltf::find(root_, list); value && !value->is_array())
        fault('"' + std::string(list) + "\" is not an array");
    gltf::checkExtensions(root_, faults_, notes_);
    faults_.throwIfAny();
    parts_.resize(member(root_, "meshes").size());
    readScene();
    for (const std::string& text : notes_) scene_.note(text);
    ReadMesh read = scene_.take("glTF 2.0");
    read.fileUnit = 1;
    read.up = 'y';
    read.otherFiles = otherFiles_;
    return read;
  }

 private:
  void fault(const std::string& text) { faults_.add(0, text); }
  void check(const Json& object, const std::string& what,
             std::initializer_list<std::string_view> known) {
    gltf::checkKeys(object, what, known, faults_, notes_);
  }
  std::optional<std::uint32_t> whole(const Json& object, const char* name,
                                     const std::string& what) {
    return gltf::whole(object, name, what, faults_);
  }
  /// Returns the element of a list of the file to which an object's member refers; null without
  /// the member. Adds a fault if there is no such element.
  const Json* referred(const Json& object, const char* name, const char* list,
                       const std::string& what) {
    const auto index = whole(object, name, what);
    if (!index) return nullptr;
    return elementOf(list, *index, what);
  }
  const Json* elementOf(const char* list, std::uint32_t index, const std::string& what) {
    const Json& all = member(root_, list);
    if (index < all.size()) return &all[index];
    fault(what + " refers to number " + std::to_string(index) + " of \"" + list + "\", which has " +
          std::to_string(all.size()));
    return nullptr;
  }

  void checkVersion() {
    const Json& asset = member(root_, "asset");
    const Json& least = member(asset, "minVersion");
    if (!least.is_null() && least != "2.0" && least != "2")
      faults_.fail(0, "needs a reader of glTF " + least.dump().substr(0, 32) +
                          ", which is not supported; save the mesh as glTF 2.0");
    const Json& version = member(asset, "version");
    const auto* const name = version.get_ptr<const std::string*>();
    if (name && (*name == "2" || name->starts_with("2."))) return;
    faults_.fail(0, (name && !name->empty()
                         ? "glTF " + printable(*name)
                         : std::string("glTF without a version such as \"2.0\" in its asset")) +
                        " is not supported; save the mesh as glTF 2.0");
  }

  void readScene() {
    const Json& scenes = member(root_, "scenes");
    if (scenes.empty()) faults_.fail(0, "has no scenes, so no mesh is placed");
    const auto number = whole(root_, "scene", "the file");
    const Json* const scene = elementOf("scenes", number.value_or(0), "the file");
    if (!scene) return;
    check(*scene, "a scene", {"nodes"});
    const Json& nodes = member(root_, "nodes");
    std::set<std::uint32_t> children;
    for (const Json& node : nodes)
      for (const std::uint32_t child : indicesOf(node, "children", "a node"))
        if (!children.insert(child).second) fault("a node is the child of two nodes");
    faults_.throwIfAny();
    for (const std::uint32_t root : indicesOf(*scene, "nodes", "a scene")) {
      if (children.contains(root))
        fault("a node is in a scene and the child of a node; a scene may name root nodes only");
      faults_.throwIfAny();
      readNode(root, {}, 1);
    }
    for (std::uint32_t i = 0; i < nodes.size(); ++i)
      if (!read_.contains(i) && !member(nodes[i], "mesh").is_null())
        scene_.note("meshes outside the file's default scene are not read");
  }

  std::vector<std::uint32_t> indicesOf(const Json& object, const char* key,
                                       const std::string& what) {
    std::vector<std::uint32_t> indices;
    const Json* const values = gltf::find(object, key);
    if (values && !values->is_array()) fault('"' + std::string(key) + "\" is not an array");
    if (!values || !values->is_array()) return indices;
    for (const Json& value : *values)
      if (const auto index = whole(Json{{key, value}}, key, what)) indices.push_back(*index);
    return indices;
  }

  void readNode(std::uint32_t number, NodePath path, int depth) {
    scene_.visit(depth, 0);  // each node has one parent
    const std::string what = "node " + std::to_string(number);
    const Json* const found = elementOf("nodes", number, "a node or scene");
    if (!found) return faults_.throwIfAny();
    const Json& node = *found;
    if (!read_.insert(number).second) fault(what + " is in the scene twice");
    check(node, what,
          {"camera", "children", "matrix", "mesh", "rotation", "scale", "skin", "translation",
           "weights"});
    if (gltf::find(node, "skin"))
      fault(
          "a node has a skin, whose joints move its vertices, which is not supported; save the "
          "mesh in its pose, without a skin");
    checkWeights(node);
    path = path.below(transformOf(node, what));
    faults_.throwIfAny();
    if (referred(node, "mesh", "meshes", what))
      scene_.add(partOf(*whole(node, "mesh", what)), path);
    faults_.throwIfAny();
    for (const std::uint32_t child : indicesOf(node, "children", what))
      readNode(child, path, depth + 1);
  }

  void checkWeights(const Json& object) {
    const Json& weights = member(object, "weights");
    if (weights.is_array() &&
        std::any_of(weights.begin(), weights.end(), [](const Json& w) { return w != 0; }))
      fault(
          "morph targets have weights other than 0, which is not supported; save the mesh in its "
          "shape, without morph targets");
  }

  Eigen::Affine3d transformOf(const Json& node, const std::string& what) {
    Eigen::Affine3d step = Eigen::Affine3d::Identity();
    const auto matrix = gltf::numbers(node, "matrix", 16, what, faults_);
    const auto t = gltf::numbers(node, "translation", 3, what, faults_);
    const auto r = gltf::numbers(node, "rotation", 4, what, faults_);
    const auto s = gltf::numbers(node, "scale", 3, what, faults_);
    if (matrix) {
      if (t || r || s) fault(what + " has a matrix and another transform; keep one");
      step.matrix() = Eigen::Map<const Eigen::Matrix4d>(matrix->data());  // column by column
      if (step(3, 0) != 0 || step(3, 1) != 0 || step(3, 2) != 0 || step(3, 3) != 1)
        fault("the last row of the matrix of " + what + " is not 0 0 0 1, which is not supported");
    }
    if (t) step.translation() = Eigen::Map<const Vec3>(t->data());
    if (r) {
      const Eigen::Quaterniond q((*r)[3], (*r)[0], (*r)[1], (*r)[2]);
      if (!(std::abs(q.norm() - 1) < 1e-3))
        fault("the rotation of " + what + " is not of length 1; write a unit quaternion");
      else if (std::abs(q.norm() - 1) > 1e-5)
        scene_.note("a rotation whose length is not quite 1 is normalised");
      step.linear() = q.normalized().toRotationMatrix();
    }
    if (s) step.linear() = step.linear() * Eigen::Map<const Vec3>(s->data()).asDiagonal();
    return step;
  }

  const ScenePart& partOf(std::uint32_t number) {
    std::optional<ScenePart>& part = parts_[number];
    if (part) return *part;
    part.emplace();
    const Json& mesh = member(root_, "meshes")[number];
    const std::string what = "mesh " + std::to_string(number);
    check(mesh, what, {"primitives", "weights"});
    checkWeights(mesh);
    if (!member(mesh, "primitives").is_array()) fault(what + " has no array of primitives");
    for (const Json& primitive : member(mesh, "primitives")) {
      check(primitive, "a primitive of " + what,
            {"attributes", "indices", "material", "mode", "targets"});
      faults_.throwIfAny();
      readPrimitive(primitive, what, *part);
    }
    faults_.throwIfAny();
    return *part;
  }

  void readPrimitive(const Json& primitive, const std::string& what, ScenePart& part) {
    const std::uint32_t mode = whole(primitive, "mode", what).value_or(4);
    if (mode > 6)
      return fault("the mode of a primitive is " + std::to_string(mode) + "; 0 to 6 is needed");
    if (mode < 4) return scene_.note(kNoteOnLines);
    const Json& attributes = member(primitive, "attributes");
    if (!attributes.is_object()) return fault("a primitive of " + what + " has no attributes");
    for (const auto& entry : attributes.items())
      if (entry.key() != "POSITION" && lowered(entry.key()) == "position")
        fault("the key " + inQuotes(entry.key()) + " is not read; write \"POSITION\"");
    const Json* const position = referred(attributes, "POSITION", "accessors", what);
    if (!position) return scene_.note("a primitive without positions is not read");
    const auto first = static_cast<std::uint32_t>(part.vertices.size());
    readPositions(*position, part);
    const auto count = static_cast<std::uint32_t>(part.vertices.size()) - first;
    std::vector<std::uint32_t> corners(count);
    for (std::uint32_t i = 0; i < count; ++i) corners[i] = i;
    if (const Json* const indices = referred(primitive, "indices", "accessors", what))
      corners = readIndices(*indices);
    faults_.throwIfAny();
    for (std::uint32_t& corner : corners) {
      if (corner >= count)
        return fault("the indices of " + what + " name vertex " + std::to_string(corner) +
                     " (from 0), and there are " + std::to_string(count));
      corner += first;
    }
    if (mode == 4 && corners.size() % 3 != 0)
      fault("a primitive of triangles in " + what + " has " + std::to_string(corners.size()) +
            " corners, which is no multiple of 3");
    for (std::size_t i = 2; i < corners.size(); i += mode == 4 ? 3 : 1) {
      const std::uint32_t a = corners[mode == 6 ? 0 : i - 2], b = corners[i - 1], c = corners[i];
      if (mode == 5 && i % 2 != 0)  // every second triangle of a strip is turned over
        part.addFace({b, a, c}, 0);
      else
        part.addFace({a, b, c}, 0);
    }
    faults_.requireFew(part.faces.size(), "triangles", 0);
  }

  /// Elements of an accessor, or of a part of one, in memory.
  struct Elements {
    const char* first = nullptr;
    std::uint64_t stride = 0;
  };

  static std::uint64_t bytesOf(std::uint32_t type) {
    return type == 5120 || type == 5121 ? 1 : type == 5122 || type == 5123 ? 2 : 4;
  }

  /// Returns where `count` elements of `size` bytes are. Adds a fault, and returns null, if they
  /// are not all in their view and its buffer.
  Elements elements(const Json& part, std::uint64_t count, std::uint64_t size,
                    const std::string& what) {
    const Json* const view = referred(part, "bufferView", "bufferViews", what);
    if (!view) return {};
    check(*view, "a bufferView", {"buffer", "byteLength", "byteOffset", "byteStride", "target"});
    const auto number = whole(*view, "buffer", "a bufferView");
    const auto length = whole(*view, "byteLength", "a bufferView");
    if (!number || !length) {
      fault("a bufferView has no buffer or no byteLength");
      return {};
    }
    const std::string* const bytes = buffer(*number);
    const std::uint64_t start = whole(*view, "byteOffset", "a bufferView").value_or(0);
    const std::uint64_t own = whole(part, "byteOffset", what).value_or(0);
    const std::uint64_t stride =
        whole(*view, "byteStride", "a bufferView").value_or(static_cast<std::uint32_t>(size));
    if (!bytes) return {};
    if (stride < size) {
      fault("the byteStride of " + what + " is " + std::to_string(stride) + "; at least " +
            std::to_string(size) + " is needed");
      return {};
    }
    // All numbers are below 2^31, so that nothing overflows.
    if (count > 0 && own + stride * (count - 1) + size > *length) {
      fault("the elements of " + what +
            " lie beyond the byteLength of their bufferView; correct count, byteOffset or "
            "byteLength");
      return {};
    }
    if (start + *length > bytes->size()) {
      fault("the bufferView of " + what +
            " lies beyond the byteLength of its buffer; correct its byteOffset or byteLength");
      return {};
    }
    return {bytes->data() + start + own, stride};
  }

  /// Returns the bytes of a buffer; null, after a fault, if it can't be read.
  const std::string* buffer(std::uint32_t number) {
    if (const auto known = buffers_.find(number); known != buffers_.end()) return &known->second;
    const Json* const found = elementOf("buffers", number, "a bufferView");
    if (!found) return nullptr;
    const std::string what = "buffer " + std::to_string(number);
    check(*found, what, {"byteLength", "uri"});
    const auto length = whole(*found, "byteLength", what);
    if (!length) {
      fault(what + " has no byteLength");
      return nullptr;
    }
    std::string bytes;
    const Json& uri = member(*found, "uri");
    if (uri.is_null()) {
      if (!chunk_ || number != 0) {
        fault(what + " has no uri");
        return nullptr;
      }
      bytes = *chunk_;
    } else if (!uri.is_string()) {
      fault("the uri of " + what + " is no text");
      return nullptr;
    } else {
      bytes = contentsOf(uri.get<std::string>(), what);
      faults_.throwIfAny();
    }
    if (bytes.size() < *length) {
      fault(what + " has " + std::to_string(bytes.size()) + " bytes, and its byteLength is " +
            std::to_string(*length));
      return nullptr;
    }
    bytes.resize(*length);
    return &(buffers_[number] = std::move(bytes));
  }

  std::string contentsOf(const std::string& uri, const std::string& what) {
    if (uri.starts_with("data:")) {
      const auto comma = uri.find(',');
      if (comma == uri.npos || !std::string_view(uri).substr(0, comma).ends_with(";base64")) {
        fault("the data of a buffer are not in Base64");
        return {};
      }
      auto bytes = gltf::fromBase64(std::string_view(uri).substr(comma + 1));
      if (!bytes)
        fault(
            "the data of a buffer are no Base64: A to Z, a to z, 0 to 9, + and /, four characters "
            "for three bytes, with = at the end");
      return std::move(bytes).value_or("");
    }
    if (uri.size() > 4096) {
      fault("the name of the file of " + what + " is longer than 4096 characters");
      return {};
    }
    // By the format, the name is encoded. Some programs write it as it is.
    const std::filesystem::path folder = std::filesystem::path(file_).parent_path();
    std::filesystem::path path = folder / decoded(uri);
    if (std::error_code error; !std::filesystem::exists(path, error)) path = folder / uri;
    if (const std::string why = whyNotOrdinaryFile(path); !why.empty()) {
      fault("the file " + inQuotes(uri) + " of " + what + ": " + why);
      return {};
    }
    otherFiles_.push_back(path.string());
    return readFile(path, "a buffer of a glTF file", kMostBytes);
  }

  /// Checks an accessor's keys and type, and returns its number of elements.
  std::uint32_t checkAccessor(const Json& accessor, const char* type, const std::string& what) {
    check(accessor, what,
          {"bufferView", "byteOffset", "componentType", "count", "max", "min", "normalized",
           "sparse", "type"});
    if (member(accessor, "type") != type)
      fault(what + " is of type " + member(accessor, "type").dump().substr(0, 32) + ", and " +
            type + " is needed");
    if (member(accessor, "normalized") == true) fault(what + " may not be normalized");
    const auto count = whole(accessor, "count", what);
    if (!count) fault(what + " has no count");
    if (!gltf::find(accessor, "bufferView") && gltf::find(accessor, "byteOffset"))
      fault(what + " has a byteOffset without a bufferView");
    faults_.requireFew(count.value_or(0), "vertices", 0);
    faults_.throwIfAny();
    return *count;
  }

  /// Calls take(i, data) for each element of an accessor that is stored, and then for each that a
  /// sparse accessor replaces. Elements that are not stored are 0.
  template <class Take>
  void forElements(const Json& accessor, std::uint32_t count, std::uint64_t size,
                   const std::string& what, const Take& take) {
    if (gltf::find(accessor, "bufferView")) {
      const Elements stored = elements(accessor, count, size, what);
      faults_.throwIfAny();
      for (std::uint32_t i = 0; i < count; ++i) take(i, stored.first + stored.stride * i);
    }
    const Json* const sparse = gltf::find(accessor, "sparse");
    if (!sparse) return;
    check(*sparse, "\"sparse\" of " + what, {"count", "indices", "values"});
    const Json &indices = member(*sparse, "indices"), &values = member(*sparse, "values");
    check(indices, "the sparse indices of " + what, {"bufferView", "byteOffset", "componentType"});
    check(values, "the sparse values of " + what, {"bufferView", "byteOffset"});
    faults_.throwIfAny();
    const auto replaced = whole(*sparse, "count", "\"sparse\" of " + what);
    const auto type = whole(indices, "componentType", "the sparse indices of " + what);
    if (!replaced || !type || (*type != 5121 && *type != 5123 && *type != 5125) ||
        !gltf::find(indices, "bufferView") || !gltf::find(values, "bufferView"))
      return fault("\"sparse\" of " + what +
                   " needs a count, indices of an unsigned type, and values");
    const Elements places =
        elements(indices, *replaced, bytesOf(*type), "the sparse indices of " + what);
    const Elements data = elements(values, *replaced, size, "the sparse values of " + what);
    faults_.throwIfAny();
    std::optional<std::uint32_t> last;
    for (std::uint32_t i = 0; i < *replaced; ++i) {
      const std::uint32_t place = unsignedAt(places.first + places.stride * i, *type);
      if (last && place <= *last)
        return fault("the sparse indices of " + what + " do not increase");
      last = place;
      if (place >= count) return fault("a sparse index of " + what + " is beyond its count");
      take(place, data.first + data.stride * i);
    }
  }

  static std::uint32_t unsignedAt(const char* at, std::uint32_t type) {
    std::uint32_t value =
        0;  // glTF is little-endian, as the processors are for which this is built
    std::memcpy(&value, at, bytesOf(type));
    return value;
  }

  void readPositions(const Json& accessor, ScenePart& part) {
    const std::string what = "an accessor of POSITION";
    if (member(accessor, "componentType") != 5126)
      fault("positions are not stored as floats, which is not supported; save them as floats");
    const std::uint32_t count = checkAccessor(accessor, "VEC3", what);
    if (!gltf::find(accessor, "bufferView") && (unstored_ += count) > 1'000'000)
      return fault(what + " brings the elements without a bufferView to more than 10^6");
    if (gltf::find(accessor, "bufferView")) elements(accessor, count, 12, what);
    faults_.throwIfAny();  // before there is memory for so many
    const std::size_t first = part.vertices.size();
    part.vertices.resize(first + count, Vec3::Zero());
    faults_.requireFew(part.vertices.size(), "vertices", 0);
    forElements(accessor, count, 12, what, [&](std::uint32_t i, const char* at) {
      float xyz[3];
      std::memcpy(xyz, at, sizeof xyz);
      part.vertices[first + i] = {xyz[0], xyz[1], xyz[2]};
    });
  }

  std::vector<std::uint32_t> readIndices(const Json& accessor) {
    const std::string what = "an accessor of indices";
    const auto type = whole(accessor, "componentType", what);
    if (!type || (*type != 5121 && *type != 5123 && *type != 5125)) {
      fault("indices are not of an unsigned type");
      return {};
    }
    if (!gltf::find(accessor, "bufferView")) {
      fault(what + " has no bufferView");
      return {};
    }
    const std::uint32_t count = checkAccessor(accessor, "SCALAR", what);
    elements(accessor, count, bytesOf(*type), what);
    faults_.throwIfAny();  // before there is memory for so many
    std::vector<std::uint32_t> indices(count, 0);
    forElements(accessor, count, bytesOf(*type), what,
                [&](std::uint32_t i, const char* at) { indices[i] = unsignedAt(at, *type); });
    // It would restart a strip in some programs, and is forbidden.
    const std::uint32_t greatest = *type == 5121 ? 0xFF : *type == 5123 ? 0xFFFF : 0xFFFFFFFF;
    if (std::ranges::count(indices, greatest) > 0)
      fault(what + " has the greatest index of its type, which glTF forbids");
    return indices;
  }

  const std::string& file_;
  const Json& root_;
  std::optional<std::string_view> chunk_;  ///< the binary chunk of a GLB file
  MeshFaults& faults_;
  SceneMesh scene_;
  std::vector<std::string> notes_, otherFiles_;
  std::vector<std::optional<ScenePart>> parts_;  ///< of each mesh that was read
  std::map<std::uint32_t, std::string> buffers_;
  std::uint64_t unstored_ = 0;    ///< positions without a bufferView
  std::set<std::uint32_t> read_;  ///< the nodes that were read
};

}  // namespace

ReadMesh readGltf(const std::string& file, std::string_view json, MeshFaults& faults) {
  const Json root = gltf::parse(json, faults);
  return GltfReader(file, root, std::nullopt, faults).read();
}

ReadMesh readGlb(const std::string& file, std::string_view bytes, MeshFaults& faults) {
  // The word "glTF", the version, the size of the file; then chunks: size, kind, data.
  const auto wordAt = [&](std::size_t at) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    return word;
  };
  if (!bytes.starts_with("glTF"))
    faults.fail(0, "a GLB file begins with the word glTF; save the file again");
  if (bytes.size() < 20) faults.fail(0, "the GLB file is truncated: it ends within its header");
  if (const std::uint32_t version = wordAt(4); version != 2)
    faults.fail(0, "binary glTF " + std::to_string(version) +
                       " is not supported; save the mesh as glTF 2.0");
  if (wordAt(8) != bytes.size())
    faults.fail(0, "the GLB file has " + std::to_string(bytes.size()) +
                       " bytes, and its header says " + std::to_string(wordAt(8)) +
                       "; it is truncated, or something follows it");
  std::optional<std::string_view> json, chunk;
  for (std::size_t at = 12; at < bytes.size();) {
    if (bytes.size() - at < 8 || bytes.size() - at - 8 < wordAt(at))
      faults.fail(0, "a chunk of the GLB file is truncated");
    const std::string_view kind = bytes.substr(at + 4, 4);
    const std::string_view data = bytes.substr(at + 8, wordAt(at));
    if (!json && kind != "JSON")
      faults.fail(0, "the first chunk of a GLB file must be JSON; save the file again");
    if (!json)
      json = data;
    else if (kind == std::string_view("BIN\0", 4) && !chunk)
      chunk = data;
    else if (kind == "JSON" || kind == std::string_view("BIN\0", 4))
      faults.fail(0, "a GLB file has two chunks of one kind");
    at += 8 + data.size();
  }
  const Json root = gltf::parse(*json, faults);
  return GltfReader(file, root, chunk, faults).read();
}

}  // namespace corridor
