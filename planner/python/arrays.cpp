#include "planner/python/arrays.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include <Eigen/Geometry>

namespace corridor::python {
namespace {

/// For the matrix M of a rigid pose, each element of MᵀM may differ from that of the identity by
/// this much. If M's numbers are written with seven digits, the elements differ by up to 3·1e-7.
constexpr double kOrthonormal = 1e-6;

void requireFinite(const Array& array, const char* name) {
  const double* numbers = array.data();
  for (py::ssize_t i = 0; i < array.size(); ++i)
    if (!std::isfinite(numbers[i])) refuse(name, "the numbers must be finite");
}

Transform transformAt(const double* m, const char* name) {
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
    refuse(name, "the last row of a 4×4 matrix must be 0, 0, 0, 1");
  Transform X;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) X.m(row, column) = m[4 * row + column];
    X.t[row] = m[4 * row + 3];
  }
  return X;
}

}  // namespace

void refuse(const char* name, const std::string& text) {
  throw py::value_error(std::string(name) + ": " + text);
}

std::string shapeOf(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i)
    text += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  return text + (array.ndim() == 1 ? ",)" : ")");
}

Configuration configurationOf(const Array& array, const ConfigurationSpace& space,
                              const char* name) {
  if (array.ndim() != 1) refuse(name, "one configuration is needed, not " + shapeOf(array));
  return configurationsOf(array, space, name)[0];
}

std::vector<Configuration> configurationsOf(const Array& array, const ConfigurationSpace& space,
                                            const char* name) {
  const auto columns = static_cast<py::ssize_t>(space.size());
  if ((array.ndim() != 1 && array.ndim() != 2) || array.shape(array.ndim() - 1) != columns)
    refuse(name, "an array of shape (" + std::to_string(columns) + ",) or (N, " +
                     std::to_string(columns) + ") is needed, not " + shapeOf(array));
  requireFinite(array, name);
  const py::ssize_t rows = array.ndim() == 1 ? 1 : array.shape(0);
  std::vector<Configuration> result;
  result.reserve(static_cast<std::size_t>(rows));
  for (py::ssize_t i = 0; i < rows; ++i) {
    result.emplace_back(Eigen::Map<const Configuration>(array.data() + i * columns, columns));
    if (!space.isFinite(result.back()))
      refuse(name, "a quaternion of row " + std::to_string(i) + " is zero");
  }
  return result;
}

Array arrayOf(const std::vector<Configuration>& rows, std::size_t columns) {
  Array array({rows.size(), columns});
  double* numbers = array.mutable_data();
  for (const Configuration& row : rows)
    for (const double number : row) *numbers++ = number;
  return array;
}

std::vector<Transform> transformsOf(const Array& array, const char* name) {
  const py::ssize_t n = array.ndim();
  if ((n != 2 && n != 3) || array.shape(n - 2) != 4 || array.shape(n - 1) != 4)
    refuse(name, "an array of shape (4, 4) or (N, 4, 4) is needed, not " + shapeOf(array));
  requireFinite(array, name);
  std::vector<Transform> result;
  const py::ssize_t count = n == 2 ? 1 : array.shape(0);
  for (py::ssize_t i = 0; i < count; ++i)
    result.push_back(transformAt(array.data() + 16 * i, name));
  return result;
}

RigidPose rigidPoseOf(const Array& array, const char* name) {
  if (array.ndim() != 2) refuse(name, "one 4×4 matrix is needed, not " + shapeOf(array));
  const Transform X = transformsOf(array, name)[0];
  const double off = (X.m.transpose() * X.m - Mat3::Identity()).cwiseAbs().maxCoeff();
  if (!(off <= kOrthonormal) || X.m.determinant() < 0)
    refuse(name, "the upper left 3×3 matrix must be a rotation");
  // A Newton step to the nearest rotation. With E = MᵀM − I, |E| ≤ 3·1e-6, it moves M by |M·E|/2 ≤
  // 1.6e-6, and the result is off from orthonormal by 3/4·|E|² < 1e-11. So the rotation of the
  // quaternion differs from M by less than 2e-6, although the conversion to a quaternion is exact
  // only for rotations.
  const Mat3 R = X.m * (1.5 * Mat3::Identity() - 0.5 * X.m.transpose() * X.m);
  RigidPose pose;
  pose.p = X.t;
  pose.q = Eigen::Quaterniond(R).normalized();
  return pose;
}

std::vector<Vec3> pointsOf(const Array& array, const char* name) {
  if (array.ndim() != 2 || array.shape(1) != 3)
    refuse(name, "an array of shape (N, 3) is needed, not " + shapeOf(array));
  requireFinite(array, name);
  std::vector<Vec3> points;
  for (py::ssize_t i = 0; i < array.shape(0); ++i)
    points.emplace_back(Eigen::Map<const Vec3>(array.data() + 3 * i));
  return points;
}

TriangleMesh meshOf(const Array& vertices, const Indices& triangles) {
  TriangleMesh mesh;
  mesh.vertices = pointsOf(vertices, "vertices");
  if (triangles.ndim() != 2 || triangles.shape(1) != 3)
    refuse("triangles", "an array of shape (N, 3) is needed, not " + shapeOf(triangles));
  if (triangles.shape(0) == 0) refuse("triangles", "at least one triangle is needed");
  const auto count = static_cast<std::int64_t>(mesh.vertices.size());
  for (py::ssize_t i = 0; i < triangles.shape(0); ++i) {
    auto& triangle = mesh.triangles.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const std::int64_t index = triangles.at(i, k);
      if (index < 0 || index >= count)
        refuse("triangles", "index " + std::to_string(index) + " of row " + std::to_string(i) +
                                " is not below the number of vertices, " + std::to_string(count));
      triangle[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(index);
    }
  }
  return mesh;
}

}  // namespace corridor::python
