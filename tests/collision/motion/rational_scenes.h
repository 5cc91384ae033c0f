#pragma once

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tests/support/sturm_contact.h"

namespace corridor::test {

/// A moving triangle and a fixed triangle, whose coordinates are dyadic fractions of few bits. Some
/// scenes are random near misses and hits. Others are first built so that two features meet exactly
/// during the motion. Then the fixed triangle is displaced a little, towards the moving one or away
/// from it. The oracle computes the first contact of the two triangles.
struct RationalScene {
  enum Kind {
    nearby,    ///< the fixed triangle is near the path of the moving one
    coplanar,  ///< both triangles and the motion are in one plane
    /// Features meet exactly at some time. The two triangles are then on opposite sides of a plane.
    meeting,
    tangential,  ///< like `meeting`; the velocity at the time of meeting is parallel to the plane
    kinds
  };
  Triangle fixed, moving;
  RationalMotion motion = RationalMotion::line({}, Vec3::Zero());
  int push = 0;  ///< the fixed triangle is moved by about 2^-push; 0: it is not moved

  RationalScene(std::mt19937_64& random, Kind kind, bool turns)
      : random_(random), flat_(kind == coplanar) {
    do {
      RigidPose from{vector(8), Eigen::Quaterniond::Identity()};
      for (bool again = whole(0, 1); again; again = from.q.squaredNorm() == 0) {
        const Vec3 v = kind == coplanar ? Vec3(0, 0, whole(-2, 2)) : vector(2);
        from.q = Eigen::Quaterniond(whole(-2, 2), v.x(), v.y(), v.z());
      }
      const int halvings = whole(0, 2);  // s0 = 2^-halvings
      const double s0 = std::ldexp(1, -halvings);
      if (turns) {
        const Vec3 n = flat_ ? Vec3(0, 0, whole(0, 1) ? 1 : -2) : nonZero(2);
        const int shorter = kind == nearby || kind == coplanar ? whole(0, 2) : 0;
        motion = RationalMotion::turn(from, std::ldexp(1, halvings - shorter) * n);
      } else {
        motion = RationalMotion::line(from, from.p + std::ldexp(1, halvings) * nonZero(6));
      }
      const auto pose = motion.at(s0);
      const Vec3 centre = pose.X.t / pose.weight;  // integers
      Triangle there;                              // the moving triangle at s0, in integers
      const Vec3 lever = vector(3);
      for (int i = 0; i < 3; ++i) {
        const Vec3 p = lever + vector(3);
        moving[i] = pose.weight * p;
        there[i] = centre + pose.X.m * p;
      }
      const Vec3 velocity = turns ? motion.m().cross(there[0] - centre).eval()
                                  : (motion.to().p - motion.from().p).eval();
      if (kind == nearby || kind == coplanar) {
        const double size = 1 + (there[1] - there[0]).cwiseAbs().maxCoeff();
        const Vec3 c = there[0] + vector(size / 2);
        for (Vec3& p : fixed) p = c + vector(size);
      } else {
        meet(there, kind == tangential ? velocity : Vec3::Zero());
      }
    } while (onALine(fixed) || onALine(moving));
    scale(1.0 / 32);
  }

 private:
  int whole(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }
  Vec3 vector(double size) {
    const int n = static_cast<int>(size);
    return Vec3(whole(-n, n), whole(-n, n), flat_ ? 0 : whole(-n, n));
  }
  Vec3 nonZero(int size) {
    Vec3 v = vector(size);
    while (v.isZero(0)) v = vector(size);
    return v;
  }
  static bool onALine(const Triangle& t) {  // exact, because coordinates have few bits
    return (t[1] - t[0]).cross(t[2] - t[0]).isZero(0);
  }

  /// Places the fixed triangle so that one of its features meets a feature of triangle b. If
  /// possible, the two triangles are on opposite sides of a plane; if `velocity` is not zero, this
  /// plane is parallel to `velocity` in most cases. Then chooses `push`, and moves the fixed
  /// triangle along the plane's normal by about 2^-push.
  void meet(const Triangle& b, const Vec3& velocity) {
    Vec3 n = nonZero(3);
    const int feature = whole(0, 4);
    const Vec3 along = nonZero(9);
    for (int i = 0; i < 40; ++i) {
      n = velocity.isZero(0) ? nonZero(3) : velocity.cross(nonZero(2)).eval();
      if (n.dot(b[1] - b[0]) >= 0 && n.dot(b[2] - b[0]) >= 0 && !n.isZero(0)) break;
    }
    if (feature == 3) n = (b[1] - b[0]).cross(along);
    if (feature == 4) n = (b[1] - b[0]).cross(b[2] - b[0]);
    if (feature >= 3 && n.dot(b[2] - b[0]) < 0) n = -n;
    const auto below = [&](const Vec3& d) { return n.dot(d) > 0 ? Vec3(-d) : d; };
    const auto level = [&] { return Vec3(n.cross(vector(3))); };
    const Vec3 d = below(nonZero(20)), e = below(nonZero(20));
    if (feature == 0) {  // a corner of b in the fixed face
      const Vec3 u = level(), v = level();
      fixed = {b[0] + u, b[0] + v, b[0] - u - v};
    } else if (feature == 1) {  // a corner of b on a fixed edge
      const Vec3 u = level();
      fixed = {b[0] + u, b[0] - 2 * u, b[0] + d};
    } else if (feature == 2) {  // two corners
      fixed = {b[0], b[0] + d, b[0] + e};
    } else if (feature == 3) {  // two edges
      const Vec3 middle = 0.5 * (b[0] + b[1]);
      fixed = {middle + along, middle - along, middle + d};
    } else {  // a corner of the fixed triangle in the face
      const Vec3 inside = 0.25 * b[0] + 0.25 * b[1] + 0.5 * b[2];
      fixed = {inside, inside + d, inside + e};
    }
    const std::array<int, 12> pushes = {0, 0, 0, 4, 8, 12, 16, 20, 23, 26, 32, 40};
    push = pushes[whole(0, 11)];
    if (push == 0 || n.isZero(0)) return;
    const double length = std::exp2(std::ilogb(n.cwiseAbs().maxCoeff()));
    const Vec3 step = std::ldexp((whole(0, 1) ? 1 : -1) / length, -push) * n;
    for (Vec3& p : fixed) p += step;
  }

  void scale(double factor) {
    for (Triangle* t : {&fixed, &moving})
      for (Vec3& p : *t) p *= factor;
    const RigidPose from{factor * motion.from().p, motion.from().q};
    motion = motion.m().isZero(0) ? RationalMotion::line(from, factor * motion.to().p)
                                  : RationalMotion::turn(from, motion.m());
  }

  std::mt19937_64& random_;
  bool flat_;  // whether all is in the plane z = 0
};

/// Motions whose first contact is known.
struct ClosedForm {
  std::string name;
  Triangle fixed, moving;
  RationalMotion motion;
  long double first;  ///< s; −1 if there is no contact
};

inline std::vector<ClosedForm> closedForms() {
  const double little = 0x1p-40;
  const auto along = [](const Vec3& p) { return RationalMotion::line({}, p); };
  // A rotation about z, from the x-axis to the y-axis: tan(θ/2) = s, cos θ = (1 − s²)/(1 + s²) and
  // sin θ = 2s/(1 + s²). At s = 1/3 a rod of length 5 ends at (4, 3).
  const auto turn = RationalMotion::turn({}, Vec3::UnitZ()),
             farther = RationalMotion::turn({}, 2 * Vec3::UnitZ());
  const Triangle blade = {Vec3(0, 0, 0), Vec3(5, 0, 0), Vec3(0, 0, 1)},
                 flat = {Vec3(0, 0, 0), Vec3(5, 0, 0), Vec3(0, -1, 0)},
                 sheet = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const auto plate = [](double y) {
    return Triangle{Vec3(-40, y, -40), Vec3(80, y, -40), Vec3(0, y, 80)};
  };
  const auto mast = [](double r) {  // an edge along z at r·(4, 3); the rotating rod meets it before
                                    // the other points
    return Triangle{Vec3(4 * r, 3 * r, -9), Vec3(4 * r, 3 * r, 9), Vec3(8, 60, 0)};
  };
  // A triangle parallel to the xy-plane. The rotating rod meets its tip, at (2, 1.5), before its
  // other points.
  const auto thorn = [](double z) {
    return Triangle{Vec3(2, 1.5, z), Vec3(8, 60, z), Vec3(9, 60, z)};
  };
  // The tip is at height 5 − little where 2s/(1 + s²) = 1 − little/5 =: h, s = (1 − √(1 − h²))/h.
  const long double below = little / 5.0L,
                    almost = (1 - std::sqrt(below * (2 - below))) / (1 - below);
  return {
      {"a rod's tip hits a plate", plate(3), blade, turn, 1 / 3.0L},
      {"a rod's tip hits a plate after 30 degrees", plate(2.5), blade, turn, 2 - std::sqrt(3.0L)},
      {"a rod's tip grazes a plate at the end", plate(5), blade, turn, 1},
      {"a rod's tip grazes a plate on the way", plate(5), blade, farther, 0.5L},
      {"a rod's tip misses a plate", plate(5 + little), blade, farther, -1},
      {"a rod's tip hardly hits a plate", plate(5 - little), blade, farther, almost / 2},
      {"a blade meets a mast", mast(0.5), blade, turn, 1 / 3.0L},
      {"a blade meets a mast with its tip", mast(1), blade, turn, 1 / 3.0L},
      {"a blade misses a mast out of reach", mast(1.5), blade, turn, -1},
      {"a blade meets a point", thorn(0.125), blade, turn, 1 / 3.0L},
      {"a blade meets a point on its edge", thorn(0), blade, turn, 1 / 3.0L},
      {"a blade misses a point below", thorn(-little), blade, turn, -1},
      {"a blade misses a point above", thorn(0.51), blade, turn, -1},
      {"turning in the plane of both, a point", thorn(0), flat, turn, 1 / 3.0L},
      {"turning in the plane of both, an edge",
       {Vec3(-40, 3, 0), Vec3(80, 3, 0), Vec3(0, 80, 0)},
       flat,
       turn,
       1 / 3.0L},
      {"sliding in the plane of both, corners",
       {Vec3(3, 0, 0), Vec3(5, -1, 0), Vec3(5, -2, 0)},
       sheet,
       along(Vec3(4, 0, 0)),
       0.5L},
      {"sliding in the plane of both, an edge",
       {Vec3(3, -1, 0), Vec3(3, 1, 0), Vec3(5, 0, 0)},
       sheet,
       along(Vec3(4, 0, 0)),
       0.5L},
      {"along an edge",
       {Vec3(3, 0, 0), Vec3(5, 0, 0), Vec3(4, -1, 0)},
       sheet,
       along(Vec3(4, 0, 0)),
       0.5L},
      {"beside an edge",
       {Vec3(3, -little, 0), Vec3(5, -little, 0), Vec3(4, -1, 0)},
       sheet,
       along(Vec3(4, 0, 0)),
       -1},
      {"over a face",
       {Vec3(3, -9, -little), Vec3(3, 9, -little), Vec3(9, 0, -little)},
       sheet,
       along(Vec3(4, 0, 0)),
       -1},
      {"onto a face",
       {Vec3(-9, -9, 1), Vec3(-9, 9, 1), Vec3(9, 0, 1)},
       sheet,
       along(Vec3(0, 0, 4)),
       0.25L},
      {"edges cross",
       {Vec3(3, -1, -1), Vec3(3, 1, 1), Vec3(9, 1, 0)},
       {Vec3(0, 1, -1), Vec3(0, -1, 1), Vec3(-5, 0, 0)},
       along(Vec3(4, 0, 0)),
       0.75L},
      {"together at the start",
       {Vec3(0, 0, -1), Vec3(0, 0, 1), Vec3(1, 0, 0)},
       sheet,
       along(Vec3(4, 0, 0)),
       0},
  };
}

}  // namespace corridor::test
