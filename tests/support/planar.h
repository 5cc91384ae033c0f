#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <boost/multiprecision/cpp_int.hpp>

namespace corridor::test {

/// The numbers of the oracle for polygons in the plane: exact rationals. The oracle applies the
/// definitions directly, in O(n²).
using Fraction = boost::multiprecision::cpp_rational;
struct Point2 {
  Fraction x, y;

  explicit Point2(const Eigen::Vector2d& p) : x(p.x()), y(p.y()) {}
  Point2(Fraction px, Fraction py) : x(std::move(px)), y(std::move(py)) {}
  bool operator==(const Point2& o) const { return x == o.x && y == o.y; }
  bool operator<(const Point2& o) const { return x != o.x ? x < o.x : y < o.y; }
};

/// Returns 1 if p, q, r turn left, −1 if they turn right, and 0 if they are on a line.
inline int turn(const Point2& p, const Point2& q, const Point2& r) {
  const Fraction left = (q.x - p.x) * (r.y - p.y), right = (q.y - p.y) * (r.x - p.x);
  return left > right ? 1 : left < right ? -1 : 0;
}
/// Returns whether q is on the closed segment from a to b.
inline bool isOn(const Point2& q, const Point2& a, const Point2& b) {
  return turn(a, b, q) == 0 && std::min(a.x, b.x) <= q.x && q.x <= std::max(a.x, b.x) &&
         std::min(a.y, b.y) <= q.y && q.y <= std::max(a.y, b.y);
}
/// Returns whether the closed segments ab and cd share a point.
inline bool segmentsMeet(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  if (isOn(a, c, d) || isOn(b, c, d) || isOn(c, a, b) || isOn(d, a, b)) return true;
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

inline std::vector<Point2> exactly(const std::vector<Eigen::Vector2d>& points) {
  return {points.begin(), points.end()};
}

/// Returns whether edges i and k of a polygon share a point. The common end of two consecutive
/// edges does not count.
inline bool edgesMeet(const std::vector<Point2>& p, std::size_t i, std::size_t k) {
  const std::size_t n = p.size(), i1 = (i + 1) % n, k1 = (k + 1) % n;
  if (i1 == k) return isOn(p[i], p[k], p[k1]) || isOn(p[k1], p[i], p[k]);
  if (k1 == i) return isOn(p[k], p[i], p[i1]) || isOn(p[i1], p[k], p[i]);
  return segmentsMeet(p[i], p[i1], p[k], p[k1]);
}

/// Returns whether no two edges share a point, except the common ends of consecutive edges.
inline bool isSimple(const std::vector<Point2>& p) {
  if (p.size() < 3) return false;
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t k = i + 1; k < p.size(); ++k)
      if (p[i] == p[k] || edgesMeet(p, i, k)) return false;
  return true;
}

/// Returns twice the signed area, which is positive if the polygon runs counterclockwise.
inline Fraction twiceArea(const std::vector<Point2>& p) {
  Fraction sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Point2 &a = p[i], &b = p[(i + 1) % p.size()];
    sum += a.x * b.y - a.y * b.x;
  }
  return sum;
}

/// Returns whether a point is in the closed polygon: the point is on an edge, or has an odd number
/// of edges to its right.
inline bool contains(const std::vector<Point2>& p, const Point2& q) {
  bool inside = false;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Point2 &a = p[i], &b = p[(i + 1) % p.size()];
    if (isOn(q, a, b)) return true;
    if ((a.y > q.y) == (b.y > q.y)) continue;
    inside ^= turn(a, b, q) == (b.y > a.y ? 1 : -1);
  }
  return inside;
}

/// Returns whether two closed simple polygons share a point.
inline bool polygonsMeet(const std::vector<Point2>& p, const std::vector<Point2>& q) {
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t k = 0; k < q.size(); ++k)
      if (segmentsMeet(p[i], p[(i + 1) % p.size()], q[k], q[(k + 1) % q.size()])) return true;
  return contains(p, q[0]) || contains(q, p[0]);
}

/// Makes random polygons, whose boundaries may cross themselves.
class Polygons {
 public:
  using Points = std::vector<Eigen::Vector2d>;
  static constexpr int kinds = 6;

  explicit Polygons(std::uint64_t seed) : engine_(seed) {}
  std::size_t below(std::size_t n) { return engine_() % n; }
  double real(double low = -1, double high = 1) {
    return std::uniform_real_distribution(low, high)(engine_);
  }

  /// Returns a polygon of about n points. Kinds:
  /// * 0: a star; 1: a spiral; 2: a comb;
  /// * 3: points of a small grid in random order;
  /// * 4: such points, reordered so that most crossings of edges are removed;
  /// * 5: a staircase with many points of equal x.
  Points polygon(std::size_t n, int kind) {
    Points p;
    const auto size = static_cast<double>(n);
    if (kind == 0) {
      for (std::size_t i = 0; i < n; ++i) {
        const double angle = 2 * M_PI * (static_cast<double>(i) + 0.9 * real(0, 1)) / size;
        p.push_back(real(0.1, 1) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
      }
    } else if (kind == 1) {
      const std::size_t half = n / 2 + 2;
      const double turns = real(0.5, 4);
      for (int side = 0; side < 2; ++side)
        for (std::size_t k = 0; k < half; ++k) {
          const double t =
              static_cast<double>(side ? half - 1 - k : k) / static_cast<double>(half - 1);
          const double r = 1 + turns * t + (side ? 0.4 : 0), angle = 2 * M_PI * turns * t;
          p.emplace_back(r * std::cos(angle), r * std::sin(angle));
        }
    } else if (kind == 2) {
      const std::size_t teeth = n / 4 + 1;
      p.emplace_back(0, -1);
      p.emplace_back(static_cast<double>(teeth), -1);
      for (std::size_t k = teeth; k-- > 0;) {
        const double x = static_cast<double>(k), depth = below(2) ? 0 : real(0, 0.9);
        p.emplace_back(x + 1, 0);
        p.emplace_back(x + 0.5, below(3) ? 5 : 4.5);
        p.emplace_back(x + 0.5, depth);
        p.emplace_back(x, 0);
        if (p.back() == p[p.size() - 2]) p.pop_back();
      }
      p.erase(std::unique(p.begin(), p.end()), p.end());
      Points once;
      for (const auto& v : p)
        if (std::find(once.begin(), once.end(), v) == once.end()) once.push_back(v);
      p = once;
    } else if (kind == 3 || kind == 4) {
      const double grid = std::ceil(std::sqrt(size) + 1);
      for (std::size_t i = 0; i < n; ++i) {
        const Eigen::Vector2d v(std::floor(real(0, grid)), std::floor(real(0, grid)));
        if (kind == 3 ? p.empty() || p.back() != v : std::find(p.begin(), p.end(), v) == p.end())
          p.push_back(v);
      }
      if (kind == 4) uncross(p);
    } else {
      double y = 0;
      for (std::size_t i = 0; i < n / 2 + 1; ++i)
        p.emplace_back(std::floor(static_cast<double>(i) / 3), y += static_cast<double>(below(3)));
      const double shift = 1 + static_cast<double>(below(4));
      const Points lower = p;
      for (std::size_t i = lower.size(); i-- > 0;)
        p.emplace_back(lower[i].x() - shift, lower[i].y() + shift);
    }
    return p;
  }

  /// Returns a variant of a polygon. Points may be inserted on its edges, exactly or up to
  /// rounding. The polygon may be rotated, mirrored, scaled, moved far away, or given the other
  /// orientation. The list may begin with another point.
  Points varied(Points p) {
    if (p.size() < 2) return p;
    if (below(3) == 0) {
      Points more;
      for (std::size_t i = 0; i < p.size(); ++i) {
        more.push_back(p[i]);
        const Eigen::Vector2d& q = p[(i + 1) % p.size()];
        if (below(2))
          more.push_back(below(2) ? (0.5 * (p[i] + q)).eval() : p[i] + 0.3 * (q - p[i]));
      }
      p = more;
    }
    const std::size_t how = below(6);
    const double angle = real(0, 6.3), c = std::cos(angle), s = std::sin(angle);
    for (auto& v : p) {
      if (how == 0) v = {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
      if (how == 1) v += Eigen::Vector2d(1e6, -1e6);
      if (how == 2) v = 1e-9 * v + Eigen::Vector2d(1e6, 1e6);  // rounded to a grid of 1e-10
      if (how == 3) v = {v.y(), v.x()};
      if (how == 4) v *= 0x1p-300;
    }
    if (below(2)) std::reverse(p.begin(), p.end());
    std::rotate(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(below(p.size())), p.end());
    return p;
  }

 private:
  /// Reverses parts of the boundary until no two edges that are not neighbours share a point. Stops
  /// after 60 rounds at the latest, so some common points may remain.
  void uncross(Points& p) const {
    if (p.size() < 4) return;
    std::vector<Point2> e = exactly(p);
    bool changed = true;
    for (int round = 0; changed && round < 60; ++round) {
      changed = false;
      for (std::size_t i = 0; i < p.size(); ++i)
        for (std::size_t k = i + 2; k < p.size(); ++k) {
          if ((k + 1) % p.size() == i || !edgesMeet(e, i, k)) continue;
          std::reverse(p.begin() + static_cast<std::ptrdiff_t>(i + 1),
                       p.begin() + static_cast<std::ptrdiff_t>(k + 1));
          std::reverse(e.begin() + static_cast<std::ptrdiff_t>(i + 1),
                       e.begin() + static_cast<std::ptrdiff_t>(k + 1));
          changed = true;
        }
    }
  }

  std::mt19937_64 engine_;
};

}  // namespace corridor::test
