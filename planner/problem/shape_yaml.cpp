#include "planner/problem/shape_yaml.h"

#include <algorithm>
#include <set>

#include "collision/core/read_file.h"
#include "collision/core/spelling.h"
#include "collision/geometry/mesh_health.h"
#include "collision/geometry/stated_unit.h"
#include "planner/problem/cloud_yaml.h"
#include "planner/problem/hull_yaml.h"
#include "planner/problem/keys.h"
#include "planner/problem/polygon_yaml.h"

namespace corridor {
namespace {

const std::vector<std::string> kinds{"mesh",   "box",     "sphere", "capsule", "cylinder",
                                     "convex", "polygon", "points", "octomap"};

const MapKeys* primitiveKeys(const char* primitive) {
  return &problemKeys().at(std::string("world.*.") + primitive);
}

MeshFileOptions readMeshOptions(const YamlMap& map) {
  MeshFileOptions options;
  if (const auto unit = map.choice("unit", problemChoices().at("world.*.unit")))
    options.metresPerUnit = metresPerUnitNamed(*unit);
  if (const auto up = map.choice("up", problemChoices().at("world.*.up"))) options.up = up->front();
  return options;
}

/// Returns whether a file that can't be read as a mesh is probably a point cloud. @param why the
/// error of the mesh reader.
bool mayBeCloud(const std::filesystem::path& file, std::string_view why) {
  const std::string extension = lowered(file.extension().string());
  if (extension == ".ply") return why.find("no element \"face\"") != why.npos;
  return extension == ".pcd" || extension == ".xyz" || extension == ".pts" || extension == ".asc";
}

/// Reads the mesh file that `key` names, and adds it to `files`. Returns null if a fault was added.
std::shared_ptr<const MeshFile> readMesh(const YamlMap& map, const char* key,
                                         const std::filesystem::path& folder,
                                         std::filesystem::path& file, ShapeFiles& files) {
  const auto name = map.text(key);
  if (!name) return nullptr;
  file = folder / *name;
  if (const std::string why = whyNotOrdinaryFile(file); !why.empty()) {
    map.fault(key, file.string() + ": " + why);
    return nullptr;
  }
  addFile(files.files, file);
  const auto mesh = files.meshes.read(map, key, file);
  if (mesh)
    for (const std::string& other : mesh->otherFiles) addFile(files.files, other);
  return mesh;
}

std::optional<Primitive> readBox(const YamlMap& map) {
  if (map.find("box")->kind == YamlValue::Kind::Map) {
    map.fault("box", "three edge lengths are needed, such as box: [0.4, 0.4, 0.5], not a map");
    return std::nullopt;
  }
  const auto size = map.numbers("box", 3);
  if (!size) return std::nullopt;
  return Box{{(*size)[0], (*size)[1], (*size)[2]}};
}

/// Reads `sphere: 0.1`, or `sphere: {radius: 0.1}`.
std::optional<Primitive> readSphere(const YamlMap& map) {
  const YamlValue& value = *map.find("sphere");
  std::optional<double> radius;
  if (value.kind == YamlValue::Kind::Map) {
    const YamlMap inner(value, map.pathOf("sphere"), primitiveKeys("sphere"), map.source());
    inner.require("radius", "metres");
    radius = inner.number("radius");
  } else {
    radius = map.number("sphere");
  }
  if (!radius) return std::nullopt;
  return Sphere{*radius};
}

/// Reads a Capsule or a Cylinder. @param length what the length means, for messages.
template <class Round>
std::optional<Primitive> readRound(const YamlMap& map, const char* key, const char* length) {
  const YamlMap inner(*map.find(key), map.pathOf(key), primitiveKeys(key), map.source());
  inner.require("radius", "metres");
  inner.require("length", length);
  const auto radius = inner.number("radius"), along = inner.number("length");
  if (!radius || !along) return std::nullopt;
  return Round{*radius, *along};
}

std::optional<Primitive> readConvex(const YamlMap& map, const ShapePlace& place,
                                    std::filesystem::path& file, ShapeFiles& files) {
  const YamlValue& value = *map.find("convex");
  Convex convex;
  if (value.kind == YamlValue::Kind::List) {
    for (const YamlValue& item : value.items) {
      const auto p = readNumbers(item, 3, map.pathOf("convex"), map.source());
      if (!p) return std::nullopt;
      convex.points.emplace_back((*p)[0], (*p)[1], (*p)[2]);
    }
    return convex;
  }
  if (isBoolean(value)) {
    map.fault("convex", value.text +
                            " is for a mesh, mesh: FILE beside it; without one, a mesh "
                            "file or points [[x, y, z], …] are needed");
    return std::nullopt;
  }
  if (value.kind != YamlValue::Kind::Scalar) {
    map.fault("convex", "a mesh file or points [[x, y, z], …] are needed, not " + described(value));
    return std::nullopt;
  }
  const auto mesh = readMesh(map, "convex", place.folder, file, files);
  if (!mesh) return std::nullopt;
  convex.points = mesh->mesh.vertices;
  return convex;
}

std::optional<Primitive> readPrimitive(const YamlMap& map, const std::string& kind,
                                       const ShapePlace& place, std::filesystem::path& file,
                                       ShapeFiles& files) {
  if (kind == "box") return readBox(map);
  if (kind == "sphere") return readSphere(map);
  if (kind == "capsule")
    return readRound<Capsule>(map, "capsule", "metres along z, between the centres of its spheres");
  if (kind == "cylinder") return readRound<Cylinder>(map, "cylinder", "metres along z");
  return readConvex(map, place, file, files);
}

/// Adds a fault for each key that is legal for shapes, but does not apply to this kind of shape.
void faultMisplacedKeys(const YamlMap& map, const std::string& kind) {
  const bool isFile = kind == "mesh" || kind == "points" ||
                      (kind == "convex" && map.find("convex")->kind == YamlValue::Kind::Scalar);
  if (!isFile)
    for (const char* key : {"unit", "up"})
      if (map.find(key))
        map.fault(key, kind == "octomap"
                           ? "is for mesh files; an octomap is in metres, with z up"
                           : "is for mesh files; lengths of a " + kind + " are in metres");
  if (kind != "mesh" && map.find("solid"))
    map.fault("solid", kind == "points" || kind == "octomap"
                           ? "is for meshes; balls and cubes are always solid"
                           : "is for meshes; a " + kind + " is always solid");
}

/// Moves the vertices of a shape's mesh. The shape gets a copy of the mesh, because other shapes
/// may share it. Returns whether the vertices are still finite.
template <class Move>
bool moveMesh(PlacedShape& shape, const Move& move) {
  MeshFile moved = *shape.mesh;
  bool finite = true;
  for (Vec3& vertex : moved.mesh.vertices) {
    vertex = move(vertex);
    finite &= vertex.allFinite();
  }
  shape.mesh = std::make_shared<const MeshFile>(std::move(moved));
  return finite;
}

bool isFinite(const ConvexPart& part) {
  return std::all_of(part.points.begin(), part.points.end(),
                     [](const Vec3& point) { return point.allFinite(); });
}

/// Adds a fault for a shape whose placement moves it out of the range of doubles. Always returns
/// false.
bool faultRange(const YamlMap& map) {
  map.fault("at", "moves the shape out of the range of doubles");
  return false;
}

}  // namespace

std::shared_ptr<const MeshFile> ShapeMeshes::read(const YamlMap& map, const char* key,
                                                  const std::filesystem::path& file) {
  const MeshFileOptions options = readMeshOptions(map);
  const auto [known, isNew] = meshes_.try_emplace({file, {options.metresPerUnit, options.up}});
  if (!isNew) return known->second;
  try {
    MeshFile mesh = readMeshFile(file, options, map.source().cache);
    if (const char up = mesh.fileUp.value_or('z'); up != 'z' && !options.up)
      mesh.notes.push_back(noteOnUp("the file", std::string("up: ") + up));
    known->second = std::make_shared<const MeshFile>(std::move(mesh));
  } catch (const InputError& error) {
    map.source().faults.add(error);
    if (mayBeCloud(file, error.what()))
      map.fault(
          key, "for a cloud of points, write points: {file: " + *map.text(key) + ", radius: 0.01}");
    const std::string extension = lowered(file.extension().string());
    if (extension == ".bt" || extension == ".ot")
      map.fault(key, "for a map of OctoMap, write octomap: {file: " + *map.text(key) + "}");
  }
  return known->second;
}

const std::string& ShapeMeshes::whyNotWatertight(const std::shared_ptr<const MeshFile>& mesh) {
  const auto [known, isNew] = whyNotWatertight_.try_emplace(mesh);
  if (!isNew) return known->second;
  const MeshHealth health = inspectMesh(mesh->mesh);
  if (!health.watertight) known->second = health.whyNotWatertight;
  return known->second;
}

std::optional<PlacedShape> readShape(const YamlMap& map, const ShapePlace& place, ShapeFiles& files,
                                     Placement* notApplied) {
  const HullKey hullKey = readHullKey(map);
  const bool hull = hullKey == HullKey::hull;
  std::vector<std::string> counted = kinds;
  if (hullKey != HullKey::none) std::erase(counted, "convex");
  const auto kind = map.requireOne(counted, "one shape",
                                   "mesh: FILE, box: [x, y, z], sphere: radius, capsule or "
                                   "cylinder: {radius: …, length: …}, convex: FILE, polygon: "
                                   "[[x, y], …], points: {file: …, radius: …}, or octomap: "
                                   "{file: …}");
  const bool solid = map.boolean("solid").value_or(false);
  const auto own = readPlacement(map);
  if (!kind || hullKey == HullKey::faulty) return std::nullopt;
  faultMisplacedKeys(map, *kind);

  PlacedShape shape;
  shape.name = place.name;
  const Placement whole = place.outer * own.value_or(Placement{});
  shape.at = whole.pose;
  bool inRange = true;
  if (*kind == "points" || *kind == "octomap") {
    if (!readCloud(map, *kind, *primitiveKeys(kind->c_str()), place.folder, readMeshOptions(map),
                   whole.X, shape, files.files) ||
        !own)
      return std::nullopt;
    inRange = std::all_of(shape.parts.begin(), shape.parts.end(), isFinite);
  } else if (*kind == "polygon") {
    if (!place.isPlanar) {
      map.fault("polygon",
                "is for robots in the plane (rigid: SE2) and their worlds; elsewhere, write box, "
                "convex or mesh");
      return std::nullopt;
    }
    if (!own || !readPolygon(map, whole.X, shape)) return std::nullopt;
  } else if (*kind == "mesh") {
    shape.mesh = readMesh(map, "mesh", place.folder, shape.file, files);
    shape.solid = solid;
    if (!own || !shape.mesh) return std::nullopt;
    if (solid) {
      if (const std::string& why = files.meshes.whyNotWatertight(shape.mesh); !why.empty()) {
        map.fault("solid", "needs a watertight mesh, and " + shape.file.string() +
                               " is not watertight: " + why +
                               "; repair the mesh, or leave solid out");
        return std::nullopt;
      }
    }
    if (notApplied && !hull)
      *notApplied = whole;
    else if (!applyPlacement(map, whole, shape))
      return std::nullopt;
    if (hull && !replaceByHull(map, shape)) return std::nullopt;
  } else {
    shape.primitive = readPrimitive(map, *kind, place, shape.file, files);
    if (!shape.primitive) return std::nullopt;
    if (const auto why = checkPrimitive(*shape.primitive)) {
      map.fault(*kind, *why);
      return std::nullopt;
    }
    if (!own) return std::nullopt;
    shape.parts.push_back(placed(*shape.primitive, whole.X));
    inRange = isFinite(shape.parts.front());
  }
  if ((hull || *kind == "convex") && !shape.mesh && !shape.file.empty()) {
    const auto mesh = files.meshes.read(map, hull ? "mesh" : "convex", shape.file);
    for (const std::string& text : mesh->notes)
      shape.notes.push_back({text + ": " + shape.file.string(), NoteWeight::coverage});
    if (!hull && mesh->facesOnly)
      shape.notes.push_back(
          {"the hull is that of the corners of faces, because vertices without a "
           "face are not read in this format: " +
               shape.file.string(),
           NoteWeight::coverage});
  }
  if (inRange) return shape;
  faultRange(map);
  return std::nullopt;
}

bool applyPlacement(const YamlMap& map, const Placement& placement, PlacedShape& shape) {
  if (placement.isIdentity()) return true;
  return moveMesh(shape, [&](const Vec3& vertex) { return placement.X * vertex; }) ||
         faultRange(map);
}

std::vector<PlacedShape> readShapes(const YamlMap& map, const MapKeys& keys,
                                    const ShapePlace& place, ShapeFiles& files) {
  std::vector<PlacedShape> shapes;
  const YamlValue& list = *map.find("shapes");
  if (list.kind != YamlValue::Kind::List || list.items.empty()) {
    map.fault("shapes",
              "a list of at least one shape, such as [{mesh: FILE}], is needed, not " +
                  (list.kind == YamlValue::Kind::List ? "an empty one" : described(list)));
    return shapes;
  }
  std::set<std::string> names;
  for (std::size_t i = 0; i < list.items.size(); ++i) {
    const YamlMap item(list.items[i], map.pathOf("shapes") + "[" + std::to_string(i) + "]", &keys,
                       map.source());
    const std::string own = item.text("name").value_or(std::to_string(i + 1));
    if (!names.insert(own).second)
      item.fault("name", quotedWord(own) + " is the name of another shape");
    ShapePlace inside = place;
    if (list.items.size() > 1) inside.name += "/" + own;
    if (auto shape = readShape(item, inside, files)) shapes.push_back(std::move(*shape));
  }
  return shapes;
}

std::string shift(PlacedShape& shape, const Vec3& by) {
  shape.at.p += by;
  if (!shape.polygon.empty()) return shiftPolygon(shape, by);
  bool finite = true;
  if (shape.mesh) finite = moveMesh(shape, [&](const Vec3& v) { return Vec3(v + by); });
  for (ConvexPart& part : shape.parts) {
    for (Vec3& point : part.points) point += by;
    finite &= isFinite(part);
  }
  return finite ? "" : "moves the shape out of the range of doubles";
}

void addFile(std::vector<std::filesystem::path>& files, const std::filesystem::path& file) {
  if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
}

}  // namespace corridor
