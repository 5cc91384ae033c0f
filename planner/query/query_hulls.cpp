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
#include "collision/core/error.h"
#include "collision/core/quantiles.h"
#include "collision/core/spelling.h"
#include "collision/course/dobkin_kirkpatrick.h"
#include "collision/course/hierarchy_descent.h"
#include "collision/course/outer_hierarchy.h"
#include "collision/course/penetration.h"
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

namespace {

/// The answer at one pose. `distance` and `depth` are set for the queries of these names.
struct HullAnswer {
  bool hit = false;
  std::size_t steps = 0;
  ConvexDistance distance = {};
  Penetration depth = {};
};

/// Queries of two hulls by one method.
class HullQuery {
 public:
  HullQuery(const Hull& a, const Hull& b, std::string method, std::string query,
            const std::optional<Vec3>& direction)
      : a_(a),
        b_(b),
        setA_(a.by(method)),
        setB_(b.by(method)),
        method_(std::move(method)),
        query_(std::move(query)),
        direction_(direction) {}

  /// @param last  in: the data of the query before; out: of this query.
  HullAnswer at(const Transform& pose, LastQuery& last) const {
    if (method_ == "lp") {
      std::vector<Vec3> moved;
      for (const Vec3& p : b_.part.points) moved.push_back(pose * p);
      const auto plane =
          separatingPlane<3>(std::span<const Vec3>(a_.part.points), std::span<const Vec3>(moved));
      return {plane.relation != HullRelation::disjoint};
    }
    if (method_ == "barba-langerman") {
      const PolytopeIntersection found = intersection(*a_.hierarchy, {}, *b_.outer, pose);
      return {found.intersects, static_cast<std::size_t>(found.steps)};
    }
    if (method_ == "axes") {
      const SeparatingAxis before = last.axis;
      last.axis = separatingAxis(*a_.features, {}, *b_.features, pose, &before);
      return {!last.axis.separated, last.axis.faces + last.axis.edgePairs};
    }
    if (method_ == "vclip") {
      const ClosestFeatures found =
          closestFeatures(*a_.features, {}, *b_.features, pose, last.features);
      return ofDistance(found.distance, found.steps + found.rounds);
    }
    int steps = 0;
    if (method_ == "descent" && query_ == "distance") {
      const ConvexDistance found =
          distanceByDescent(*a_.hierarchy, {}, *b_.hierarchy, pose, &steps);
      return ofDistance(found, steps);
    }
    if (method_ == "descent") {
      const DepthByDescent found =
          depthByDescent(*a_.hierarchy, {}, *b_.hierarchy, pose, *direction_, &steps);
      Penetration depth;
      depth.upper = found.upper;
      depth.direction_W = found.normal_W;
      return ofDepth(depth, steps);
    }
    const PosedSet placedA(setA_, {}), placedB(setB_, pose);
    if (query_ == "interference") {
      const bool hit = convexSetsTouch(placedA, placedB, &last.simplex);
      return {hit, static_cast<std::size_t>(last.simplex.rounds)};
    }
    if (query_ == "distance") {
      const ConvexDistance found = convexDistance(placedA, placedB, 0, 0, &last.simplex);
      return ofDistance(found, last.simplex.rounds);
    }
    const Penetration found = direction_ ? penetrationAlong(placedA, placedB, *direction_)
                                         : penetration(placedA, placedB);
    return ofDepth(found, found.rounds);
  }

  std::string header() const {
    if (query_ == "interference") return "pose,hit,steps\n";
    const char* first = query_ == "distance" ? "pose,distance,lower" : "pose,lower,upper";
    return first + std::string(",nx,ny,nz,ax,ay,az,bx,by,bz,steps\n");
  }
  std::string cells(const HullAnswer& answer) const {
    if (query_ == "interference") return answer.hit ? ",1" : ",0";
    const ConvexDistance& distance = answer.distance;
    const Penetration& depth = answer.depth;
    if (query_ == "distance")
      return numbers({distance.distance, distance.lower}) + numbers(distance.normal_W) +
             numbers(distance.p_WA) + numbers(distance.p_WB);
    return numbers({depth.lower, depth.upper}) + numbers(depth.direction_W) + numbers(depth.p_WA) +
           numbers(depth.p_WB);
  }

 private:
  static HullAnswer ofDistance(const ConvexDistance& found, int steps) {
    return {found.distance == 0, static_cast<std::size_t>(steps), found, {}};
  }
  static HullAnswer ofDepth(const Penetration& found, int steps) {
    return {found.upper > 0, static_cast<std::size_t>(steps), {}, found};
  }

  const Hull &a_, &b_;
  ConvexSet setA_, setB_;
  std::string method_, query_;
  std::optional<Vec3> direction_;
};

}  // namespace

void queryHulls(const HullInput& inputA, const HullInput& inputB,
                const std::vector<Transform>& poses, const std::string& method,
                const std::optional<std::string>& asked, const std::optional<Vec3>& direction,
                bool coherent, int repeat) {
  const std::string query = asked.value_or("interference");
  const Hull a(inputA, method), b(inputB, method);
  if (std::ranges::count(gjkMethods(), method) > 0)
    for (const HullInput& input : {inputA, inputB}) noteExtremeSizes(input);
  const HullQuery hulls(a, b, method, query, direction);
  std::string text = hulls.header();
  BatchResult result;
  result.buildMsA = a.buildMs;
  result.buildMsB = b.buildMs;
  result.bytesA = a.bytes();
  result.bytesB = b.bytes();
  std::size_t hits = 0, allSteps = 0;
  LastQuery last;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const LastQuery before = coherent ? last : LastQuery{};
    HullAnswer answer;
    const auto ask = [&] {
      last = before;  // repeated calls do the same work
      answer = hulls.at(poses[i], last);
    };
    std::vector<double> ns;
    try {
      for (int pass = 0; pass < repeat; ++pass) ns.push_back(nanosecondsOf(ask, ask));
    } catch (const std::invalid_argument& error) {
      throw InputError(Fault{"--hulls", 0,
                             method + " can't test pose " + std::to_string(i) + ": " +
                                 error.what() + "; use another method"});
    }
    result.answers.push_back({answer.hit, 0, 0, medianOf(ns)});
    hits += answer.hit;
    allSteps += answer.steps;
    text += std::to_string(i) + hulls.cells(answer) + ',' + std::to_string(answer.steps) + '\n';
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
