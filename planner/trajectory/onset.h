#pragma once

#include <array>

namespace corridor {

/// A fixed map s(σ) from a parameter σ to the path parameter s of a run: s ~ σ³ near both ends, and
/// s = σ + constant between. Near rest, a law of bounded jerk has s ~ t³; so, with this map, σ̇ is
/// smooth and above 0 everywhere. The map is twice continuously differentiable. s‴ jumps where the
/// three parts of the map meet, at σ = length/5 and at σ = end() − length/5.
class Onset {
 public:
  explicit Onset(double length) : length_(length), width_(length / 5) {}
  /// Returns the σ of the end of the run; σ begins at 0.
  double end() const { return length_ + 0.8 * width_; }

  /// Returns s and its first three derivatives at σ.
  std::array<double, 4> at(double sigma) const {
    if (sigma < width_) return rising(sigma);
    if (sigma <= end() - width_) return {sigma - 0.4 * width_, 1, 0, 0};
    const auto [s, s1, s2, s3] = rising(end() - sigma);
    return {length_ - s, s1, -s2, s3};
  }

  /// Returns the σ of a given s in [0, length].
  double parameterOf(double s) const {
    if (s > length_ / 2) return end() - parameterOf(length_ - s);
    if (s >= 0.6 * width_) return s + 0.4 * width_;
    double low = 0, high = width_;
    for (int step = 0; step < 60; ++step) {
      const double middle = (low + high) / 2;
      (rising(middle)[0] < s ? low : high) = middle;
    }
    return (low + high) / 2;
  }

 private:
  /// With z = σ/width: s = width·(2z³ − 2z⁴ + 0.6z⁵). At z = 1, s = 0.6·width, s′ = 1 and
  /// s″ = s‴ = 0.
  std::array<double, 4> rising(double sigma) const {
    const double z = sigma / width_;
    return {width_ * z * z * z * (2 - 2 * z + 0.6 * z * z), z * z * (6 - 8 * z + 3 * z * z),
            12 * z * (1 - z) * (1 - z) / width_, 12 * (1 - z) * (1 - 3 * z) / (width_ * width_)};
  }

  double length_, width_;
};

}  // namespace corridor
