#include "planner/robot/rpy.h"

#include <cmath>
#include <numbers>

namespace corridor {
namespace {

struct SineCosine {
  long double sine, cosine;
};

/// Returns sine and cosine of `eighths` times 45 degrees.
SineCosine ofEighths(int eighths) {
  const long double half = std::sqrt(0.5L);
  const long double sines[] = {0, half, 1, half, 0, -half, -1, -half};
  return {sines[eighths & 7], sines[(eighths + 2) & 7]};
}

/// Returns sine and cosine of `radians / divisor`. @pre divisor is 1 or 2.
SineCosine ofRadians(double radians, int divisor) {
  const long double quarter = std::numbers::pi_v<long double> / 2;
  const long double quarters = std::nearbyint(radians / quarter);
  // This test recognises multiples of 90 degrees up to 1024 turns. Files hardly ever contain larger
  // angles.
  if (std::abs(quarters) <= 4096 && static_cast<double>(quarters * quarter) == radians)
    return ofEighths(static_cast<int>(quarters) * 2 / divisor);
  const long double part = static_cast<long double>(radians) / divisor;
  return {std::sin(part), std::cos(part)};
}

/// Returns sine and cosine of `degrees / divisor`. @pre divisor is 1 or 2.
SineCosine ofDegrees(double degrees, int divisor) {
  int eighths = 0;  // of a turn; remquo defines only the lowest three bits
  const long double rest =
      std::remquo(static_cast<long double>(degrees) / divisor, 45.0L, &eighths);  // exact
  const SineCosine whole = ofEighths(eighths);
  if (rest == 0) return whole;
  const long double radians = rest * (std::numbers::pi_v<long double> / 180);
  const long double sine = std::sin(radians), cosine = std::cos(radians);
  return {whole.sine * cosine + whole.cosine * sine, whole.cosine * cosine - whole.sine * sine};
}

/// Returns the quaternion of a rotation.
/// @param x, y, z sine and cosine of half the roll, half the pitch and half the yaw.
Eigen::Quaterniond quaternionOf(const SineCosine& x, const SineCosine& y, const SineCosine& z) {
  const auto rounded = [](long double value) { return static_cast<double>(value); };
  return {rounded(x.cosine * y.cosine * z.cosine + x.sine * y.sine * z.sine),
          rounded(x.sine * y.cosine * z.cosine - x.cosine * y.sine * z.sine),
          rounded(x.cosine * y.sine * z.cosine + x.sine * y.cosine * z.sine),
          rounded(x.cosine * y.cosine * z.sine - x.sine * y.sine * z.cosine)};
}

/// Returns the matrix of a rotation.
/// @param x, y, z sine and cosine of roll, pitch and yaw.
Mat3 matrixOf(const SineCosine& x, const SineCosine& y, const SineCosine& z) {
  Eigen::Matrix<long double, 3, 3> R;
  R << z.cosine * y.cosine, z.cosine * y.sine * x.sine - z.sine * x.cosine,
      z.cosine * y.sine * x.cosine + z.sine * x.sine,  //
      z.sine * y.cosine, z.sine * y.sine * x.sine + z.cosine * x.cosine,
      z.sine * y.sine * x.cosine - z.cosine * x.sine,  //
      -y.sine, y.cosine * x.sine, y.cosine * x.cosine;
  return R.cast<double>() + Mat3::Zero();  // turns -0 into 0
}

}  // namespace

Eigen::Quaterniond quaternionFromRpy(const Vec3& a) {
  return quaternionOf(ofRadians(a.x(), 2), ofRadians(a.y(), 2), ofRadians(a.z(), 2));
}

Mat3 matrixFromRpy(const Vec3& a) {
  return matrixOf(ofRadians(a.x(), 1), ofRadians(a.y(), 1), ofRadians(a.z(), 1));
}

Eigen::Quaterniond quaternionFromRpyDegrees(const Vec3& a) {
  return quaternionOf(ofDegrees(a.x(), 2), ofDegrees(a.y(), 2), ofDegrees(a.z(), 2));
}

Mat3 matrixFromRpyDegrees(const Vec3& a) {
  return matrixOf(ofDegrees(a.x(), 1), ofDegrees(a.y(), 1), ofDegrees(a.z(), 1));
}

}  // namespace corridor
