#include "planner/python/shapes.h"

#include <pybind11/stl.h>

#include "collision/geometry/mesh_health.h"
#include "planner/model/model_builder.h"
#include "planner/python/arrays.h"
#include "planner/robot/rpy.h"

namespace corridor::python {
namespace {

PlacedShape primitiveShape(const std::string& name, const Primitive& primitive,
                           const GivenPose& at) {
  if (const auto wrong = checkPrimitive(primitive)) throw py::value_error(name + ": " + *wrong);
  PlacedShape shape = shapeOf(name, primitive, at.pose);
  shape.parts = {placed(primitive, at.X)};
  return shape;
}

PlacedShape meshShape(const std::string& name, TriangleMesh mesh, bool solid, const GivenPose& at) {
  if (solid) {
    const MeshHealth health = inspectMesh(mesh);
    if (!health.watertight)
      throw py::value_error(name + ": a solid mesh must be watertight: " + health.whyNotWatertight);
  }
  if (!(at.X == Transform{}))
    for (Vec3& p : mesh.vertices) p = at.X * p;
  return shapeOf(name, std::move(mesh), solid);
}

PlacedShape cloud(const std::string& name, const Array& points, double radius,
                  const GivenPose& at) {
  if (const auto wrong = checkPrimitive(Sphere{radius}))
    throw py::value_error(name + ": " + *wrong);
  PlacedShape shape;
  shape.name = name;
  shape.at = at.pose;
  shape.solid = true;
  const std::vector<Vec3> centres = pointsOf(points, "points");
  if (centres.empty()) throw py::value_error(name + ": points: at least one point is needed");
  for (const Vec3& p : centres)
    shape.parts.push_back(placed(Sphere{radius}, {Mat3::Identity(), at.X * p}));
  return shape;
}

}  // namespace

GivenPose givenPose(const py::object& value, const char* name) {
  if (value.is_none()) return {};
  if (!py::isinstance<py::tuple>(value)) {
    const RigidPose pose = rigidPoseOf(value.cast<Array>(), name);
    return {pose, {rotationMatrix(pose.q), pose.p}};
  }
  const auto [xyz, rpy] = value.cast<std::pair<std::array<double, 3>, std::array<double, 3>>>();
  const Vec3 p(xyz[0], xyz[1], xyz[2]), angles(rpy[0], rpy[1], rpy[2]);
  if (!p.allFinite() || !angles.allFinite()) refuse(name, "the numbers must be finite");
  return {{p, quaternionFromRpy(angles)}, {matrixFromRpy(angles), p}};
}

RigidPose poseOf(const py::object& value, const char* name) {
  return givenPose(value, name).pose;
}

PlacedShape shapeFrom(const std::string& name, const py::tuple& shape) {
  const auto kind = shape[0].cast<std::string>();
  const GivenPose at = givenPose(shape[shape.size() - 1], (name + ": pose").c_str());
  if (kind == "box") {
    const auto size = pointsOf(shape[1].cast<Array>().reshape({1, -1}), "size");
    return primitiveShape(name, Box{size[0]}, at);
  }
  if (kind == "sphere") return primitiveShape(name, Sphere{shape[1].cast<double>()}, at);
  if (kind == "capsule")
    return primitiveShape(name, Capsule{shape[1].cast<double>(), shape[2].cast<double>()}, at);
  if (kind == "cylinder")
    return primitiveShape(name, Cylinder{shape[1].cast<double>(), shape[2].cast<double>()}, at);
  if (kind == "convex")
    return primitiveShape(name, Convex{pointsOf(shape[1].cast<Array>(), "points")}, at);
  if (kind == "points") return cloud(name, shape[1].cast<Array>(), shape[2].cast<double>(), at);
  const bool isSolid = shape[3].cast<bool>();
  if (kind == "mesh")
    return meshShape(name, meshOf(shape[1].cast<Array>(), shape[2].cast<Indices>()), isSolid, at);
  const auto file = shape[1].cast<std::string>();
  MeshFile read = readMeshFile(file, {.metresPerUnit = shape[2].cast<std::optional<double>>()});
  PlacedShape made = meshShape(name, std::move(read.mesh), isSolid, at);
  for (const std::string& text : read.notes)
    made.notes.push_back({text + ": " + file, NoteWeight::coverage});
  return made;
}

std::vector<PlacedShape> shapesFrom(const std::string& name, const py::list& shapes) {
  if (shapes.empty()) throw py::value_error(name + ": at least one shape is needed");
  std::vector<PlacedShape> result;
  for (std::size_t i = 0; i < shapes.size(); ++i)
    result.push_back(
        shapeFrom(shapes.size() == 1 ? name : name + "/" + std::to_string(i + 1), shapes[i]));
  return result;
}

}  // namespace corridor::python
