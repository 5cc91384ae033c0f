#include "planner/query/query_hulls.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <span>
#include <stdexcept>

#include "collision/convex/convex_contact.h"
#include "collision/convex/convex_distance.h"
#include "collision/convex/dobkin_kirkpatrick.h"
#include "collision/convex/penetration.h"
#include "collision/core/error.h"
#include "collision/core/quantiles.h"
#include "collision/core/spelling.h"
#include "collision/course/hierarchy_descent.h"
#include "collision/course/outer_hierarchy.h"
#include "collision/course/polytope_intersection.h"
#include "collision/course/query_timing.h"
#include "collision/course/separating_axes.h"
#include "collision/course/separating_plane.h"
#include "collision/course/vclip.h"
#include "planner/app/standard_streams.h"
#include "planner/query/query_batch.h"
#include "planner/query/query_output.h"

namespace corridor::app {
namespace {

/// The methods that run GJK. They take flat hulls, too.
const std::vector<std::string>& gjkMethods() {
  static const std::vector<std::string> names = {"hierarchy", "climbing", "every-vertex"};
  return names;
}

/// The hull of a mesh's vertices, with the structures that the methods need.
struct Hull {
  std::optional<DobkinKirkpatrick> hierarchy;
  std::optional<PolytopeFeatures> features;  ///< with vclip and axes
  std::optional<OuterHierarchy> outer;       ///< with barba-langerman; refers to `hierarchy`
  ConvexPart part;                           ///< the vertices of the hull; all, if it is flat
  double buildMs = 0;

  Hull(const Hull&) = delete;
  Hull(const HullInput& input, const std::string& method) {
    const auto start = std::chrono::steady_clock::now();
    std::vector<Vec3> used;  // the vertices of triangles; other vertices don't count
    std::vector<bool> taken(input.mesh.vertices.size(), false);
    for (const auto& triangle : input.mesh.triangles)
      for (const auto v : triangle)
        if (!taken[v]) taken[v] = true, used.push_back(input.mesh.vertices[v]);
    try {
      hierarchy.emplace(Polytope(used));
      if (method == "vclip" || method == "axes") features.emplace(*hierarchy);
      if (method == "barba-langerman") outer.emplace(*hierarchy);
    } catch (const std::invalid_argument& error) {
      if (method != "lp" && std::ranges::count(gjkMethods(), method) == 0)
        throw InputError(Fault{input.file, 0,
                               "--hulls " + method + " needs a solid hull: " + error.what() +
                                   "; use --hulls every-vertex"});
      hierarchy.reset();
      part.points = std::move(used);
      if (method == "hierarchy" || method == "climbing")
        std::cerr << "note: " << input.file << ": the hull is flat, so every vertex is tested\n";
    }
    buildMs =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    if (!hierarchy) return;
    const auto vertices = hierarchy->polytope().vertices();
    part.points.assign(vertices.begin(), vertices.end());
  }

  ConvexSet by(const std::string& method) const {
    if (hierarchy && method == "hierarchy") return *hierarchy;
    if (hierarchy && method == "climbing") return hierarchy->polytope();
    return part;
  }
  std::size_t levels() const { return hierarchy ? hierarchy->levels() : 0; }
  std::size_t bytes() const {
    return (hierarchy ? hierarchy->bytes() : 0) + (outer ? outer->bytes() : 0);
  }
};

/// The data that a query keeps for the next query (`coherent`).
struct LastQuery {
  ConvexCache simplex;
  FeaturePair features;
  SeparatingAxis axis;
};

std::string numbers(std::initializer_list<double> values) {
  std::string text;
  char number[32];
  for (const double value : values) {
    std::snprintf(number, sizeof number, ",%.17g", value);
    text += number;
  }
  return text;
}
std::string numbers(const Vec3& v) {
  return numbers({v.x(), v.y(), v.z()});
}

/// Prints a note if a coordinate is beyond the sizes for which GJK's answers are accurate
/// (`PosedSet`, collision/convex/convex_set.h).
void noteExtremeSizes(const HullInput& input) {
  const auto isExtreme = [](double x) {
    return x != 0 && !(std::abs(x) > 0x1p-440 && std::abs(x) < 0x1p440);
  };
  for (const Vec3& p : input.mesh.vertices)
    if (isExtreme(p.x()) || isExtreme(p.y()) || isExtreme(p.z())) {
      std::cerr << "note: " << input.file
                << ": a coordinate is not within 1e-132 to 1e132 m, so contacts may be reported "
                   "that do not exist, and distances may be too small\n";
      return;
    }
}

}  // namespace

const std::vector<std::string>& hullMethods() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = gjkMethods();
    all.insert(all.end(), {"lp", "vclip", "axes", "barba-langerman", "descent"});
    return all;
  }();
  return names;
}

void requireHullQuery(const std::string& method, const std::optional<std::string>& asked,
                      bool hasDirection, bool coherent) {
  const std::string query = asked.value_or("interference");
  const std::vector<std::string> queries = {"interference", "distance", "depth"};
  if (std::ranges::count(queries, query) == 0)
    throw InputError(Fault{"--query", 0,
                           "unknown query with --hulls: " + quotedWord(query) +
                               didYouMean(query, queries) + "; there are: " + joined(queries)});
  const bool keepsNothing = method == "lp" || method == "barba-langerman" || method == "descent";
  if (method == "descent" && query != "distance" && !(query == "depth" && hasDirection))
    throw InputError(
        Fault{"--hulls", 0, "descent needs --query distance, or --query depth with --direction"});
  if (method != "descent" && (keepsNothing || method == "axes") && query != "interference")
    throw InputError(Fault{"--hulls", 0, method + " needs --query interference"});
  if (method == "vclip" && query == "depth")
    throw InputError(Fault{"--hulls", 0, "vclip needs --query interference or distance"});
  if (coherent && (keepsNothing || query == "depth"))
    throw InputError(Fault{"--coherent", 0,
                           "can't be used with " +
                               (keepsNothing ? "--hulls " + method : "--query depth") +
                               ", which keeps nothing from pose to pose"});
}

void queryHulls(const HullInput& inputA, const HullInput& inputB,
                const std::vector<Transform>& poses, const std::string& method,
                const std::optional<std::string>& asked, const std::optional<Vec3>& direction,
                bool coherent, int repeat) {
  const std::string query = asked.value_or("interference");
  const Hull a(inputA, method), b(inputB, method);
  if (std::ranges::count(gjkMethods(), method) > 0)
    for (const HullInput& input : {inputA, inputB}) noteExtremeSizes(input);
  const ConvexSet setA = a.by(method), setB = b.by(method);
  std::string text = query == "interference" ? "pose,hit,steps\n"
                     : query == "distance"
                         ? "pose,distance,lower,nx,ny,nz,ax,ay,az,bx,by,bz,steps\n"
                         : "pose,lower,upper,nx,ny,nz,ax,ay,az,bx,by,bz,steps\n";
  BatchResult result;
  result.buildMsA = a.buildMs;
  result.buildMsB = b.buildMs;
  result.bytesA = a.bytes();
  result.bytesB = b.bytes();
  std::size_t hits = 0, allSteps = 0;
  LastQuery last;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const LastQuery before = coherent ? last : LastQuery{};
    bool hit = false;
    std::size_t steps = 0;
    std::string answer;
    const auto takeDistance = [&](const ConvexDistance& d) {
      hit = d.distance == 0;
      if (query == "distance")
        answer = numbers({d.distance, d.lower}) + numbers(d.normal_W) + numbers(d.p_WA) +
                 numbers(d.p_WB);
    };
    const auto ask = [&] {
      last = before;  // repeated calls do the same work
      if (method == "lp") {
        std::vector<Vec3> moved;
        for (const Vec3& p : b.part.points) moved.push_back(poses[i] * p);
        hit = separatingPlane<3>(std::span<const Vec3>(a.part.points), std::span<const Vec3>(moved))
                  .relation != HullRelation::disjoint;
        return;
      }
      if (method == "barba-langerman") {
        const PolytopeIntersection found = intersection(*a.hierarchy, {}, *b.outer, poses[i]);
        hit = found.intersects;
        steps = static_cast<std::size_t>(found.steps);
        return;
      }
      if (method == "axes") {
        last.axis = separatingAxis(*a.features, {}, *b.features, poses[i], &before.axis);
        hit = !last.axis.separated;
        steps = last.axis.faces + last.axis.edgePairs;
        return;
      }
      if (method == "vclip") {
        const ClosestFeatures found =
            closestFeatures(*a.features, {}, *b.features, poses[i], last.features);
        takeDistance(found.distance);
        steps = static_cast<std::size_t>(found.steps) + static_cast<std::size_t>(found.rounds);
        return;
      }
      if (method == "descent") {
        int pieces = 0;
        if (query == "distance") {
          takeDistance(distanceByDescent(*a.hierarchy, {}, *b.hierarchy, poses[i], &pieces));
        } else {
          const DepthByDescent d =
              depthByDescent(*a.hierarchy, {}, *b.hierarchy, poses[i], *direction, &pieces);
          hit = d.upper > 0;
          answer = numbers({0, d.upper}) + numbers(d.normal_W) + numbers({0, 0, 0, 0, 0, 0});
        }
        steps = static_cast<std::size_t>(pieces);
        return;
      }
      const PosedSet placedA(setA, {}), placedB(setB, poses[i]);
      if (query == "interference") {
        hit = convexSetsTouch(placedA, placedB, &last.simplex);
      } else if (query == "distance") {
        takeDistance(convexDistance(placedA, placedB, 0, 0, &last.simplex));
      } else {
        const Penetration d = direction ? penetrationAlong(placedA, placedB, *direction)
                                        : penetration(placedA, placedB);
        hit = d.upper > 0;
        answer = numbers({d.lower, d.upper}) + numbers(d.direction_W) + numbers(d.p_WA) +
                 numbers(d.p_WB);
        last.simplex.rounds = d.rounds;
      }
      steps = static_cast<std::size_t>(last.simplex.rounds);
    };
    std::vector<double> ns;
    try {
      for (int pass = 0; pass < repeat; ++pass) ns.push_back(nanosecondsOf(ask, ask));
    } catch (const std::invalid_argument& error) {
      throw InputError(Fault{"--hulls", 0,
                             method + " can't test pose " + std::to_string(i) + ": " +
                                 error.what() + "; use another method"});
    }
    result.answers.push_back({hit, 0, 0, medianOf(ns)});
    hits += hit;
    allSteps += steps;
    text += std::to_string(i) + (query == "interference" ? (hit ? ",1" : ",0") : answer) + ',' +
            std::to_string(steps) + '\n';
  }
  std::cout << text;
  requireResultsWritten();
  const double meanSteps =
      poses.empty() ? 0 : static_cast<double>(allSteps) / static_cast<double>(poses.size());
  printSummary(
      result,
      {"query=" + query, "hulls=" + method, std::string("coherent=") + (coherent ? "1" : "0"),
       "vertices_a=" + std::to_string(a.part.points.size()),
       "vertices_b=" + std::to_string(b.part.points.size()),
       "levels_a=" + std::to_string(a.levels()), "levels_b=" + std::to_string(b.levels()),
       "poses=" + std::to_string(poses.size()), "hits=" + std::to_string(hits),
       "steps=" + std::to_string(meanSteps)});
}

}  // namespace corridor::app
