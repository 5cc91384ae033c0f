#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include <Eigen/Core>

namespace corridor::bench {

/// Numbers of arithmetic operations. Divisions and square roots count as products.
struct OperationCounts {
  std::uint64_t sums = 0, products = 0, comparisons = 0, absolutes = 0;
  std::uint64_t total() const { return sums + products + comparisons + absolutes; }
};

/// A double that counts the operations on it, for templates that take any number type. Each thread
/// has its own counts.
class Counted {
 public:
  Counted(double value = 0) : value_(value) {}  // NOLINT: a double is a number

  static OperationCounts& counts() {
    thread_local OperationCounts counts;
    return counts;
  }

  friend Counted operator+(Counted x, Counted y) { return sum(x.value_ + y.value_); }
  friend Counted operator-(Counted x, Counted y) { return sum(x.value_ - y.value_); }
  friend Counted operator*(Counted x, Counted y) { return product(x.value_ * y.value_); }
  friend Counted operator/(Counted x, Counted y) { return product(x.value_ / y.value_); }
  // The negation is not counted, because it is usually part of another instruction.
  Counted operator-() const { return {-value_}; }
  Counted& operator+=(Counted x) { return *this = *this + x; }
  Counted& operator-=(Counted x) { return *this = *this - x; }
  Counted& operator*=(Counted x) { return *this = *this * x; }
  Counted& operator/=(Counted x) { return *this = *this / x; }
  friend bool operator>(Counted x, Counted y) {
    ++counts().comparisons;
    return x.value_ > y.value_;
  }
  friend bool operator<(Counted x, Counted y) { return y > x; }
  friend Counted abs(Counted x) {
    ++counts().absolutes;
    return {std::abs(x.value_)};
  }
  friend Counted sqrt(Counted x) { return product(std::sqrt(x.value_)); }

 private:
  static Counted sum(double value) {
    ++counts().sums;
    return {value};
  }
  static Counted product(double value) {
    ++counts().products;
    return {value};
  }
  double value_;
};

}  // namespace corridor::bench

template <>
struct Eigen::NumTraits<corridor::bench::Counted> : Eigen::NumTraits<double> {
  using Real = corridor::bench::Counted;
  using NonInteger = corridor::bench::Counted;
  using Nested = corridor::bench::Counted;
  enum { RequireInitialization = 1, IsComplex = 0, IsInteger = 0, IsSigned = 1 };
};
