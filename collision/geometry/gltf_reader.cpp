// Reads glTF 2.0 (Khronos, glTF 2.0 Specification, ISO/IEC 12113:2022): the triangles of the
// default scene, under the transforms of its nodes.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "collision/core/spelling.h"
#include "collision/geometry/gltf_data.h"
#include "collision/geometry/mesh_readers.h"
#include "collision/geometry/scene_mesh.h"

namespace corridor {
namespace {

using gltf::Json;
using gltf::member;

class GltfReader {
 public:
  GltfReader(const std::string& file, const Json& root, std::optional<std::string_view> chunk,
             MeshFaults& faults)
      : root_(root),
        faults_(faults),
        document_(root, faults),
        data_(document_, file, chunk),
        scene_(faults) {}

  ReadMesh read() {
    checkVersion();
    document_.check(root_, "the file",
                    {"asset", "accessors", "animations", "bufferViews", "buffers", "cameras",
                     "extensionsRequired", "extensionsUsed", "images", "materials", "meshes",
                     "nodes", "samplers", "scene", "scenes", "skins", "textures"});
    for (const char* const list :
         {"accessors", "bufferViews", "buffers", "meshes", "nodes", "scenes"})
      if (const Json* const value = gltf::find(root_, list); value && !value->is_array())
        document_.fault('"' + std::string(list) + "\" is not an array");
    document_.checkExtensions();
    faults_.throwIfAny();
    if (!member(root_, "animations").empty())
      document_.note("animations are not applied: the mesh is read in its resting pose");
    parts_.resize(member(root_, "meshes").size());
    readScene();
    for (const std::string& text : document_.notes()) scene_.note(text);
    ReadMesh read = scene_.take("glTF 2.0");
    read.fileUnit = 1;
    read.up = 'y';
    read.otherFiles = data_.otherFiles();
    return read;
  }

 private:
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
    const auto number = document_.whole(root_, "scene", "the file");
    const Json* const scene = document_.elementOf("scenes", number.value_or(0), "the file");
    if (!scene) return;
    document_.check(*scene, "a scene", {"nodes"});
    const Json& nodes = member(root_, "nodes");
    std::set<std::uint32_t> children;
    for (const Json& node : nodes)
      for (const std::uint32_t child : document_.wholes(node, "children", "a node"))
        if (!children.insert(child).second) document_.fault("a node is the child of two nodes");
    faults_.throwIfAny();
    for (const std::uint32_t root : document_.wholes(*scene, "nodes", "a scene")) {
      if (children.contains(root))
        document_.fault(
            "a node is in a scene and the child of a node; a scene may name root nodes only");
      faults_.throwIfAny();
      readNode(root, {}, 1);
    }
    for (std::uint32_t i = 0; i < nodes.size(); ++i)
      if (!read_.contains(i) && !member(nodes[i], "mesh").is_null())
        scene_.note("node " + std::to_string(i) + " has a mesh, but is not in the default scene, " +
                    "and not read");
    std::set<std::uint64_t> placed;
    for (const Json& node : nodes)
      if (const auto mesh = document_.whole(node, "mesh", "a node")) placed.insert(*mesh);
    for (std::uint32_t i = 0; i < parts_.size(); ++i)
      if (!placed.contains(i))
        scene_.note("mesh " + std::to_string(i) + " is in no node, and not read");
  }

  void readNode(std::uint32_t number, NodePath path, int depth) {
    scene_.visit(depth, 0);  // each node has one parent
    const std::string what = "node " + std::to_string(number);
    const Json* const found = document_.elementOf("nodes", number, "a node or scene");
    if (!found) return faults_.throwIfAny();
    const Json& node = *found;
    if (!read_.insert(number).second) document_.fault(what + " is in the scene twice");
    document_.check(node, what,
                    {"camera", "children", "matrix", "mesh", "rotation", "scale", "skin",
                     "translation", "weights"});
    if (gltf::find(node, "skin"))
      document_.fault(
          "a node has a skin, whose joints move its vertices, which is not supported; save the "
          "mesh in its pose, without a skin");
    checkWeights(node);
    path = path.below(transformOf(node, what));
    faults_.throwIfAny();
    if (document_.referred(node, "mesh", "meshes", what))
      scene_.add(partOf(*document_.whole(node, "mesh", what)), path);
    faults_.throwIfAny();
    for (const std::uint32_t child : document_.wholes(node, "children", what))
      readNode(child, path, depth + 1);
  }

  void checkWeights(const Json& object) {
    const Json& weights = member(object, "weights");
    if (!weights.is_null() && !weights.is_array()) document_.fault("\"weights\" is not an array");
    if (weights.is_array() && std::ranges::any_of(weights, [](const Json& w) { return w != 0; }))
      document_.fault(
          "morph targets have weights other than 0, which is not supported; save the mesh in its "
          "shape, without morph targets");
  }

  Eigen::Affine3d transformOf(const Json& node, const std::string& what) {
    Eigen::Affine3d step = Eigen::Affine3d::Identity();
    const auto matrix = document_.numbers(node, "matrix", 16, what);
    const auto t = document_.numbers(node, "translation", 3, what);
    const auto r = document_.numbers(node, "rotation", 4, what);
    const auto s = document_.numbers(node, "scale", 3, what);
    if (matrix) {
      if (t || r || s) document_.fault(what + " has a matrix and another transform; keep one");
      step.matrix() = Eigen::Map<const Eigen::Matrix4d>(matrix->data());  // column by column
      if (step(3, 0) != 0 || step(3, 1) != 0 || step(3, 2) != 0 || step(3, 3) != 1)
        document_.fault("the last row of the matrix of " + what +
                        " is not 0 0 0 1, which is not supported");
    }
    if (t) step.translation() = Eigen::Map<const Vec3>(t->data());
    if (r) {
      const Eigen::Quaterniond q((*r)[3], (*r)[0], (*r)[1], (*r)[2]);
      if (!(std::abs(q.norm() - 1) < 1e-3))
        document_.fault("the rotation of " + what + " is not of length 1; write a unit quaternion");
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
    document_.check(mesh, what, {"primitives", "weights"});
    checkWeights(mesh);
    if (!member(mesh, "primitives").is_array())
      document_.fault(what + " has no array of primitives");
    for (const Json& primitive : member(mesh, "primitives")) {
      document_.check(primitive, "a primitive of " + what,
                      {"attributes", "indices", "material", "mode", "targets"});
      faults_.throwIfAny();
      readPrimitive(primitive, what, *part);
    }
    faults_.throwIfAny();
    return *part;
  }

  void readPrimitive(const Json& primitive, const std::string& what, ScenePart& part) {
    const std::uint32_t mode = document_.whole(primitive, "mode", what).value_or(4);
    if (mode > 6)
      return document_.fault("the mode of a primitive is " + std::to_string(mode) +
                             "; 0 to 6 is needed");
    if (mode < 4) return scene_.note(kNoteOnLines);
    const Json& attributes = member(primitive, "attributes");
    if (!attributes.is_object())
      return document_.fault("a primitive of " + what + " has no attributes");
    for (const auto& entry : attributes.items())
      if (entry.key() != "POSITION" && lowered(entry.key()) == "position")
        document_.fault("the key " + inQuotes(entry.key()) + " is not read; write \"POSITION\"");
    const Json* const position = document_.referred(attributes, "POSITION", "accessors", what);
    if (!position) return scene_.note("a primitive without positions is not read");
    const auto first = static_cast<std::uint32_t>(part.vertices.size());
    data_.readPositions(*position, part.vertices);
    const auto count = static_cast<std::uint32_t>(part.vertices.size()) - first;
    std::vector<std::uint32_t> corners(count);
    for (std::uint32_t i = 0; i < count; ++i) corners[i] = i;
    if (const Json* const indices = document_.referred(primitive, "indices", "accessors", what))
      corners = data_.readIndices(*indices);
    faults_.throwIfAny();
    for (std::uint32_t& corner : corners) {
      if (corner >= count)
        return document_.fault("the indices of " + what + " name vertex " + std::to_string(corner) +
                               " (from 0), and there are " + std::to_string(count));
      corner += first;
    }
    if (mode == 4 && corners.size() % 3 != 0)
      document_.fault("a primitive of triangles in " + what + " has " +
                      std::to_string(corners.size()) + " corners, which is no multiple of 3");
    for (std::size_t i = 2; i < corners.size(); i += mode == 4 ? 3 : 1) {
      const std::uint32_t a = corners[mode == 6 ? 0 : i - 2], b = corners[i - 1], c = corners[i];
      if (mode == 5 && i % 2 != 0)  // every second triangle of a strip is turned over
        part.addFace({b, a, c}, 0);
      else
        part.addFace({a, b, c}, 0);
    }
    faults_.requireFew(part.faces.size(), "triangles", 0);
  }

  const Json& root_;
  MeshFaults& faults_;
  gltf::Document document_;
  gltf::Data data_;
  SceneMesh scene_;
  std::vector<std::optional<ScenePart>> parts_;  ///< of each mesh that was read
  std::set<std::uint32_t> read_;                 ///< the nodes that were read
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
