// Fuzz target: two bodies under two maps. Queries on 4-wide OBB trees and on binary trees of every
// kind of volume must agree, within the errors that collision/queries promises.
#include <cmath>
#include <set>

#include "collision/geometry/mesh_health.h"
#include "collision/hierarchy/with_trees.h"
#include "collision/queries/contacts.h"
#include "collision/queries/interference_obb4.h"
#include "collision/world/body_queries.h"
#include "tests/stress/fuzz/decode.h"
#include "tests/stress/fuzz/fuzz.h"

namespace corridor::fuzz {
namespace {

struct Kind {
  std::string name;
  TreeKind trees;
};
/// Returns all kinds of trees, the 4-wide OBB tree first.
const std::vector<Kind>& everyKind() {
  static const std::vector<Kind> kinds = [] {
    std::vector<Kind> all;
    for (const VolumeKind& volume : volumeKinds())
      for (const std::string& overlap : volume.overlaps)
        all.push_back(
            {volume.name + " by " + overlap, treesNamed({volume.name, "", overlap}).trees});
    return all;
  }();
  return kinds;
}

/// Returns a body, or nullopt if the bytes make no valid body.
std::optional<Body> decodeBody(Decoder& in) {
  const std::size_t kind = in.below(4);
  if (kind == 0) {
    std::vector<ConvexPart> parts;
    for (std::size_t n = in.oneIn(2) ? 1 : 1 + in.below(9); n > 0; --n) {
      parts.push_back(in.part());
      for (const Vec3& p : parts.back().points)
        if (!p.allFinite()) return std::nullopt;
    }
    return Body("parts", std::move(parts));
  }
  TreeParams params;
  params.fit = static_cast<ObbFit>(in.below(3));
  params.split = in.oneIn(2) ? SplitRule::median : SplitRule::mean;
  params.building = in.oneIn(3) ? TreeBuilding::bottomUp : TreeBuilding::topDown;
  const bool solid = kind == 1;
  TriangleMesh mesh = solid ? in.closedMesh() : in.mesh();
  if (checkMesh(mesh)) return std::nullopt;
  try {
    return Body(solid ? "solid" : "surface", std::move(mesh), solid, params);
  } catch (const std::invalid_argument&) {
    if (!solid) throw;
    return std::nullopt;  // corners coincide, so the surface is not closed
  }
}

/// Returns the largest component of |m||v| + |t| over all corners v: the rounding of mapped
/// triangles is proportional to this length.
double scaleOfCorners(const TriangleMesh& mesh, const Transform& X) {
  double most = 0;
  for (const Vec3& v : mesh.vertices)
    most = std::max(most, (X.m.cwiseAbs() * v.cwiseAbs() + X.t.cwiseAbs()).maxCoeff());
  return most;
}

/// Returns the largest ‖m‖_F·(|v| + r) + |t| over all corners v, where r is the radius of the
/// convex part (0 for a mesh). The rounding of pairs with convex parts is proportional to this
/// length.
double scaleOfParts(const Body& body, const Transform& X) {
  double farthest = 0;
  for (const ConvexPart& part : body.parts())
    for (const Vec3& p : part.points) farthest = std::max(farthest, p.stableNorm() + part.radius);
  for (const Vec3& v : body.mesh().vertices) farthest = std::max(farthest, v.stableNorm());
  return X.m.reshaped().stableNorm() * farthest + X.t.stableNorm();
}

struct Case {
  const Body& a;
  const Body& b;
  Transform X_WA, X_WB;
};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

void compare(const Case& c, double asked) {
  const bool meshes = c.a.isMesh() && c.b.isMesh();
  const double S =
      meshes ? std::max(scaleOfCorners(c.a.mesh(), c.X_WA), scaleOfCorners(c.b.mesh(), c.X_WB))
             : std::max(scaleOfParts(c.a, c.X_WA), scaleOfParts(c.b, c.X_WB));
  if (!std::isfinite(S)) return;
  // With primitives, the verdict of contact is exact only if the distance or depth exceeds 2^-44
  // times the largest coordinate. The comparison allows 2^-42.
  const double band = meshes ? 0 : 0x1p-42 * S;
  const auto error = [&](double d) { return 1e-12 * d + 4 * 0x1p-53 * S + band + 0x1p-998; };

  struct TouchAndDistance {
    bool touch;
    double distance;
  };
  std::vector<TouchAndDistance> byKind;
  QueryContext context;  // the same for all queries: the pairs that it stores must not change an
                         // answer
  for (const Kind& kind : everyKind()) {
    const bool touch =
        interference(Posed(c.a, c.X_WA), Posed(c.b, c.X_WB), context, kind.trees).has_value();
    const Distance d = distance(Posed(c.a, c.X_WA), Posed(c.b, c.X_WB), {}, context, kind.trees);
    if (!(d.distance >= 0 && std::isfinite(d.distance)))
      fail(kind.name + ": a distance of " + number(d.distance));
    if (touch != (d.distance == 0))
      fail(kind.name + ": contact is " + std::to_string(touch) + ", distance " +
           number(d.distance));
    const double between = (d.p_WA - d.p_WB).stableNorm();
    if (!(std::abs(between - d.distance) <= 1e-11 * d.distance + 0x1p-44 * S + band + 0x1p-998))
      fail(kind.name + ": distance " + number(d.distance) + ", of points " + number(between) +
           " apart");
    const bool back =
        interference(Posed(c.b, c.X_WB), Posed(c.a, c.X_WA), context, kind.trees).has_value();
    if (back != touch && d.distance > band)
      fail(kind.name + ": contact is " + std::to_string(touch) + ", the other way round " +
           std::to_string(back));
    byKind.push_back({touch, d.distance});
    const TouchAndDistance& first = byKind.front();
    const std::string both = everyKind().front().name + " and " + kind.name;
    if (touch != first.touch && std::max(first.distance, d.distance) > band)
      fail(both + ": contact is " + std::to_string(first.touch) + " and " + std::to_string(touch) +
           ", at distances " + number(first.distance) + " and " + number(d.distance));
    if (std::abs(first.distance - d.distance) > error(first.distance) + error(d.distance))
      fail(both + ": distances " + number(first.distance) + " and " + number(d.distance));
    const double rough =
        distance(Posed(c.a, c.X_WA), Posed(c.b, c.X_WB), {0.25, 0}, context, kind.trees).distance;
    if (!(rough >= d.distance - 2 * error(d.distance) &&
          rough <= 1.25 * d.distance + 3 * error(d.distance)))
      fail(kind.name + ": distance " + number(d.distance) +
           ", with a relative error of 0.25 allowed " + number(rough));
  }
  const double d = byKind.front().distance;
  for (const double x : {asked, d, d * (1 + 1e-9), d * (1 - 1e-9), 0.5 * d}) {
    if (!std::isfinite(x)) continue;
    for (const Kind& kind : everyKind()) {
      const bool closer =
          closerThan(Posed(c.a, c.X_WA), Posed(c.b, c.X_WB), x, context, kind.trees);
      if (closer ? d > x + 2 * error(x) + error(d) : d < x - error(d))
        fail(kind.name + ": distance " + number(d) + ", but closer than " + number(x) + " is " +
             std::to_string(closer));
    }
  }
}

using Pairs = std::multiset<std::pair<std::uint32_t, std::uint32_t>>;

template <class Contacts>
Pairs pairsOf(const Contacts& contacts) {
  Pairs pairs;
  for (const TriangleContact& contact : contacts) pairs.insert({contact.a, contact.b});
  return pairs;
}

void compareContacts(const Case& c) {
  if (!c.a.isMesh() || !c.b.isMesh()) return;
  QueryContext context;
  const Pairs wide = pairsOf(contacts(Posed(c.a, c.X_WA), Posed(c.b, c.X_WB), context));
  for (const Kind& kind : everyKind()) {
    const Pairs pairs =
        pairsOf(contacts(Posed(c.a, c.X_WA), Posed(c.b, c.X_WB), context, kind.trees));
    if (pairs != wide)
      fail(kind.name + ": " + std::to_string(pairs.size()) + " contacts, 4-wide trees have " +
           std::to_string(wide.size()));
  }
}

}  // namespace
}  // namespace corridor::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace corridor;
  fuzz::Decoder in(data, size);
  static constexpr double limits[] = {1e3, 1e6, 1e9, 1e60};
  in.limit(limits[in.below(4)]);
  const bool rigid = !in.oneIn(4);
  const Transform X_WA = rigid ? in.map() : in.anyMap(), X_WB = rigid ? in.map() : in.anyMap();
  const double asked = std::abs(in.real());
  const std::optional<Body> a = fuzz::decodeBody(in), b = fuzz::decodeBody(in);
  if (!a || !b || !X_WA.isFinite() || !X_WB.isFinite()) return 0;
  const fuzz::Case c{*a, *b, X_WA, X_WB};
  fuzz::compare(c, asked);
  fuzz::compareContacts(c);
  return 0;
}
