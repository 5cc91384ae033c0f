#include "planner/trajectory/row_polynomials.h"

#include <cmath>

namespace corridor {
namespace {

/// A sum (`value`), and the sum of the absolute values of its terms (`size`). A coefficient in this
/// file is a sum of at most 8 terms. Each term has at most 10 roundings: those of the difference of
/// two positions (one), of the difference of two times (one, in up to three factors), and of
/// products and quotients. Each term takes part in at most 7 additions. So the error of a
/// coefficient is at most 17·2^-53·size, up to second order. kRounding is 32·2^-53.
struct Sum {
  double value = 0, size = 0;
  Sum operator+(const Sum& o) const { return {value + o.value, size + o.size}; }
  Sum operator-(const Sum& o) const { return {value - o.value, size + o.size}; }
  Sum operator*(double f) const { return {value * f, size * std::abs(f)}; }
};
constexpr double kRounding = 0x1p-48;

Sum term(double value) {
  return {value, std::abs(value)};
}

template <std::size_t N>
BoundedPolynomial polynomial(const std::array<Sum, N>& sums) {
  BoundedPolynomial result;
  result.degree = static_cast<int>(N) - 1;
  for (std::size_t i = 0; i < N; ++i) {
    result.c[i] = sums[i].value;
    result.error[i] = kRounding * sums[i].size;
  }
  return result;
}

/// Returns the derivative by time of the polynomial of degree N − 1 with the Bernstein coefficients
/// `sums`. @param perTime (N − 1)/T, where T is the duration in which the polynomial's parameter
/// goes from 0 to 1.
template <std::size_t N>
std::array<Sum, N - 1> derivative(const std::array<Sum, N>& sums, double perTime) {
  std::array<Sum, N - 1> result;
  for (std::size_t i = 0; i + 1 < N; ++i) result[i] = (sums[i + 1] - sums[i]) * perTime;
  return result;
}

}  // namespace

RowPolynomials rowPolynomials(const TimedRow& from, const TimedRow& to, int degree,
                              Eigen::Index n) {
  RowPolynomials result;
  const double T = to.time - from.time, p0 = from.position[n], p1 = to.position[n];
  const Sum way = term(p1 - p0);
  for (int i = 0; i <= degree; ++i) result.near[i] = 2 * i < degree ? p0 : p1;
  if (degree == 1) {
    result.rise.degree = 1;
    result.velocity = polynomial(std::array{way * (1 / T)});
    return result;
  }
  const Sum v0 = term(from.velocity[n]), v1 = term(to.velocity[n]);
  if (degree == 3) {
    result.rise = polynomial(std::array{Sum(), v0 * (T / 3), v1 * (-T / 3), Sum()});
    const std::array velocity{v0, way * (3 / T) - v0 - v1, v1};
    result.velocity = polynomial(velocity);
    result.acceleration = polynomial(derivative(velocity, 2 / T));
    return result;
  }
  const Sum a0 = term(from.acceleration[n]), a1 = term(to.acceleration[n]);
  result.rise = polynomial(std::array{Sum(), v0 * (T / 5), v0 * (2 * T / 5) + a0 * (T * T / 20),
                                      v1 * (-2 * T / 5) + a1 * (T * T / 20), v1 * (-T / 5), Sum()});
  const std::array velocity{v0, v0 + a0 * (T / 4),
                            way * (5 / T) - v0 * 2 - v1 * 2 + (a1 - a0) * (T / 4),
                            v1 - a1 * (T / 4), v1};
  std::array acceleration = derivative(velocity, 4 / T);
  acceleration.front() = a0;
  acceleration.back() = a1;
  result.velocity = polynomial(velocity);
  result.acceleration = polynomial(acceleration);
  result.jerk = polynomial(derivative(acceleration, 3 / T));
  return result;
}

}  // namespace corridor
