#include "planner/robot/rpy.h"

#include <cmath>
#include <numbers>

namespace corridor {
namespace {

struct SineCosine {
  long double sine, cosine;
};

SineCosine ofEighths(int eighths) {
  const long double half = std::sqrt(0.5L);
  const long double sines[] = {0, half, 1, half, 0, -half, -1, -half};
  return {sines[eighths & 7], sines[(eighths + 2) & 7]};
}

/// Returns sine and cosine of `angle / divisor`. @pre divisor is 1 or 2.
SineCosine sineCosine(double angle, int divisor) {
  const long double quarter = std::numbers::pi_v<long double> / 2;
  const long double quarters = std::nearbyint(angle / quarter);
  // Up to 1,024 turns, as files hardly contain larger multiples of 90 degrees. Beyond that, doubles
  // are too sparse to recognise them.
  if (std::abs(quarters) <= 4096 && static_cast<double>(quarters * quarter) == angle)
    return ofEighths(static_cast<int>(quarters) * 2 / divisor);
  const long double part = static_cast<long double>(angle) / divisor;
  return {std::sin(part), std::cos(part)};
}

}  // namespace

Eigen::Quaterniond quaternionFromRpy(const Vec3& rpy) {
  const SineCosine x = sineCosine(rpy.x(), 2), y = sineCosine(rpy.y(), 2),
                   z = sineCosine(rpy.z(), 2);
  const auto rounded = [](long double value) { return static_cast<double>(value); };
  return {rounded(x.cosine * y.cosine * z.cosine + x.sine * y.sine * z.sine),
          rounded(x.sine * y.cosine * z.cosine - x.cosine * y.sine * z.sine),
          rounded(x.cosine * y.sine * z.cosine + x.sine * y.cosine * z.sine),
          rounded(x.cosine * y.cosine * z.sine - x.sine * y.sine * z.cosine)};
}

Mat3 matrixFromRpy(const Vec3& rpy) {
  const SineCosine x = sineCosine(rpy.x(), 1), y = sineCosine(rpy.y(), 1),
                   z = sineCosine(rpy.z(), 1);
  Eigen::Matrix<long double, 3, 3> R;
  R << z.cosine * y.cosine, z.cosine * y.sine * x.sine - z.sine * x.cosine,
      z.cosine * y.sine * x.cosine + z.sine * x.sine,  //
      z.sine * y.cosine, z.sine * y.sine * x.sine + z.cosine * x.cosine,
      z.sine * y.sine * x.cosine - z.cosine * x.sine,  //
      -y.sine, y.cosine * x.sine, y.cosine * x.cosine;
  return R.cast<double>() + Mat3::Zero();  // turns -0 into 0
}

}  // namespace corridor
