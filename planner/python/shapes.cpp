#include "planner/python/shapes.h"

#include <pybind11/stl.h>

#include "planner/model/model_builder.h"
#include "planner/python/arrays.h"

namespace corridor::python {

RigidPose poseOf(const py::object& matrix) {
  if (matrix.is_none()) return {};
  return rigidPoseOf(matrix.cast<Array>(), "pose");
}

PlacedShape shapeFrom(const std::string& name, const py::tuple& shape) {
  const auto kind = shape[0].cast<std::string>();
  const RigidPose at = poseOf(shape[shape.size() - 1]);
  const auto primitive = [&](const Primitive& p) {
    if (const auto wrong = checkPrimitive(p)) throw py::value_error(name + ": " + *wrong);
    return shapeOf(name, p, at);
  };
  if (kind == "box") {
    const auto size = pointsOf(shape[1].cast<Array>().reshape({1, -1}), "size");
    return primitive(Box{size[0]});
  }
  if (kind == "sphere") return primitive(Sphere{shape[1].cast<double>()});
  if (kind == "capsule")
    return primitive(Capsule{shape[1].cast<double>(), shape[2].cast<double>()});
  if (kind == "cylinder")
    return primitive(Cylinder{shape[1].cast<double>(), shape[2].cast<double>()});
  if (kind == "convex") return primitive(Convex{pointsOf(shape[1].cast<Array>(), "points")});
  TriangleMesh mesh = kind == "mesh"
                          ? meshOf(shape[1].cast<Array>(), shape[2].cast<Indices>())
                          : readMeshFile(shape[1].cast<std::string>(),
                                         {.metresPerUnit = shape[2].cast<std::optional<double>>()})
                                .mesh;
  const Mat3 R = rotationMatrix(at.q);
  for (Vec3& p : mesh.vertices) p = R * p + at.p;
  return shapeOf(name, std::move(mesh), shape[3].cast<bool>());
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
