#include "planner/problem/placement.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planner/robot/turns.h"

namespace corridor {
namespace {

struct SineCosine {
  double sine, cosine;
};

SineCosine ofRadians(double angle) {
  return {std::sin(angle), std::cos(angle)};
}

/// Exact at multiples of 90 degrees. At odd multiples of 45 degrees, sine and cosine are equal but
/// for the sign.
SineCosine ofDegrees(double degrees) {
  int quarters = 0;
  const double rest = std::remquo(degrees, 90, &quarters);  // exact; |rest| ≤ 45
  SineCosine a = ofRadians(rest * (std::numbers::pi / 180));
  if (std::abs(rest) == 45) a = {std::copysign(std::sqrt(0.5), rest), std::sqrt(0.5)};
  switch (quarters & 3) {
    case 1:
      return {a.cosine, -a.sine};
    case 2:
      return {-a.sine, -a.cosine};
    case 3:
      return {-a.cosine, a.sine};
    default:
      return a;
  }
}

Mat3 matrix(const SineCosine& x, const SineCosine& y, const SineCosine& z) {
  Mat3 aboutX, aboutY, aboutZ;
  aboutX << 1, 0, 0, 0, x.cosine, -x.sine, 0, x.sine, x.cosine;
  aboutY << y.cosine, 0, y.sine, 0, 1, 0, -y.sine, 0, y.cosine;
  aboutZ << z.cosine, -z.sine, 0, z.sine, z.cosine, 0, 0, 0, 1;
  return aboutZ * (aboutY * aboutX);
}

/// Takes the sines and cosines of the half angles.
Eigen::Quaterniond quaternion(const SineCosine& x, const SineCosine& y, const SineCosine& z) {
  return Eigen::Quaterniond(z.cosine, 0, 0, z.sine) * Eigen::Quaterniond(y.cosine, 0, y.sine, 0) *
         Eigen::Quaterniond(x.cosine, x.sine, 0, 0);
}

/// The largest deviation from 1 of the norm of a typed quaternion. Rounding to three digits after
/// the point causes 0.001 at most: four components, each off by at most 0.0005, change the norm by
/// at most 0.0005·√4.
constexpr double normSlack = 1e-3;

std::optional<Orientation> readQuaternion(const YamlMap& map) {
  const auto xyzw = map.numbers("quat_xyzw", 4);
  if (!xyzw) return std::nullopt;
  const Eigen::Quaterniond q((*xyzw)[3], (*xyzw)[0], (*xyzw)[1], (*xyzw)[2]);
  const double norm = q.coeffs().stableNorm();
  if (norm == 0) {
    map.fault("quat_xyzw", "a quaternion of zeros is no rotation; [0, 0, 0, 1] is the identity");
    return std::nullopt;
  }
  if (!(std::abs(norm - 1) <= normSlack)) {
    map.fault("quat_xyzw", "[x, y, z, w] of norm 1 is needed, not of norm " + shortest(norm) +
                               "; a mistyped number?");
    return std::nullopt;
  }
  return Orientation{q, q.normalized().toRotationMatrix()};
}

std::string wrongKind(const std::string& path, const PoseForm& form) {
  return path + " of the wrong kind: " + form.mover + ", so " +
         (form.spatial ? "{at: [x, y, z], rpy_deg: [roll, pitch, yaw]}"
                       : "{at: [x, y], yaw_deg: yaw}") +
         " is needed";
}

bool isWrongKind(const YamlValue& value, const PoseForm& form) {
  if (value.kind != YamlValue::Kind::Map) return true;
  const std::vector<std::string>& legal = form.keys->legal;
  bool hasLegal = false;
  for (const auto& [key, line, entry] : value.entries) {
    hasLegal |= std::find(legal.begin(), legal.end(), key) != legal.end();
    const bool planar = key == "yaw" || key == "yaw_deg";
    const bool spatial = key == "rpy" || key == "rpy_deg" || key == "quat_xyzw";
    if (form.spatial ? planar : spatial) return true;
    if (key == "at" && entry.kind == YamlValue::Kind::List &&
        entry.items.size() == (form.spatial ? 2u : 3u))
      return true;
  }
  return !hasLegal;
}

/// Reads `yaw` or `yaw_deg`, in radians; 0 if both are absent. Returns nullopt if it is faulted.
std::optional<double> readYaw(const YamlMap& map, std::vector<std::string>& notes) {
  if (!map.find("yaw") && !map.find("yaw_deg")) return 0;
  if (map.find("yaw") && map.find("yaw_deg")) return map.angle("yaw");
  const bool degrees = map.find("yaw_deg");
  const char* const key = degrees ? "yaw_deg" : "yaw";
  const auto given = map.number(key);
  if (!given) return std::nullopt;
  const double used = degrees ? wrappedYawDegrees(*given) : wrappedYaw(*given);
  if (used != *given)
    notes.push_back(map.pathOf(key) + ": " + shortest(*given) + " is read as " + shortest(used) +
                    ", the same angle up to full turns");
  return degrees ? used * (std::numbers::pi / 180) : used;
}

}  // namespace

Orientation fromRpyDegrees(const Vec3& a) {
  return {quaternion(ofDegrees(a.x() / 2), ofDegrees(a.y() / 2), ofDegrees(a.z() / 2)),
          matrix(ofDegrees(a.x()), ofDegrees(a.y()), ofDegrees(a.z()))};
}

Orientation fromRpy(const Vec3& a) {
  return {quaternion(ofRadians(a.x() / 2), ofRadians(a.y() / 2), ofRadians(a.z() / 2)),
          matrix(ofRadians(a.x()), ofRadians(a.y()), ofRadians(a.z()))};
}

double wrappedYaw(double radians) {
  return intoCircle(radians);
}

double wrappedYawDegrees(double degrees) {
  const double rest = std::remainder(degrees, 360);
  return rest == -180 ? 180 : rest;
}

std::optional<Orientation> readOrientation(const YamlMap& map) {
  std::vector<const char*> given;
  for (const char* key : {"rpy_deg", "rpy", "quat_xyzw"})
    if (map.find(key)) given.push_back(key);
  if (given.empty()) return Orientation{};
  if (given.size() > 1) {
    map.fault(given[1], std::string("one rotation is needed, and ") + given[0] +
                            " is given already; leave one out");
    return std::nullopt;
  }
  const std::string key = given[0];
  if (key == "quat_xyzw") return readQuaternion(map);
  const auto angles = map.numbers(key, 3);
  if (!angles) return std::nullopt;
  const Vec3 rpy((*angles)[0], (*angles)[1], (*angles)[2]);
  return key == "rpy" ? fromRpy(rpy) : fromRpyDegrees(rpy);
}

Placement operator*(const Placement& a, const Placement& b) {
  return {{a.X * b.pose.p, a.pose.q * b.pose.q}, a.X * b.X};
}

std::optional<Placement> readPlacement(const YamlMap& map) {
  Vec3 at = Vec3::Zero();
  const auto numbers = map.numbers("at", 3);
  if (numbers) at = Vec3((*numbers)[0], (*numbers)[1], (*numbers)[2]);
  const auto orientation = readOrientation(map);
  if ((map.find("at") && !numbers) || !orientation) return std::nullopt;
  return Placement{{at, orientation->q}, {orientation->R, at}};
}

std::optional<PlanarOrSpatialPose> readPose(const YamlValue& value, const std::string& path,
                                            const PoseForm& form, YamlSource& source,
                                            std::vector<std::string>& notes) {
  if (isWrongKind(value, form)) {
    source.fault(value.line, wrongKind(path, form));
    return std::nullopt;
  }
  const YamlMap map(value, path, form.keys, source);
  map.require("at", form.spatial ? "the position [x, y, z] of the robot's reference point"
                                 : "the position [x, y] of the robot's reference point");
  const auto at = map.numbers("at", form.spatial ? 3 : 2);
  PlanarOrSpatialPose result;
  std::optional<Orientation> orientation;
  if (form.spatial) {
    orientation = readOrientation(map);
  } else if (const auto yaw = readYaw(map, notes)) {
    result.yaw = *yaw;
    orientation = fromRpy({0, 0, *yaw});
  }
  if (!at || !orientation) return std::nullopt;
  result.pose = {Vec3((*at)[0], (*at)[1], form.spatial ? (*at)[2] : 0), orientation->q};
  return result;
}

}  // namespace corridor
