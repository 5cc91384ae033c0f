#pragma once

#include <array>

namespace corridor {

/// A fixed map s(σ) from a parameter to the length along a run, so that a law of bounded jerk,
/// which leaves rest like t³, has a smooth σ̇ > 0 everywhere: s ~ σ³ near both ends, and s = σ +
/// constant between. Twice continuously differentiable; s‴ jumps where the parts meet, at `width()`
/// and at `end() − width()`.
class Onset {
 public:
  explicit Onset(double length) : length_(length), width_(length / 4) {}
  double width() const { return width_; }
  /// σ goes from 0 to this.
  double end() const { return length_ + width_; }

  /// Returns s and its first three derivatives at σ. @param side a σ in the part that is meant.
  std::array<double, 4> at(double sigma, double side) const {
    if (side < width_) return rising(sigma);
    if (side <= length_) return {sigma - width_ / 2, 1, 0, 0};
    const auto [s, s1, s2, s3] = rising(end() - sigma);
    return {length_ - s, s1, -s2, s3};
  }

  /// Returns the σ of s in [0, length].
  double parameterOf(double s) const {
    if (s > length_ / 2) return end() - parameterOf(length_ - s);
    if (s >= width_ / 2) return s + width_ / 2;
    double low = 0, high = width_;
    for (int step = 0; step < 60; ++step) {
      const double middle = (low + high) / 2;
      (rising(middle)[0] < s ? low : high) = middle;
    }
    return (low + high) / 2;
  }

 private:
  /// With z = σ/width: s = width·(z³ − z⁴/2). At z = 1, s = width/2, s′ = 1 and s″ = 0.
  std::array<double, 4> rising(double sigma) const {
    const double z = sigma / width_;
    return {width_ * z * z * z * (1 - z / 2), z * z * (3 - 2 * z), 6 * z * (1 - z) / width_,
            (6 - 12 * z) / (width_ * width_)};
  }

  double length_, width_;
};

}  // namespace corridor
