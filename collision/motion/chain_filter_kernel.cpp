#include "collision/motion/chain_filter_kernel.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collision/motion/chain_filter_kernel.cpp"
#include "hwy/foreach_target.h"
// Highway requires this include after foreach_target.h.
#include "hwy/highway.h"
// Compiled once per target.
#include "collision/motion/float_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Every bound is a sum of positive terms with at most 256 roundings: (1 + 2^-24)^256 < 1 + 2^-15.
constexpr float kUp = 1 + 0x1p-15f;

/// What both kernels compute in the eight intervals of one set.
class Lanes {
 public:
  Lanes(const ChainTables& tables, const ChainEdge& edge, const ChainScratch::JointLanes* joints)
      : tables_(tables), edge_(edge), joints_(joints), zero_(F8::of(0)) {}

  const ChainScratch::JointLanes& joint(std::uint32_t number) const { return joints_[number]; }
  V3 noVector() const { return {zero_, zero_, zero_}; }

  /// Returns the place of a point that is fixed to a joint, or to the world.
  V3 place(std::uint32_t number, const float* p) const {
    if (number == ChainTables::kNone) return {F8::of(p[0]), F8::of(p[1]), F8::of(p[2])};
    const ChainScratch::JointLanes& j = joints_[number];
    return turned(j, p) + V3::load(j.t);
  }
  V3 turned(const ChainScratch::JointLanes& j, const float* v) const {
    const auto row = [&](int r) {
      return v[0] * F8::load(j.m[3 * r]) + v[1] * F8::load(j.m[3 * r + 1]) +
             v[2] * F8::load(j.m[3 * r + 2]);
    };
    return {row(0), row(1), row(2)};
  }

  /// Sums over joints, from the body to the observer: the displacement, for the point alone; for
  /// points within a reach of it; the rate and the second derivative of relative_motion.cpp.
  struct Sums {
    F8 center, around, rate, second;
  };
  Sums noMotion() const { return {zero_, zero_, zero_, zero_}; }
  void addJoint(std::uint32_t number, const V3& at, float reach, Sums& sums) const {
    const ChainScratch::JointLanes& j = joints_[number];
    if (!(j.amount > 0)) return;
    if (tables_.joints[number].slides) {
      sums.center = sums.center + j.amount;
      sums.around = sums.around + j.amount;
      sums.rate = sums.rate + j.amount;
      return;
    }
    const V3 x = cross(V3::load(j.axis), at - V3::load(j.t));
    const F8 r = root(dot(x, x)) + edge_.lever, far = r + reach;
    const F8 onward = j.amount * (far + sums.around);
    sums.second = sums.second + j.amount * (onward + 2 * sums.rate);
    sums.rate = sums.rate + onward;
    sums.around = sums.around + j.amount * far;
    sums.center = sums.center + j.amount * r;
  }
  /// The bound of the second order. @param amounts the sum of the joints' amounts, of which the
  /// first-order terms are off.
  F8 secondOf(const Sums& sums, float amounts) const {
    return (kUp * 0.5f) * sums.second + edge_.firstOrder * amounts * kUp;
  }
  /// The bound in all directions. @param velocity the first-order displacement.
  F8 isotropicOf(const Sums& sums, const F8& second, const V3& velocity) const {
    return kUp * smaller(sums.center, root(dot(velocity, velocity)) + second);
  }

  /// The motion of b as seen from a: a point x moves by linear + angular × x.
  struct Twist {
    V3 angular, linear;
    float amounts = 0;  ///< of the joints of both chains
  };
  Twist twistOf(std::uint32_t jointA, std::uint32_t jointB) const {
    Twist twist{noVector(), noVector()};
    if (jointB != ChainTables::kNone) {
      const ChainScratch::JointLanes& b = joints_[jointB];
      twist = {V3::load(b.angular), V3::load(b.linear), b.sum};
    }
    if (jointA != ChainTables::kNone) {
      const ChainScratch::JointLanes& a = joints_[jointA];
      twist.angular = twist.angular - V3::load(a.angular);
      twist.linear = twist.linear - V3::load(a.linear);
      twist.amounts += a.sum;
    }
    return twist;
  }

 protected:
  const ChainTables& tables_;
  const ChainEdge& edge_;
  const ChainScratch::JointLanes* joints_;
  const F8 zero_;
};

/// Places the joints of all sets and tests balls.
class Balls : Lanes {
 public:
  Balls(const ChainTables& tables, ChainScratch& scratch)
      : Lanes(tables, scratch.edge, nullptr), scratch_(scratch) {}

  void run() {
    const double h = edge_.still ? 0 : 0.0625 / edge_.sets;
    for (set_ = 0; set_ < edge_.sets; ++set_) {
      const double first = edge_.still ? 0 : (16 * set_ + 1) * h;
      ChainScratch::JointLanes* const joints =
          scratch_.joints.data() + static_cast<std::size_t>(set_) * tables_.joints.size();
      joints_ = joints;
      for (std::size_t j = 0; j < tables_.joints.size(); ++j) placeJoint(j, first, h, joints[j]);
      for (std::size_t i = 0; i < tables_.links.size(); ++i) placeLink(i);
      for (const std::uint32_t k : tables_.linkPairs)
        if (edge_.proved.empty() || !edge_.proved[tables_.scene.pairs[k].number]) testLinks(k);
      for (std::size_t i = 0; i < tables_.links.size(); ++i)
        if (tables_.links[i].hasObstacles) testObstacles(i);
    }
  }

 private:
  /// Computes pose and velocity of a joint at the times first + 2h·lane.
  void placeJoint(std::size_t j, double first, double h, ChainScratch::JointLanes& out) const {
    const ChainTables::Joint& joint = tables_.joints[j];
    const ChainEdge::Joint& motion = edge_.joints[j];
    const bool hasParent = joint.parent != ChainTables::kNone;
    const ChainScratch::JointLanes* parent = hasParent ? &joints_[joint.parent] : nullptr;
    F8 local[9];
    V3 shift = {F8::of(motion.shift[0]), F8::of(motion.shift[1]), F8::of(motion.shift[2])};
    if (joint.slides) {
      alignas(32) float times[8];
      for (int l = 0; l < 8; ++l) times[l] = static_cast<float>(first + 2 * l * h);
      const F8 t = F8::load(times);
      shift = {shift.x + motion.slide[0] * t, shift.y + motion.slide[1] * t,
               shift.z + motion.slide[2] * t};
      for (int k = 0; k < 9; ++k) local[k] = F8::of(joint.fixed[k]);
    } else {
      alignas(32) float sines[8], versines[8];
      turns(motion.angle + first * motion.rate, 2 * h * motion.rate, sines, versines);
      const F8 s = F8::load(sines), v = F8::load(versines);
      for (int k = 0; k < 9; ++k)
        local[k] = F8::of(joint.fixed[k]) + joint.sine[k] * s + joint.versine[k] * v;
    }
    const F8 ax = F8::of(joint.axis[0]), ay = F8::of(joint.axis[1]), az = F8::of(joint.axis[2]);
    V3 t = shift, axis = {ax, ay, az}, angular = {zero_, zero_, zero_}, linear = angular;
    if (!parent) {
      for (int k = 0; k < 9; ++k) local[k].store(out.m[k]);
    } else {
      F8* const at[3] = {&t.x, &t.y, &t.z};
      F8* const along[3] = {&axis.x, &axis.y, &axis.z};
      for (int r = 0; r < 3; ++r) {
        const F8 a = F8::load(parent->m[3 * r]), b = F8::load(parent->m[3 * r + 1]),
                 c = F8::load(parent->m[3 * r + 2]);
        for (int k = 0; k < 3; ++k)
          (a * local[k] + b * local[3 + k] + c * local[6 + k]).store(out.m[3 * r + k]);
        *at[r] = a * shift.x + b * shift.y + c * shift.z + F8::load(parent->t[r]);
        *along[r] = a * ax + b * ay + c * az;
      }
      angular = V3::load(parent->angular);
      linear = V3::load(parent->linear);
    }
    out.amount = static_cast<float>(h) * motion.largestRate * kUp;
    out.sum = (out.amount + (parent ? parent->sum : 0)) * kUp;
    if (out.amount > 0) {
      const V3 turn = F8::of(static_cast<float>(h * motion.rate)) * axis;
      if (joint.slides) {
        linear = linear + turn;
      } else {
        angular = angular + turn;
        linear = linear + cross(t, turn);
      }
    }
    t.store(out.t), axis.store(out.axis), angular.store(out.angular), linear.store(out.linear);
  }

  /// Sines and versines of the angles first + lane·step, by products of complex numbers.
  static void turns(double first, double step, float* sines, float* versines) {
    double c[8], s[8];
    c[0] = std::cos(first), s[0] = std::sin(first);
    double cw = std::cos(step), sw = std::sin(step);
    for (int n = 1; n < 8; n *= 2) {
      for (int l = 0; l < n; ++l) {
        c[n + l] = c[l] * cw - s[l] * sw;
        s[n + l] = s[l] * cw + c[l] * sw;
      }
      const double c2 = cw * cw - sw * sw, s2 = 2 * cw * sw;
      cw = c2, sw = s2;
    }
    for (int l = 0; l < 8; ++l) {
      sines[l] = static_cast<float>(s[l]);
      versines[l] = static_cast<float>(1 - c[l]);
    }
  }

  void placeLink(std::size_t i) {
    const ChainTables::Link& link = tables_.links[i];
    ChainScratch::LinkLanes& out = scratch_.links[i];
    const V3 center = place(link.joint, link.center);
    const Twist twist = twistOf(ChainTables::kNone, link.joint);
    const V3 velocity = twist.linear + cross(twist.angular, center);
    Sums sums = noMotion();
    for (std::uint32_t j = link.joint; j != ChainTables::kNone; j = tables_.joints[j].parent)
      addJoint(j, center, 0, sums);
    const F8 second = secondOf(sums, twist.amounts);
    center.store(out.center);
    velocity.store(out.velocity);
    second.store(out.second);
    isotropicOf(sums, second, velocity).store(out.isotropic);
  }

  void leaveOpen(std::uint32_t pair, unsigned lanes, float closeness) {
    if (!lanes) return;
    ChainScratch::Masks& masks = scratch_.open[pair];
    if (std::ranges::all_of(masks, [](std::uint8_t m) { return m == 0; }))
      scratch_.openPairs.push_back({pair, closeness});
    masks[static_cast<std::size_t>(set_)] = static_cast<std::uint8_t>(lanes);
  }

  void testLinks(std::uint32_t number) {
    const ChainScene::Pair& pair = tables_.scene.pairs[number];
    const ChainTables::Link &a = tables_.links[pair.a], &b = tables_.links[pair.b];
    const ChainScratch::LinkLanes &lanesA = scratch_.links[pair.a],
                                  &lanesB = scratch_.links[pair.b];
    const float radii = (a.radius + b.radius + (edge_.margins[number] + edge_.pad) * kUp) * kUp;
    const V3 center = V3::load(lanesB.center), between = center - V3::load(lanesA.center);
    const F8 square = dot(between, between);
    const F8 reach = F8::load(lanesA.isotropic) + F8::load(lanesB.isotropic) + radii;
    if (isGreater(square, kUp * (reach * reach)) == kAll) return;
    const Twist twist = twistOf(a.joint, b.joint);
    const V3 velocity = twist.linear + cross(twist.angular, center);
    Sums sums = noMotion();
    for (const std::uint32_t joint : tables_.pathOf(number)) addJoint(joint, center, 0, sums);
    const F8 second = secondOf(sums, twist.amounts);
    const F8 own = isotropicOf(sums, second, velocity) + radii;
    unsigned apart = isGreater(square, kUp * (own * own));
    if (apart != kAll) apart |= isApartAlong(root(square), dot(between, velocity), radii, second);
    leaveOpen(number, kAll & ~apart, HUGE_VALF);  // contacts with obstacles are more likely
  }
  /// The lanes in which the gap along a direction outlasts the motion.
  /// @param along the product of the velocity with a vector of this direction and of `length`.
  unsigned isApartAlong(const F8& length, const F8& along, float radii, const F8& second) const {
    const F8 gap = length - kUp * (second + radii);
    return isGreater(gap, zero_) & isGreater(gap * length, kUp * magnitude(along));
  }

  void testObstacles(std::size_t i) {
    const ChainTables::Link& link = tables_.links[i];
    const ChainScratch::LinkLanes& lanes = scratch_.links[i];
    const V3 center = V3::load(lanes.center);
    const F8 around =
        kUp * (F8::load(lanes.isotropic) + (link.radius + edge_.pad + edge_.largestMargin) * kUp);
    const F8 low[3] = {F8::of(least(center.x - around)), F8::of(least(center.y - around)),
                       F8::of(least(center.z - around))};
    const F8 high[3] = {F8::of(largest(center.x + around)), F8::of(largest(center.y + around)),
                        F8::of(largest(center.z + around))};
    const std::uint32_t* const pairs = tables_.worldPairs.data() + i * tables_.obstacles.size();
    for (std::size_t base = 0; base < tables_.lower[0].size(); base += 8) {
      unsigned far = 0;
      for (std::size_t k = 0; k < 3; ++k)
        far |= isGreater(F8::loadAny(&tables_.lower[k][base]), high[k]) |
               isGreater(low[k], F8::loadAny(&tables_.upper[k][base]));
      for (unsigned near = kAll & ~far; near; near &= near - 1) {
        const std::size_t o = base + static_cast<std::size_t>(__builtin_ctz(near));
        if (o < tables_.obstacles.size() && pairs[o] != ChainTables::kNone)
          testObstacle(link, lanes, tables_.obstacles[o], pairs[o]);
      }
    }
  }
  void testObstacle(const ChainTables::Link& link, const ChainScratch::LinkLanes& lanes,
                    const ChainTables::Obstacle& obstacle, std::uint32_t pair) {
    const float radius =
        (link.radius + (edge_.margins[pair] + edge_.pad + obstacle.pad) * kUp) * kUp;
    const Nearest nearest = nearestOf(obstacle, V3::load(lanes.center));
    const F8 reach = F8::load(lanes.isotropic) + radius;
    unsigned apart = isGreater(nearest.square, kUp * (reach * reach));
    if (apart != kAll)
      apart |= isApartAlong(root(nearest.square),
                            dot(nearest.d, inAxesOf(obstacle, V3::load(lanes.velocity))), radius,
                            F8::load(lanes.second));
    leaveOpen(pair, kAll & ~apart,
              least(nearest.square) / std::max(link.radius * link.radius, 1e-30f));
  }

  /// The vector from the nearest point of an obstacle, in the obstacle's axes, and its square.
  struct Nearest {
    V3 d;
    F8 square;
  };
  Nearest nearestOf(const ChainTables::Obstacle& o, const V3& at) const {
    const V3 l = inAxesOf(o, {at.x - o.center[0], at.y - o.center[1], at.z - o.center[2]});
    const auto beyond = [&](const F8& x, float half) {
      return larger(x - half, zero_) + smaller(x + half, zero_);
    };
    Nearest nearest;
    if (!o.isCylinder) {
      nearest.d = {beyond(l.x, o.half[0]), beyond(l.y, o.half[1]), beyond(l.z, o.half[2])};
    } else {
      const F8 rho = root(l.x * l.x + l.y * l.y) + 1e-20f;
      const F8 part = larger(rho - o.half[0], zero_) / rho;
      nearest.d = {l.x * part, l.y * part, beyond(l.z, o.half[2])};
    }
    nearest.square = dot(nearest.d, nearest.d);
    return nearest;
  }
  static V3 inAxesOf(const ChainTables::Obstacle& o, const V3& v) {
    const auto column = [&](int k) {
      return o.axes[k] * v.x + o.axes[3 + k] * v.y + o.axes[6 + k] * v.z;
    };
    return {column(0), column(1), column(2)};
  }

  ChainScratch& scratch_;
  int set_ = 0;
};

void testBalls(const ChainTables& tables, ChainScratch& scratch) {
  Balls(tables, scratch).run();
}

unsigned testHull(const ChainTables& tables, const ChainScratch& scratch, std::uint32_t number,
                  int set, const float* n, float highest) {
  const ChainScene::Pair& pair = tables.scene.pairs[number];
  const ChainEdge& edge = scratch.edge;
  const Lanes lanes(tables, edge,
                    scratch.joints.data() + static_cast<std::size_t>(set) * tables.joints.size());
  const std::uint32_t jointA = pair.isWorld ? ChainTables::kNone : tables.links[pair.a].joint;
  const ChainTables::Link& b = tables.links[pair.b];
  const Lanes::Twist twist = lanes.twistOf(jointA, b.joint);
  V3 along = {F8::of(n[0]), F8::of(n[1]), F8::of(n[2])}, from = lanes.noVector();
  if (jointA != ChainTables::kNone) {
    along = lanes.turned(lanes.joint(jointA), n);
    from = V3::load(lanes.joint(jointA).t);
  }
  // A point p of b is at M p + t. It is n·(M p + t − from) = m·p + height above a's origin, and
  // moves by n·(linear + angular × (M p + t)) = k·p + shift.
  const V3 across = cross(along, twist.angular);
  V3 m = along, k = across, t = lanes.noVector();
  if (b.joint != ChainTables::kNone) {
    const ChainScratch::JointLanes& joint = lanes.joint(b.joint);
    const auto back = [&](const V3& v) {
      const auto column = [&](int c) {
        return v.x * F8::load(joint.m[c]) + v.y * F8::load(joint.m[3 + c]) +
               v.z * F8::load(joint.m[6 + c]);
      };
      return V3{column(0), column(1), column(2)};
    };
    m = back(along), k = back(across), t = V3::load(joint.t);
  }
  const F8 height = dot(along, t - from);
  const F8 shift = dot(along, twist.linear) + dot(across, t);
  const std::size_t count = b.points.size() / 3;
  const float *x = b.points.data(), *y = x + count, *z = y + count;
  F8 lowest = F8::of(HUGE_VALF);  // no number is NaN: the minimum would drop it
  for (std::size_t i = 0; i < count; ++i) {
    const F8 px = F8::of(x[i]), py = F8::of(y[i]), pz = F8::of(z[i]);
    lowest = smaller(
        m.x * px + m.y * py + m.z * pz + height - magnitude(k.x * px + k.y * py + k.z * pz + shift),
        lowest);
  }
  Lanes::Sums sums = lanes.noMotion();
  const V3 center = lanes.place(b.joint, b.center);
  for (const std::uint32_t joint : tables.pathOf(number))
    lanes.addJoint(joint, center, b.core, sums);
  const float needed = (edge.margins[number] + edge.pad + edge.lever + b.swept) * kUp;
  return isGreater(lowest - highest, kUp * (lanes.secondOf(sums, twist.amounts) + needed));
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corridor {

HWY_EXPORT(testBalls);
HWY_EXPORT(testHull);

void separateBalls(const ChainTables& tables, ChainScratch& scratch) {
  HWY_DYNAMIC_DISPATCH(testBalls)(tables, scratch);
}

unsigned separateHull(const ChainTables& tables, const ChainScratch& scratch, std::uint32_t pair,
                      int set, const std::array<float, 3>& n, float highest) {
  return HWY_DYNAMIC_DISPATCH(testHull)(tables, scratch, pair, set, n.data(), highest);
}

}  // namespace corridor
#endif
