#include "collision/course/penetration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <queue>
#include <stdexcept>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "collision/convex/convex_contact.h"
#include "collision/convex/convex_surface.h"
#include "collision/convex/support.h"
#include "collision/core/rounding.h"

/// Rounding. All points of the inner polytope are computed in double, in a unit of length near the
/// size of the sets, and are then used as they are. Each of these points differs from a point of A
/// − B by at most twice the errors of the projections of both sets (`PosedSet`). So the polytope is
/// inside A − B grown by this error, and `lower` subtracts this error. `upper` uses certified
/// projections.
///
/// The plane of a face is computed in double-double. With edges p and q its normal p × q is off by
/// some 10·2^-98·|p||q|, so its direction is off by 2^-90·|p||q|/|p × q|. The distance of the plane
/// from the origin is off by this angle times the distance of the corner o from the origin, where p
/// and q begin at o.
namespace corridor {
namespace {

using gjk::Vector;

constexpr int kMostRounds = 500;

class Expansion {
 public:
  /// @param along  the direction of the ray, a unit vector; null for the least depth over all
  /// directions.
  Expansion(const PosedSet& a, const PosedSet& b, const Vec3* along, bool ballsInCores)
      : a_(a),
        b_(b),
        size_(a.reach() + a.pose().t.norm() + b.reach() + b.pose().t.norm()),
        unit_(powerOfTwo(size_)),
        supportA_(a, 1 / unit_, ballsInCores),
        supportB_(b, 1 / unit_, ballsInCores),
        along_(along),
        radii_(ballsInCores ? 0 : a.set().ball + b.set().ball),
        error_(roundedUp(a.error() + b.error() + 7 * kUnit * size_)),
        // The cores touch, up to the band of `convexSetsTouch`, so the spheres alone give at least
        // this depth. `keepsBall` allows errors of 3·2^-48 of the radii.
        least_(along || ballsInCores
                   ? 0
                   : std::max(0.0, radii_ * (1 - 0x1p-46) - 2 * error_ - 0x1p-44 * size_)) {}

  Penetration run(double accuracy) {
    Penetration result;
    // The initial points are extreme along these directions: that of the ray, and those from the
    // centre of a cube to its faces, edges and corners.
    std::vector<Vec3> directions;
    if (along_) directions.push_back(*along_);
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z)
          if (x || y || z) directions.push_back(Vec3(x, y, z).normalized());
    for (const Vec3& n : directions) addPoint(n);
    const auto tetrahedron = findTetrahedron(points_);
    if (!tetrahedron) return flat();
    surface_.begin(points_, *tetrahedron);
    const Vec3* const ray = std::exchange(along_, nullptr);
    take();
    bool inside = true;
    if (ray) {
      // The ray must begin inside the polytope; otherwise the ray might pass beside the polytope.
      inside = expand(result, 0, true).distance > 0;
      along_ = ray;
      best_ = HUGE_VAL;
      requeue();
    }
    const Entry last = expand(result, accuracy, false);
    if (!inside) result.lower = 0;
    if (best_ == HUGE_VAL)  // no plane could be computed, because the cores are tiny
      for (const Vec3& n : directions) tryNormal(n);
    finish(last.face, result);
    return result;
  }

 private:
  struct Plane {
    Vec3 normal = Vec3::Zero();  ///< unit, outward
    std::uint32_t stamp = 0;  ///< distinguishes faces that have the same index at different times
  };
  struct Entry {
    double distance;  ///< lower bound of the distance of the plane from the origin, or along the
                      ///< ray; in units
    std::uint32_t face, stamp;
    bool operator<(const Entry& other) const { return distance > other.distance; }
  };

  /// Adds points beyond the closest face until the closest face is on the boundary of A − B, up to
  /// the allowed error, or until the limit of rounds is reached. Returns the closest face.
  /// @param untilInside  true: also ends as soon as the origin is inside the polytope.
  Entry expand(Penetration& result, double accuracy, bool untilInside) {
    for (;;) {
      const Entry next = queue_.top();
      const Plane& plane = planes_[next.face];
      if (!surface_.faces()[next.face].alive || plane.stamp != next.stamp) {
        queue_.pop();
        continue;
      }
      tryNormal(plane.normal);
      // `keepsBall` allows 3·2^-48 of the radii.
      const double lower = unit_ * next.distance + radii_ * (1 - 0x1p-46) - 2 * error_;
      result.lower = std::max(least_, lower);
      const double open = std::max(accuracy * result.lower, 0x1p-46 * size_);
      if ((untilInside && next.distance > 0) || !(best_ - result.lower > open) ||
          result.rounds == kMostRounds)
        return next;
      const std::uint32_t p = addPoint(plane.normal);
      if (!ConvexSurface::sees(points_, surface_.faces()[next.face], points_[p])) return next;
      ++result.rounds;
      surface_.add(points_, next.face, p);
      take();
    }
  }

  /// Adds the point of A − B that is farthest along n. Returns its index.
  std::uint32_t addPoint(const Vec3& n) {
    const Vector<double> d(n);
    const auto a = supportA_(d), b = supportB_(-d);
    const Vec3 pa(a.x.x, a.x.y, a.x.z), pb(b.x.x, b.x.y, b.x.z);
    pointsA_.push_back(pa);
    points_.push_back(pa - pb);
    return static_cast<std::uint32_t>(points_.size() - 1);
  }

  /// Computes the upper bound of the depth that this normal gives. Stores the bound and the normal
  /// if the bound is the least so far.
  void tryNormal(const Vec3& n) {
    const double upper = upperAlong(n);
    if (upper < best_) best_ = upper, bestNormal_ = n;
  }

  /// Returns an upper bound of the depth from the supporting planes with this normal; metres.
  double upperAlong(const Vec3& n) const {
    const double sum = a_.highest(n) + b_.highest(-n) + error_;
    if (std::isnan(sum)) return HUGE_VAL;  // n is not a direction, or a projection overflows
    const double width = std::max(0.0, sum);
    if (!along_) return roundedUp(width * (1 + 8 * kUnit));  // |n| ≥ 1 − 3u
    const double rate = n.dot(*along_) - 8 * kUnit;
    return rate > 0 ? roundedUp(width / rate) : HUGE_VAL;
  }

  /// Computes the planes of the new faces, and queues the faces. If there is a ray, queues only the
  /// faces through which the ray may leave.
  void take() {
    planes_.resize(surface_.faces().size());
    for (const std::uint32_t f : surface_.added()) take(f);
  }
  /// Computes the planes of all faces anew, and queues them as `take` does.
  void requeue() {
    queue_ = {};
    for (std::uint32_t f = 0; f < surface_.faces().size(); ++f)
      if (surface_.faces()[f].alive) take(f);
  }
  void take(std::uint32_t f) {
    const auto& corner = surface_.faces()[f].corner;
    const Vector<DoubleDouble> o(points_[corner[0]]);
    const Vector<DoubleDouble> p = Vector<DoubleDouble>(points_[corner[1]]) - o;
    const Vector<DoubleDouble> q = Vector<DoubleDouble>(points_[corner[2]]) - o;
    const Vector<DoubleDouble> n = cross(p, q);
    const DoubleDouble size = gjk::length(n);
    Plane& plane = planes_[f];
    ++plane.stamp;
    const double edges = static_cast<double>(gjk::length(p) * gjk::length(q));
    double distance = static_cast<double>(dot(n, o) / size);
    plane.normal = Vec3(static_cast<double>(n.x / size), static_cast<double>(n.y / size),
                        static_cast<double>(n.z / size));
    const double turned = 0x1p-90 * edges / static_cast<double>(size);
    distance -= turned * points_[corner[0]].norm() + 4 * kUnit * std::abs(distance);
    if (along_) {
      // All lengths are below 8 units. If the plane is nearly parallel to the ray, the code uses a
      // larger angle between them, which makes the lower bound smaller.
      const double rate = plane.normal.dot(*along_);
      if (rate < -0x1p-40) return;  // the ray does not leave through this face
      distance = (distance - 8 * (turned + 8 * kUnit)) / std::max(rate, 0x1p-40);
    }
    // A face whose plane cannot be computed, because its points are too close, must not be left
    // out.
    queue_.push({std::isfinite(distance) ? distance : -8.0, f, plane.stamp});
  }

  void finish(std::uint32_t f, Penetration& result) const {
    result.normal_W = bestNormal_;
    result.upper = best_;
    result.lower = std::min(result.lower, result.upper);
    result.direction_W = along_ ? *along_ : bestNormal_;
    // x is a point of the plane of the face: the point on the ray if there is a ray, or else the
    // point closest to the origin.
    const Plane& plane = planes_[f];
    const double depth = plane.normal.dot(points_[surface_.faces()[f].corner[0]]);
    const Vec3 x =
        along_ ? Vec3(*along_ * (depth / plane.normal.dot(*along_))) : Vec3(plane.normal * depth);
    // If several coplanar triangles form a larger face, x may be in another triangle than f; then
    // the loop walks to that triangle. `weight` holds the barycentric coordinates of x, up to a
    // factor.
    Vec3 weight;
    std::array<std::uint32_t, 3> corner{};
    for (int step = 0; step < 64; ++step) {
      corner = surface_.faces()[f].corner;
      int outside = -1;
      for (int k = 0; k < 3; ++k) {
        const Vec3 &q = points_[corner[(k + 1) % 3]], &r = points_[corner[(k + 2) % 3]];
        weight[k] = plane.normal.dot((q - x).cross(r - x));
        if (weight[k] < 0 && (outside < 0 || weight[k] < weight[outside])) outside = k;
      }
      if (outside < 0) break;
      f = surface_.faces()[f].across[(outside + 1) % 3];
    }
    weight = weight.cwiseMax(0);
    const double sum = weight.sum();
    Vec3 p_A = Vec3::Zero(), p_B = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      const double share = sum > 0 ? weight[k] / sum : k == 0;
      p_A += share * pointsA_[corner[k]];
      p_B += share * (pointsA_[corner[k]] - points_[corner[k]]);
    }
    const double a = radii_ > 0 ? a_.set().ball : 0, b = radii_ > 0 ? b_.set().ball : 0;
    result.p_WA = unit_ * p_A + a * bestNormal_;
    result.p_WB = unit_ * p_B - b * bestNormal_;
  }

  /// Returns the result for the case that all points are on one plane. Then the sets are flat, so
  /// only the spheres give a depth.
  Penetration flat() {
    Penetration result;
    Vec3 n = flatNormal();
    if (along_ && n.dot(*along_) < 0) n = -n;
    result.normal_W = n;
    result.direction_W = along_ ? *along_ : n;
    result.upper = upperAlong(n);
    result.lower = std::min(least_, result.upper);
    // The sets without their spheres have a common point. From this point, each sphere reaches
    // along the normal as far as its radius.
    ConvexSet coreA = a_.set(), coreB = b_.set();
    if (radii_ > 0) coreA.ball = coreB.ball = 0;
    const ConvexDistance common = convexDistance({coreA, a_.pose()}, {coreB, b_.pose()});
    const double a = radii_ > 0 ? a_.set().ball : 0, b = radii_ > 0 ? b_.set().ball : 0;
    result.p_WA = common.p_WA + a * n;
    result.p_WB = common.p_WA - b * n;
    return result;
  }

  /// Returns a unit vector that is orthogonal to all points' differences, up to rounding.
  Vec3 flatNormal() const {
    Vec3 longest = Vec3::Zero(), normal = Vec3::Zero();
    for (const Vec3& p : points_)
      if ((p - points_[0]).norm() > longest.norm()) longest = p - points_[0];
    for (const Vec3& p : points_)
      if (longest.cross(p - points_[0]).norm() > normal.norm())
        normal = longest.cross(p - points_[0]);
    if (normal.norm() > 0x1p-60) return normal.normalized();
    return longest.norm() > 0 ? longest.unitOrthogonal() : Vec3(Vec3::UnitX());
  }

  const PosedSet &a_, &b_;
  double size_, unit_;
  gjk::Support<double> supportA_, supportB_;
  const Vec3* along_;
  double radii_, error_;
  std::vector<Vec3> points_, pointsA_;  ///< points of A − B, and of A; in units
  ConvexSurface surface_;
  std::vector<Plane> planes_;
  std::priority_queue<Entry> queue_;
  double least_;            ///< a lower bound of the depth that is known from the beginning, metres
  double best_ = HUGE_VAL;  ///< the smallest of the upper bounds found so far, metres
  Vec3 bestNormal_ = Vec3::Zero();
};

void require(const PosedSet& a, const PosedSet& b, double accuracy) {
  if (!a.isFinite() || !b.isFinite())
    throw std::invalid_argument("penetration: the sets and their maps must be finite");
  if (!(accuracy >= 0 && accuracy < HUGE_VAL))
    throw std::invalid_argument("penetration: the accuracy must be finite and not negative");
}

}  // namespace

Penetration penetration(const PosedSet& a, const PosedSet& b, double accuracy) {
  require(a, b, accuracy);
  if (!convexSetsTouch(a, b)) return {};
  const bool ballsInCores = !(a.keepsBall() && b.keepsBall());
  const double radii = a.set().ball + b.set().ball;
  if (radii > 0 && !ballsInCores) {
    // If the cores do not touch, their distance gives the depth: the sum of the radii minus this
    // distance.
    ConvexSet coreA = a.set(), coreB = b.set();
    coreA.ball = coreB.ball = 0;
    const PosedSet setA(coreA, a.pose()), setB(coreB, b.pose());
    const ConvexDistance cores = convexDistance(setA, setB);
    if (cores.distance > 0) {
      Penetration result;
      const double size = a.reach() + a.pose().t.norm() + b.reach() + b.pose().t.norm();
      // The two terms are the error of the distance, and that of `keepsBall`.
      const double error = 8 * kUnit * size + 0x1p-46 * radii;
      result.lower = std::max(0.0, roundedDown(radii - cores.distance - error));
      result.upper = std::max(0.0, roundedUp(radii - cores.lower) + error);
      result.direction_W = result.normal_W = cores.normal_W;
      result.p_WA = cores.p_WA + a.set().ball * cores.normal_W;
      result.p_WB = cores.p_WB - b.set().ball * cores.normal_W;
      return result;
    }
  }
  return Expansion(a, b, nullptr, ballsInCores).run(accuracy);
}

Penetration penetrationAlong(const PosedSet& a, const PosedSet& b, const Vec3& direction,
                             double accuracy) {
  const double largest = direction.cwiseAbs().maxCoeff();
  if (!direction.allFinite() || !(largest > 0))
    throw std::invalid_argument("penetrationAlong: the direction must be finite and not 0");
  require(a, b, accuracy);
  if (!convexSetsTouch(a, b)) return {};
  const Vec3 along = (direction / powerOfTwo(largest)).normalized();
  return Expansion(a, b, &along, a.set().ball + b.set().ball > 0).run(accuracy);
}

}  // namespace corridor
