// Reads Collada 1.4 and 1.5 (Khronos, COLLADA - Digital Asset Schema Release 1.4.1 and 1.5.0): the
// geometry of the scene, under the transforms of its nodes.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "collision/core/spelling.h"
#include "collision/geometry/column_names.h"
#include "collision/geometry/mesh_readers.h"
#include "collision/geometry/scene_mesh.h"
#include "collision/geometry/stated_unit.h"
#include "collision/geometry/xml_tree.h"

namespace corridor {
namespace {

using xml::childrenOf;
using xml::Element;
using xml::nameOf;
using xml::onlyChild;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

std::string withoutPrefix(const std::string& name) {
  return name.substr(name.rfind(':') + 1);
}

/// What an <asset> says. It holds for the element around it.
struct Asset {
  double metres = 1;
  char up = 'y';
  bool operator==(const Asset&) const = default;
};

class ColladaReader {
 public:
  ColladaReader(const Element& root, MeshFaults& faults)
      : root_(root), faults_(faults), scene_(faults) {}

  ReadMesh read() {
    for (const Element* child = root_.FirstChildElement(); child;
         child = child->NextSiblingElement())
      if (const std::string_view name = nameOf(*child);
          !name.starts_with("library_") && name != "asset" && name != "scene" && name != "extra")
        fault(*child, "<" + printable(name) +
                          "> is not known in <COLLADA>; correct its name, or remove it");
    if (const Element* const asset = onlyChild(root_, "asset", faults_))
      asset_ = assetOf(*asset, {});
    findIds();
    faults_.throwIfAny();
    readScene();
    std::set<const Element*> unused;
    for (const auto& [id, geometry] : geometries_)
      if (geometry) unused.insert(geometry);
    for (const auto& [geometry, part] : parts_) unused.erase(geometry);
    if (!unused.empty()) note("geometries that are in no node of the scene are not read");
    for (const Element* models : childrenOf(root_, "library_physics_models"))
      if (hasDescendant(*models, "shape")) note("the shapes of physics models are not read");
    for (const std::string& text : notes_) scene_.note(text);
    ReadMesh read = scene_.take("Collada");
    read.fileUnit = asset_.metres;
    read.up = asset_.up;
    return read;
  }

 private:
  /// The elements of a kind by their ids; null for an id that several have.
  using Ids = std::map<std::string_view, const Element*>;

  void fault(const Element& element, std::string text) {
    faults_.add(element.GetLineNum(), std::move(text));
  }
  void note(const std::string& text) { scene_.note(text); }
  void check(const Element& element, std::initializer_list<std::string_view> children,
             std::initializer_list<std::string_view> attributes) {
    xml::check(element, children, attributes, faults_, notes_);
  }
  static bool hasDescendant(const Element& element, std::string_view name) {
    for (const Element* child = element.FirstChildElement(); child;
         child = child->NextSiblingElement())
      if (nameOf(*child) == name || hasDescendant(*child, name)) return true;
    return false;
  }

  Asset assetOf(const Element& element, Asset asset) {
    if (const Element* const unit = onlyChild(element, "unit", faults_)) {
      check(*unit, {}, {"meter", "name"});
      const auto meter = xml::attribute(*unit, "meter");
      asset.metres = 1;
      if (meter && (parseCoordinate(trimmed(*meter), asset.metres) || !(asset.metres > 0) ||
                    !wrongMagnitude(asset.metres).empty())) {
        fault(*unit,
              "<unit meter=" + inQuotes(*meter) + ">: the unit must be a number of metres above 0");
        asset.metres = 1;
      }
      const std::string name(xml::attribute(*unit, "name").value_or(""));
      if (const double named = metresOfUnit(lowered(name));
          named > 0 && !isSameUnit(named, asset.metres))
        note("<unit name=" + inQuotes(name) +
             (meter ? "> has the meter of another unit, which is used"
                    : "> has no meter, so a unit of 1 m is used"));
    }
    if (const Element* const up = onlyChild(element, "up_axis", faults_)) {
      check(*up, {}, {});
      const std::string text = xml::textOf(*up, faults_);
      const std::string_view axis = trimmed(text);
      if (axis != "X_UP" && axis != "Y_UP" && axis != "Z_UP")
        fault(*up, "<up_axis> is " + inQuotes(axis) + "; X_UP, Y_UP or Z_UP is needed");
      else
        asset.up = static_cast<char>(axis[0] - 'X' + 'x');
    }
    for (const Element* child = element.FirstChildElement(); child;
         child = child->NextSiblingElement()) {
      constexpr std::string_view kKnown =
          " contributor coverage created extra keywords modified revision subject title unit "
          "up_axis ";
      const std::string name = withoutPrefix(lowered(child->Name()));
      if ((name == "unit" || name == "up_axis") && name != child->Name())
        fault(*child, "<" + printable(child->Name()) + "> is not read; write <" + name + ">");
      else if (kKnown.find(' ' + name + ' ') == kKnown.npos)
        note("<" + printable(child->Name()) + "> of <asset> is not read");
      xml::requireNamespace(*child, faults_);
    }
    return asset;
  }

  /// Adds a fault if the <asset> of an inner element has another unit or up-axis.
  void checkInnerAsset(const Element& element) {
    if (const Element* const asset = onlyChild(element, "asset", faults_);
        asset && assetOf(*asset, asset_) != asset_)
      fault(*asset,
            "this <asset> has another unit or up-axis than the document's, which is not supported; "
            "save the mesh with one unit and one up-axis");
  }

  void add(Ids& ids, const Element& element) {
    const auto id = xml::attribute(element, "id");
    if (id && !ids.try_emplace(*id, &element).second) ids[*id] = nullptr;
  }
  void addNodes(const Element& parent) {
    for (const Element* node : childrenOf(parent, "node")) {
      add(nodes_, *node);
      checkInnerAsset(*node);
      addNodes(*node);
    }
  }
  void findIds() {
    for (const Element* library : childrenOf(root_, "library_geometries")) {
      check(*library, {"asset", "geometry"}, {"id", "name"});
      checkInnerAsset(*library);
      for (const Element* geometry : childrenOf(*library, "geometry")) add(geometries_, *geometry);
    }
    for (const Element* library : childrenOf(root_, "library_nodes")) {
      check(*library, {"asset", "node"}, {"id", "name"});
      checkInnerAsset(*library);
      addNodes(*library);
    }
    for (const Element* library : childrenOf(root_, "library_visual_scenes")) {
      check(*library, {"asset", "visual_scene"}, {"id", "name"});
      checkInnerAsset(*library);
      for (const Element* scene : childrenOf(*library, "visual_scene")) {
        add(scenes_, *scene);
        checkInnerAsset(*scene);
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
      fault(instance, "two elements have the id " + inQuotes(found->first) +
                          ", to which this element refers; give each an id of its own");
    if (url.starts_with('#') && found != ids.end()) return found->second;
    if (xml::attribute(instance, "url"))
      fault(instance, "<" + printable(instance.Name()) + "> refers to " + inQuotes(url) +
                          ", which is not in this file; correct it, or save the mesh as one file");
    return nullptr;
  }

  void readScene() {
    const Element* const scene = onlyChild(root_, "scene", faults_);
    if (!scene) return faults_.fail(0, "has no <scene>; save the mesh as part of a scene");
    check(*scene, {"instance_visual_scene", "instance_physics_scene", "instance_kinematics_scene"},
          {});
    const Element* const instance = onlyChild(*scene, "instance_visual_scene", faults_);
    if (!instance)
      return faults_.fail(scene->GetLineNum(), "<scene> has no <instance_visual_scene>");
    check(*instance, {}, {"url", "name", "sid"});
    const Element* const visual = target(*instance, scenes_);
    if (!visual) return;
    for (const auto& [id, other] : scenes_)
      if (other && other != visual && hasDescendant(*other, "node"))
        note("visual scenes other than the one that <scene> names are not read");
    check(*visual, {"asset", "node", "evaluate_scene"}, {"id", "name"});
    checkInnerAsset(*visual);
    for (const Element* node : childrenOf(*visual, "node")) readNode(*node, {}, 1);
  }

  void readNode(const Element& node, NodePath path, int depth) {
    scene_.visit(depth, xml::childCount(node));
    check(node,
          {"asset", "matrix", "rotate", "scale", "translate", "instance_camera", "instance_light",
           "instance_geometry", "instance_node", "node"},
          {"id", "name", "sid", "type", "layer"});
    faults_.throwIfAny();
    checkInnerAsset(node);
    // Transforms come before all else in a valid file, and apply to all of the node.
    for (const Element* child = node.FirstChildElement(); child;
         child = child->NextSiblingElement())
      if (const auto step = transformOf(*child)) path = path.below(*step);
    for (const Element* child = node.FirstChildElement(); child;
         child = child->NextSiblingElement()) {
      const std::string_view name = nameOf(*child);
      if (name == "node") readNode(*child, path, depth + 1);
      if (name == "instance_node") {
        check(*child, {}, {"url", "name", "sid", "proxy"});
        if (const Element* const other = target(*child, nodes_)) readNode(*other, path, depth + 1);
      }
      if (name == "instance_geometry") {
        check(*child, {"bind_material"}, {"url", "name", "sid"});
        if (const Element* const geometry = target(*child, geometries_))
          scene_.add(partOf(*geometry), path);
      }
    }
    faults_.throwIfAny();
  }

  /// Returns the map of a transform of a node; nullopt for other elements.
  std::optional<Eigen::Affine3d> transformOf(const Element& element) {
    const std::string_view name = nameOf(element);
    const std::size_t size = name == "matrix"                         ? 16
                             : name == "rotate"                       ? 4
                             : name == "translate" || name == "scale" ? 3
                                                                      : 0;
    if (size == 0) return std::nullopt;
    check(element, {}, {"sid"});
    const std::string place = "<" + std::string(name) + ">";
    const std::vector<double> numbers =
        xml::numbersIn(xml::textOf(element, faults_), place, element.GetLineNum(), faults_);
    Eigen::Affine3d step = Eigen::Affine3d::Identity();
    if (numbers.size() != size) {
      fault(element, place + " needs " + std::to_string(size) + " decimal numbers");
    } else if (name == "translate") {
      step.translation() = Eigen::Map<const Vec3>(numbers.data());
    } else if (name == "scale") {
      step.linear() = Eigen::Map<const Vec3>(numbers.data()).asDiagonal();
    } else if (name == "rotate") {
      const Vec3 axis = Eigen::Map<const Vec3>(numbers.data()).stableNormalized();
      const double angle = std::fmod(numbers[3], 360) * (M_PI / 180);
      if (std::abs(numbers[3]) > 1e6)  // so that its rounding turns no mesh
        fault(element, "the angle of <rotate> is beyond 1e6 degrees; write it within 360");
      if (!(axis.squaredNorm() > 0.5) && angle != 0)
        fault(element, "the axis of <rotate> is 0");
      else if (angle != 0)
        step.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    } else {
      const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> m(numbers.data());
      if (m(3, 0) != 0 || m(3, 1) != 0 || m(3, 2) != 0 || m(3, 3) != 1)
        fault(element, "the last row of a <matrix> is not 0 0 0 1, which is not supported");
      step.matrix() = m;
    }
    return step;
  }

  const ScenePart& partOf(const Element& geometry) {
    const auto [entry, isNew] = parts_.try_emplace(&geometry);
    if (!isNew) return entry->second;
    check(geometry, {"asset", "mesh"}, {"id", "name"});
    checkInnerAsset(geometry);
    if (const Element* const mesh = onlyChild(geometry, "mesh", faults_))
      readMesh(*mesh, entry->second);
    else
      fault(geometry, "the <geometry> has no <mesh>");
    faults_.throwIfAny();
    return entry->second;
  }

  void readMesh(const Element& mesh, ScenePart& part) {
    check(mesh,
          {"source", "vertices", "lines", "linestrips", "polygons", "polylist", "triangles",
           "trifans", "tristrips"},
          {});
    const Element* const vertices = onlyChild(mesh, "vertices", faults_);
    bool areRead = false;
    for (const Element* child = mesh.FirstChildElement(); child;
         child = child->NextSiblingElement()) {
      const std::string_view name = nameOf(*child);
      if (name == "lines" || name == "linestrips") note(kNoteOnLines);
      if (name != "triangles" && name != "polylist" && name != "polygons" && name != "trifans" &&
          name != "tristrips")
        continue;
      if (!vertices) return fault(*child, "the <mesh> has no <vertices>");
      if (!areRead) readVertices(mesh, *vertices, part);
      areRead = true;
      faults_.throwIfAny();
      readFaces(*child, *vertices, part);
    }
  }

  /// Returns the element of a <mesh> that has an id.
  const Element* withId(const Element& mesh, const char* name, std::string_view url,
                        const Element& from) {
    const Element* found = nullptr;
    for (const Element* element : childrenOf(mesh, name)) {
      if (!url.starts_with('#') || xml::attribute(*element, "id") != url.substr(1)) continue;
      if (found)
        fault(*element, "two elements <" + std::string(name) + "> of one <" +
                            printable(mesh.Name()) + "> have the id " + inQuotes(url.substr(1)) +
                            "; give each an id of its own");
      found = element;
    }
    if (!found)
      fault(from, "the source " + inQuotes(url) + " is no <" + std::string(name) + "> of its <" +
                      printable(mesh.Name()) + ">");
    return found;
  }

  void readVertices(const Element& mesh, const Element& vertices, ScenePart& part) {
    check(vertices, {"input"}, {"id", "name"});
    const Element* positions = nullptr;
    for (const Element* input : childrenOf(vertices, "input")) {
      check(*input, {}, {"semantic", "source"});
      if (xml::required(*input, "semantic", faults_) != "POSITION") continue;
      if (positions) fault(*input, "<vertices> have a second <input> of semantic POSITION");
      positions = input;
    }
    if (!positions) return fault(vertices, "<vertices> have no <input> of semantic POSITION");
    const Element* const source =
        withId(mesh, "source", xml::required(*positions, "source", faults_), *positions);
    if (source) readPositions(*source, part);
  }

  void readPositions(const Element& source, ScenePart& part) {
    check(source, {"asset", "float_array", "technique_common", "technique"}, {"id", "name"});
    checkInnerAsset(source);
    const Element* const technique = onlyChild(source, "technique_common", faults_);
    if (!technique) return fault(source, "the <source> of positions has no <technique_common>");
    check(*technique, {"accessor"}, {});
    const Element* const accessor = onlyChild(*technique, "accessor", faults_);
    if (!accessor) return fault(source, "the <source> of positions has no <accessor>");
    check(*accessor, {"param"}, {"source", "count", "offset", "stride"});
    const Element* const array =
        withId(source, "float_array", xml::required(*accessor, "source", faults_), *accessor);
    if (!array) return;
    check(*array, {}, {"id", "name", "count", "digits", "magnitude"});
    std::string names;
    for (const Element* param : childrenOf(*accessor, "param")) {
      check(*param, {}, {"name", "type", "sid", "semantic"});
      names += std::string(xml::attribute(*param, "name").value_or("")) + ' ';
    }
    if (names != "X Y Z ")
      return fault(*accessor,
                   "the <accessor> of positions needs <param>s of the names X, Y and Z in this "
                   "order, and no others");
    const std::vector<double> numbers =
        xml::numbersIn(xml::textOf(*array, faults_), "<float_array>", array->GetLineNum(), faults_);
    faults_.throwIfAny();
    const std::uint64_t count = xml::wholeNumber(*accessor, "count", std::nullopt, faults_);
    const std::uint64_t stride = xml::wholeNumber(*accessor, "stride", 1, faults_);
    const std::uint64_t offset = xml::wholeNumber(*accessor, "offset", 0, faults_);
    if (numbers.size() != xml::wholeNumber(*array, "count", std::nullopt, faults_))
      return fault(*array, "<float_array> has " + std::to_string(numbers.size()) +
                               " numbers, and the count is " +
                               inQuotes(xml::attribute(*array, "count").value_or("")) +
                               "; correct one of them");
    if (stride < 3)
      return fault(*accessor, "the <accessor> of positions needs a stride of 3 or more");
    if (count > 0 && offset + stride * (count - 1) + 3 > numbers.size())
      return fault(*accessor,
                   "the <accessor> of positions reads beyond the end of its <float_array>; correct "
                   "its count, stride or offset");
    faults_.requireFew(count, "vertices", accessor->GetLineNum());
    for (std::uint64_t i = 0; i < count; ++i)
      part.vertices.emplace_back(&numbers[offset + stride * i]);
  }

  /// Reads the faces of <triangles>, <polylist>, <polygons>, <trifans> or <tristrips>.
  void readFaces(const Element& faces, const Element& vertices, ScenePart& part) {
    const std::string_view kind = nameOf(faces);
    if (kind == "polylist")
      check(faces, {"input", "vcount", "p"}, {"count", "material", "name"});
    else
      check(faces, {"input", "p"}, {"count", "material", "name"});  // <ph>: polygons with holes
    std::optional<std::uint32_t> offset;
    std::uint32_t stride = 0;
    for (const Element* input : childrenOf(faces, "input")) {
      check(*input, {}, {"semantic", "source", "offset", "set"});
      const std::uint32_t at = xml::wholeNumber(*input, "offset", std::nullopt, faults_);
      stride = std::max(stride, at + 1);
      const std::string_view semantic = xml::required(*input, "semantic", faults_);
      if (semantic == "POSITION")
        fault(*input, "an <input> of semantic POSITION is not in <vertices>");
      if (semantic != "VERTEX") continue;
      if (offset)
        fault(*input, "<" + std::string(kind) + "> has a second <input> of semantic VERTEX");
      offset = at;
      const std::string_view source = xml::required(*input, "source", faults_);
      if (!source.starts_with('#') || xml::attribute(vertices, "id") != source.substr(1))
        fault(*input, "the source " + inQuotes(source) + " is not the <vertices> of the <mesh>");
    }
    const std::uint32_t count = xml::wholeNumber(faces, "count", std::nullopt, faults_);
    faults_.throwIfAny();
    const std::vector<const Element*> lists = childrenOf(faces, "p");
    if (lists.empty() && count == 0) return;
    if (!offset)
      return fault(faces, "<" + std::string(kind) + "> has no <input> of semantic VERTEX");
    const bool isOneList = kind == "triangles" || kind == "polylist";
    if (lists.size() != (isOneList ? 1 : count))
      return fault(faces, "<" + std::string(kind) + "> has " + std::to_string(lists.size()) +
                              " <p>, and needs " + std::to_string(isOneList ? 1 : count) +
                              "; correct its count");
    std::vector<std::uint32_t> sizes;  // of polygons
    if (kind == "polylist") {
      const Element* const list = onlyChild(faces, "vcount", faults_);
      if (!list) return fault(faces, "<polylist> has no <vcount>");
      sizes = xml::indicesIn(xml::textOf(*list, faults_), "<vcount>", list->GetLineNum(), faults_);
      if (sizes.size() != count)
        fault(*list, "<vcount> has " + std::to_string(sizes.size()) +
                         " numbers, and the count is " + std::to_string(count) +
                         "; correct one of them");
    } else if (kind == "triangles") {
      faults_.requireFew(count, "triangles", faces.GetLineNum());
      sizes.assign(count, 3);
    }
    faults_.throwIfAny();
    for (const Element* list : lists) {
      check(*list, {}, {});
      std::vector<std::uint32_t> corners;
      const auto indices =
          xml::indicesIn(xml::textOf(*list, faults_), "<p>", list->GetLineNum(), faults_);
      faults_.throwIfAny();
      if (indices.size() % stride != 0)
        return fault(*list, "<p> has " + std::to_string(indices.size()) +
                                " numbers, which is no multiple of its " + std::to_string(stride) +
                                " offsets");
      for (std::size_t i = *offset; i < indices.size(); i += stride) {
        if (indices[i] >= part.vertices.size())
          return fault(*list, "<p> names vertex " + std::to_string(indices[i]) +
                                  " (from 0), and there are " +
                                  std::to_string(part.vertices.size()));
        corners.push_back(indices[i]);
      }
      addFaces(kind, corners, sizes, *list, part);
    }
  }

  void addFaces(std::string_view kind, const std::vector<std::uint32_t>& corners,
                std::vector<std::uint32_t> sizes, const Element& list, ScenePart& part) {
    const int line = list.GetLineNum();
    if (kind == "trifans" || kind == "tristrips") {
      if (corners.size() < 3) note(kNoteOnLines);
      for (std::size_t i = 2; i < corners.size(); ++i) {
        const std::uint32_t before = corners[kind == "trifans" ? 0 : i - 2];
        if (kind == "tristrips" && i % 2 != 0)  // every second triangle of a strip is turned over
          part.addFace({corners[i - 1], before, corners[i]}, line);
        else
          part.addFace({before, corners[i - 1], corners[i]}, line);
      }
      return;
    }
    if (kind == "polygons") sizes = {static_cast<std::uint32_t>(corners.size())};
    std::uint64_t all = 0;
    for (const std::uint32_t size : sizes) all += size;
    if (all != corners.size())
      return fault(list, "<p> has " + std::to_string(corners.size()) + " corners, and needs " +
                             std::to_string(all) + "; correct the count");
    auto corner = corners.begin();
    for (const std::uint32_t size : sizes) {
      if (size < 3) {
        note(kNoteOnLines);
      } else {
        part.corners.insert(part.corners.end(), corner, corner + size);
        part.faces.push_back({size, line});
      }
      corner += size;
    }
  }

  const Element& root_;
  MeshFaults& faults_;
  SceneMesh scene_;
  Asset asset_;
  std::vector<std::string> notes_;
  Ids geometries_, nodes_, scenes_;
  std::map<const Element*, ScenePart> parts_;
};

}  // namespace

ReadMesh readCollada(std::string_view text, MeshFaults& faults) {
  tinyxml2::XMLDocument document;
  return ColladaReader(xml::parse(document, text, "COLLADA", faults), faults).read();
}

}  // namespace corridor
