// Reads Collada 1.4 and 1.5 (Khronos, COLLADA - Digital Asset Schema Release 1.4.1 and 1.5.0): the
// geometry of the scene, under the transforms of its nodes.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "collision/core/rounding.h"
#include "collision/core/spelling.h"
#include "collision/geometry/collada_mesh.h"
#include "collision/geometry/mesh_readers.h"

namespace corridor {
namespace {

using xml::childrenOf;
using xml::Element;
using xml::nameOf;
using xml::onlyChild;

class ColladaReader {
 public:
  ColladaReader(const Element& root, MeshFaults& faults)
      : root_(root), faults_(faults), document_(faults), scene_(faults) {}

  ReadMesh read() {
    if (const auto version = xml::attribute(root_, "version");
        version && !version->starts_with("1.4") && !version->starts_with("1.5"))
      document_.fault(root_, "Collada " + printable(*version) +
                                 " is not supported; save the mesh as Collada 1.4 or 1.5");
    xml::requireNoText(root_, faults_);
    for (const Element* child = root_.FirstChildElement(); child;
         child = child->NextSiblingElement()) {
      if (const std::string_view name = nameOf(*child);
          !name.starts_with("library_") && name != "asset" && name != "scene" && name != "extra")
        document_.fault(*child, "<" + printable(name) +
                                    "> is not known in <COLLADA>; correct its name, or remove it");
      xml::requireNamespace(*child, faults_);
    }
    document_.readAsset(root_);
    findIds();
    faults_.throwIfAny();
    readScene();
    for (const Element* library : childrenOf(root_, "library_geometries"))
      for (const Element* geometry : childrenOf(*library, "geometry"))
        if (!parts_.contains(geometry))
          document_.note("the geometry" + named(*geometry) +
                         " is in no node of the scene and not read");
    for (const Element* library : childrenOf(root_, "library_nodes"))
      for (const Element* node : childrenOf(*library, "node"))
        if (!read_.contains(node) && hasDescendant(*node, "instance_geometry"))
          document_.note("the node" + named(*node) +
                         " of <library_nodes> is in no node of the "
                         "scene and not read");
    for (const char* const library : {"library_animations", "library_animation_clips"})
      if (const Element* const animations = root_.FirstChildElement(library);
          animations && hasDescendant(*animations, "channel"))
        document_.note("animations are not applied: the mesh is read in its resting pose");
    for (const Element* models : childrenOf(root_, "library_physics_models"))
      if (hasDescendant(*models, "shape"))
        document_.note("the shapes of physics models are not read");
    for (const std::string& text : document_.notes()) scene_.note(text);
    ReadMesh read = scene_.take("Collada");
    read.fileUnit = document_.asset().metres;
    read.up = document_.asset().up;
    return read;
  }

 private:
  /// The elements of a kind by their ids; null for an id that several have.
  using Ids = std::map<std::string_view, const Element*>;

  /// The id of an element in messages: " \"id\"", or "" without one.
  static std::string named(const Element& element) {
    const auto id = xml::attribute(element, "id");
    return id ? ' ' + inQuotes(*id) : std::string();
  }
  static bool hasDescendant(const Element& element, std::string_view name) {
    for (const Element* child = element.FirstChildElement(); child;
         child = child->NextSiblingElement())
      if (nameOf(*child) == name || hasDescendant(*child, name)) return true;
    return false;
  }

  void add(Ids& ids, const Element& element) {
    const auto id = xml::attribute(element, "id");
    if (id && !ids.try_emplace(*id, &element).second) ids[*id] = nullptr;
  }
  void addNodes(const Element& parent) {
    for (const Element* node : childrenOf(parent, "node")) {
      add(nodes_, *node);
      document_.checkAsset(*node);
      addNodes(*node);
    }
  }
  void findIds() {
    for (const Element* library : childrenOf(root_, "library_geometries")) {
      document_.check(*library, {"asset", "geometry"}, {"id", "name"});
      document_.checkAsset(*library);
      for (const Element* geometry : childrenOf(*library, "geometry")) add(geometries_, *geometry);
    }
    for (const Element* library : childrenOf(root_, "library_nodes")) {
      document_.check(*library, {"asset", "node"}, {"id", "name"});
      document_.checkAsset(*library);
      addNodes(*library);
    }
    for (const Element* library : childrenOf(root_, "library_visual_scenes")) {
      document_.check(*library, {"asset", "visual_scene"}, {"id", "name"});
      document_.checkAsset(*library);
      for (const Element* scene : childrenOf(*library, "visual_scene")) {
        add(scenes_, *scene);
        document_.checkAsset(*scene);
        addNodes(*scene);
      }
    }
  }

  /// Returns the element to which an instance refers. Adds a fault and returns null if there is
  /// none in this document.
  const Element* target(const Element& instance, const Ids& ids) {
    const std::string_view url = xml::required(instance, "url", faults_);
    const auto found = ids.find(url.substr(url.starts_with('#')));
    if (url.starts_with('#') && found != ids.end() && !found->second)
      document_.fault(instance, "two elements have the id " + inQuotes(found->first) +
                                    ", to which this element refers; give each an id of its own");
    if (url.starts_with('#') && found != ids.end()) return found->second;
    if (xml::attribute(instance, "url"))
      document_.fault(instance,
                      "<" + printable(instance.Name()) + "> refers to " + inQuotes(url) +
                          ", which is not in this file; correct it, or save the mesh as one file");
    return nullptr;
  }

  void readScene() {
    const Element* const scene = onlyChild(root_, "scene", faults_);
    if (!scene) return faults_.fail(0, "has no <scene>; save the mesh as part of a scene");
    document_.check(
        *scene, {"instance_visual_scene", "instance_physics_scene", "instance_kinematics_scene"},
        {});
    if (hasDescendant(*scene, "bind_joint_axis"))
      document_.fault(
          *scene,
          "the kinematics scene sets joints, which may move nodes and is not supported; "
          "save the mesh in its pose");
    const Element* const instance = onlyChild(*scene, "instance_visual_scene", faults_);
    if (!instance)
      return faults_.fail(scene->GetLineNum(), "<scene> has no <instance_visual_scene>");
    document_.check(*instance, {}, {"url", "name", "sid"});
    const Element* const visual = target(*instance, scenes_);
    if (!visual) return;
    for (const Element* library : childrenOf(root_, "library_visual_scenes"))
      for (const Element* other : childrenOf(*library, "visual_scene"))
        if (other != visual && hasDescendant(*other, "node"))
          document_.note("the visual scene" + named(*other) +
                         " is not the one that <scene> names and not read");
    document_.check(*visual, {"asset", "node", "evaluate_scene"}, {"id", "name"});
    for (const Element* node : childrenOf(*visual, "node")) readNode(*node, {}, 1);
  }

  void readNode(const Element& node, NodePath path, int depth) {
    read_.insert(&node);
    scene_.visit(depth, xml::childCount(node));
    document_.check(node,
                    {"asset", "matrix", "rotate", "scale", "translate", "instance_camera",
                     "instance_light", "instance_geometry", "instance_node", "node"},
                    {"id", "name", "sid", "type", "layer"});
    faults_.throwIfAny();
    // Transforms come before all else in a valid file, and apply to all of the node.
    for (const Element* child = node.FirstChildElement(); child;
         child = child->NextSiblingElement())
      if (const auto step = transformOf(*child)) path = path.below(step->map, step->turn);
    for (const Element* child = node.FirstChildElement(); child;
         child = child->NextSiblingElement()) {
      const std::string_view name = nameOf(*child);
      if (name == "node") readNode(*child, path, depth + 1);
      if (name == "instance_node") {
        document_.check(*child, {}, {"url", "name", "sid", "proxy"});
        if (const Element* const other = target(*child, nodes_)) readNode(*other, path, depth + 1);
      }
      if (name == "instance_geometry") {
        document_.check(*child, {"bind_material"}, {"url", "name", "sid"});
        if (const Element* const geometry = target(*child, geometries_))
          scene_.add(partOf(*geometry), path);
      }
    }
    faults_.throwIfAny();
  }

  struct Step {
    Eigen::Affine3d map = Eigen::Affine3d::Identity();
    double turn = 0;  ///< error of the angle by the rounding of its decimal number, radians
  };
  /// Returns the transform that an element of a node is; nullopt for other elements.
  std::optional<Step> transformOf(const Element& element) {
    const std::string_view name = nameOf(element);
    const std::size_t size = name == "matrix"                         ? 16
                             : name == "rotate"                       ? 4
                             : name == "translate" || name == "scale" ? 3
                                                                      : 0;
    if (size == 0) return std::nullopt;
    document_.check(element, {}, {"sid"});
    const std::string place = "<" + std::string(name) + ">";
    const std::vector<double> numbers =
        xml::numbersIn(xml::textOf(element, faults_), place, element.GetLineNum(), faults_);
    Step result;
    Eigen::Affine3d& step = result.map;
    if (numbers.size() != size) {
      document_.fault(element, place + " needs " + std::to_string(size) + " decimal numbers");
    } else if (name == "translate") {
      step.translation() = Eigen::Map<const Vec3>(numbers.data());
    } else if (name == "scale") {
      step.linear() = Eigen::Map<const Vec3>(numbers.data()).asDiagonal();
    } else if (name == "rotate") {
      const Vec3 axis = Eigen::Map<const Vec3>(numbers.data()).stableNormalized();
      const double angle = std::fmod(numbers[3], 360) * (M_PI / 180);
      if (std::abs(numbers[3]) > 1e6)  // so that its rounding turns no mesh
        document_.fault(element,
                        "the angle of <rotate> is beyond 1e6 degrees; write it within 360");
      if (!(axis.squaredNorm() > 0.5) && angle != 0)
        document_.fault(element, "the axis of <rotate> is 0");
      result.turn = kUnit * std::abs(numbers[3]) * (M_PI / 180);
      if (angle != 0 && axis.squaredNorm() > 0.5)
        step.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    } else {
      const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> m(numbers.data());
      if (m(3, 0) != 0 || m(3, 1) != 0 || m(3, 2) != 0 || m(3, 3) != 1)
        document_.fault(element,
                        "the last row of a <matrix> is not 0 0 0 1, which is not supported");
      step.matrix() = m;
    }
    return result;
  }

  const ScenePart& partOf(const Element& geometry) {
    const auto [entry, isNew] = parts_.try_emplace(&geometry);
    if (!isNew) return entry->second;
    document_.check(geometry, {"asset", "mesh"}, {"id", "name"});
    document_.checkAsset(geometry);
    if (const Element* const mesh = onlyChild(geometry, "mesh", faults_))
      readColladaMesh(*mesh, document_, entry->second);
    else
      document_.fault(geometry, "the <geometry> has no <mesh>");
    faults_.throwIfAny();
    return entry->second;
  }

  const Element& root_;
  MeshFaults& faults_;
  ColladaDocument document_;
  SceneMesh scene_;
  Ids geometries_, nodes_, scenes_;
  std::map<const Element*, ScenePart> parts_;
  std::set<const Element*> read_;  // nodes
};

}  // namespace

ReadMesh readCollada(std::string_view text, MeshFaults& faults) {
  tinyxml2::XMLDocument document;
  return ColladaReader(xml::parse(document, text, "COLLADA", faults), faults).read();
}

}  // namespace corridor
