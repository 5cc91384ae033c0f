#include "planner/query/query_poses.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <random>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "collision/core/error.h"
#include "collision/core/rounding.h"
#include "collision/core/spelling.h"
#include "collision/core/whole_file.h"
#include "collision/volumes/obb.h"
#include "planner/app/output.h"
#include "planner/problem/number_text.h"
#include "planner/query/number_lines.h"

namespace corridor::app {
namespace {

/// Returns why R is not a rotation, or "" if it is.
std::string whyNoRotation(const Mat3& R) {
  const double defect = orthonormalityDefect(R);
  const double determinant = R.determinant();
  // The determinant is a sum of six products of one number from each column. Each of them is at
  // most P, the product of the columns' largest entries, and has at most five roundings. So the
  // error is below 64u·P. If that overflows, only the defect decides: R is not a rotation.
  const double error = 64 * kUnit * R.colwise().lpNorm<Eigen::Infinity>().prod();
  if (std::abs(determinant) <= error && std::isfinite(error))
    return "the matrix is singular (determinant " + rounded(determinant) +
           "); a rotation is needed";
  if (determinant < 0 && std::isfinite(determinant))
    return "the matrix mirrors (determinant " + rounded(determinant) + "); a rotation is needed";
  if (!(defect <= kRotationDefect))
    return "the matrix is not a rotation: RᵀR differs from the identity by " + rounded(defect) +
           "; at most " + rounded(kRotationDefect) + " counts as rounding";
  return "";
}

/// The numbers of one line of a file.
using Numbers = std::vector<double>;

// The `parse` functions return what is wrong, or "".

std::string parsePose(const double* values, Transform& X) {
  X.m = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values);
  X.t = Eigen::Map<const Vec3>(values + 9);
  return whyNoRotation(X.m);
}

/// Returns the rotation nearest to a matrix M, as a unit quaternion q, and an upper bound of
/// |M − R(q)| in the operator norm: the Frobenius norm of the difference, plus 40u for the rounding
/// of R(q) and of that norm. @pre M does not mirror.
std::pair<Eigen::Quaterniond, double> nearestRotation(const Mat3& M) {
  const Eigen::JacobiSVD<Mat3> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Mat3 R = svd.matrixU() * svd.matrixV().transpose();  // a rotation, as M does not mirror
  const Eigen::Quaterniond q = Eigen::Quaterniond(R).normalized();
  return {q, roundedUp((M - q.toRotationMatrix()).norm() + 40 * kUnit)};
}

std::string parsePose(const Numbers& values, Transform& X) {
  if (values.size() != 12)
    return "a pose has 12 numbers (r00 r01 r02 r10 r11 r12 r20 r21 r22 tx ty tz), not " +
           std::to_string(values.size());
  return parsePose(values.data(), X);
}

std::string parseMotion(const Numbers& values, PoseMotion& motion) {
  if (values.size() != 24)
    return "a motion has 24 numbers (its first pose, r00 r01 r02 r10 r11 r12 r20 r21 r22 tx ty tz, "
           "and its last), not " +
           std::to_string(values.size());
  for (const bool last : {false, true}) {
    Transform X;
    if (const std::string complaint = parsePose(values.data() + (last ? 12 : 0), X);
        !complaint.empty())
      return (last ? "last pose: " : "first pose: ") + complaint;
    RigidPose& pose = last ? motion.to : motion.from;
    const auto [q, defect] = nearestRotation(X.m);
    pose = {X.t, q};
    motion.defect = std::max(motion.defect, defect);
  }
  return "";
}

struct Bounds {
  Vec3 low, high;
  Vec3 center() const { return low + (high - low) / 2; }
};
Bounds boundsOf(const TriangleMesh& mesh) {
  Bounds bounds{mesh.corner(0, 0), mesh.corner(0, 0)};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      bounds.low = bounds.low.cwiseMin(mesh.corner(t, i));
      bounds.high = bounds.high.cwiseMax(mesh.corner(t, i));
    }
  return bounds;
}

/// Returns a rotation, uniform over all rotations: four normal numbers are a quaternion of uniform
/// direction.
Mat3 randomRotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Eigen::Quaterniond q;
  do
    for (int i = 0; i < 4; ++i) q.coeffs()[i] = normal(random);
  while (q.norm() < 0x1p-20);
  return q.normalized().toRotationMatrix();
}

/// Reads a whole number above 0; returns false if the word is anything else.
bool parseCount(std::string_view word, std::size_t& count) {
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), count);
  return error == std::errc{} && stop == word.data() + word.size() && count > 0;
}

std::vector<std::string> splitAt(const std::string& text, char separator) {
  std::vector<std::string> words(1);
  for (const char c : text)
    if (c == separator)
      words.emplace_back();
    else
      words.back() += c;
  return words;
}

}  // namespace

std::vector<Transform> readPoses(const std::filesystem::path& file) {
  std::vector<Transform> poses;
  readNumberLines(file, "poses",
                  [&](const Numbers& values) { return parsePose(values, poses.emplace_back()); });
  return poses;
}

std::vector<PoseMotion> readMotions(const std::filesystem::path& file) {
  std::vector<PoseMotion> motions;
  readNumberLines(file, "motions", [&](const Numbers& values) {
    return parseMotion(values, motions.emplace_back());
  });
  return motions;
}

std::vector<Transform> gridPoses(const PoseGrid& grid, const TriangleMesh& a,
                                 const TriangleMesh& b) {
  const Bounds boundsA = boundsOf(a), boundsB = boundsOf(b);
  const Vec3 grown = Vec3::Constant((boundsB.high - boundsB.low).norm() / 2);
  const Vec3 lower = grid.lower.value_or(boundsA.low - grown);
  const Vec3 upper = grid.upper.value_or(boundsA.high + grown);
  if (!(lower.array() <= upper.array()).all()) {
    // The message names the option that the user gave; the other bound may be a default.
    if (!grid.lower)
      throw InputError(Fault{
          "--upper", 0, rounded(upper) + " is not above --lower, by default " + rounded(lower)});
    throw InputError(Fault{"--lower", 0,
                           rounded(lower) + " is not below --upper, " +
                               (grid.upper ? "" : "by default ") + rounded(upper)});
  }
  std::size_t total = 1;
  for (const std::size_t count : {grid.counts[0], grid.counts[1], grid.counts[2], grid.rotations}) {
    if (count > kMostPoses / total)
      throw InputError(
          Fault{"--grid", 0,
                "more than " + grouped(kMostPoses) + " poses; use fewer points or rotations"});
    total *= count;
  }
  const auto along = [&](int axis, std::size_t i) {
    const std::size_t count = grid.counts[static_cast<std::size_t>(axis)];
    const double share = count == 1 ? 0.5 : static_cast<double>(i) / static_cast<double>(count - 1);
    return lower[axis] + (upper[axis] - lower[axis]) * share;
  };
  std::mt19937_64 random(grid.seed);
  std::vector<Transform> poses;
  poses.reserve(total);
  for (std::size_t r = 0; r < grid.rotations; ++r) {
    const Mat3 R = r == 0 ? Mat3::Identity() : randomRotation(random);
    const Vec3 turned = R * boundsB.center();
    for (std::size_t k = 0; k < grid.counts[2]; ++k)
      for (std::size_t j = 0; j < grid.counts[1]; ++j)
        for (std::size_t i = 0; i < grid.counts[0]; ++i)
          poses.push_back({R, Vec3(along(0, i), along(1, j), along(2, k)) - turned});
  }
  return poses;
}

std::array<std::size_t, 3> parseCounts(const std::string& text) {
  const std::vector<std::string> words = splitAt(text, 'x');
  std::array<std::size_t, 3> counts{};
  bool sound = words.size() == 3;
  for (std::size_t i = 0; sound && i < 3; ++i) sound = parseCount(words[i], counts[i]);
  if (!sound)
    throw InputError(Fault{"--grid", 0,
                           "three counts above 0 along x, y and z are needed, as in 10x10x5, not " +
                               quotedWord(text)});
  return counts;
}

Vec3 parsePoint(const std::string& option, const std::string& text) {
  const std::vector<std::string> words = splitAt(text, ',');
  Vec3 point;
  bool sound = words.size() == 3;
  for (std::size_t i = 0; sound && i < 3; ++i) {
    double value = 0;
    sound = parseNumber(words[i], Range::Any, value).empty() && std::isfinite(value);
    point[static_cast<int>(i)] = value;
  }
  if (!sound)
    throw InputError(Fault{
        option, 0, "three numbers of metres are needed, as in -1,-1,0.5, not " + quotedWord(text)});
  return point;
}

void writePoses(const std::filesystem::path& file, const std::vector<Transform>& poses) {
  writeWhole(file, [&](std::ostream& out) {
    out << "# r00 r01 r02 r10 r11 r12 r20 r21 r22 tx ty tz: a point of B is at R b + t\n";
    char text[32];
    for (const Transform& X : poses) {
      for (int i = 0; i < 9; ++i) {
        std::snprintf(text, sizeof text, "%.17g ", X.m(i / 3, i % 3));
        out << text;
      }
      for (int i = 0; i < 3; ++i) {
        std::snprintf(text, sizeof text, "%.17g%c", X.t[i], i == 2 ? '\n' : ' ');
        out << text;
      }
    }
  });
}

}  // namespace corridor::app
