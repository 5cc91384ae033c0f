#include "planner/view/view_page.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>

#include <nlohmann/json.hpp>

#include "planner/checker/checker.h"
#include "planner/checker/enclosed_bodies.h"
#include "planner/checker/left_out.h"
#include "planner/checker/problem_goal.h"
#include "planner/model/reach.h"
#include "planner/view/closest_pairs.h"
#include "planner/view/curve_plots.h"
#include "planner/view/display_scene.h"
#include "planner/view/page_buffers.h"
#include "planner/view/page_files.h"
#include "planner/view/page_text.h"
#include "planner/view/path_samples.h"
#include "planner/view/tessellate.h"
#include "planner/view/tree_boxes.h"

namespace corridor {

// The page's typed arrays are read as little-endian.
static_assert(std::endian::native == std::endian::little);

namespace view {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMostDistances = 500;  // evenly chosen samples with closest pairs, at most
constexpr std::size_t kMostBoxes = 16'000;   // of all trees together; they take 640 KB
constexpr std::size_t kMostGoals = 8;        // the largest number of goals that are shown

ordered_json jsonOf(const PageBuffers::View& view) {
  return {view.type, view.offset, view.count};
}

ordered_json jsonOf(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

/// Builds the data of a page: JSON, and the arrays that it refers to.
class PageData {
 public:
  PageData(const Problem& problem, const std::optional<ViewedPath>& path,
           const std::optional<ViewDirection>& from)
      : problem_(problem),
        path_(path),
        from_(from),
        scene_(displayScene(problem)),
        checker_(problem) {}

  ordered_json make() {
    json_ = {{"format", "corridor-view-1"},
             {"name", problem_.source.name},
             {"file", problem_.source.file.filename().string()},
             {"origin", jsonOf(scene_.origin)},
             {"planar", scene_.planar}};
    if (from_) json_["from"] = {from_->azimuth, from_->elevation};
    addScene();
    addEnds();
    addPairs();
    addTrees();
    std::vector<Note> notes = notesOnStart(checker_, startOf(problem_));
    addAll(problem_.source.notes, notes);
    for (const ModelBody& body : problem_.model.bodies)
      for (const PlacedShape& shape : body.shapes)
        if (shape.parts.size() > kMostParts && shape.polygon.empty())
          notes.push_back({body.name + ": this page shows some of its " +
                               std::to_string(shape.parts.size()) +
                               " parts, evenly chosen; the tests use all of them",
                           NoteWeight::detail});
    json_["notes"] = textsOf(notes);
    if (path_) {
      addSolution();
      addPath();
    }
    return json_;
  }

  const PageBuffers& buffers() const { return buffers_; }

 private:
  void addScene() {
    ordered_json& robots = json_["robots"] = ordered_json::array();
    for (const ModelRobot& robot : problem_.model.robots)
      robots.push_back({{"name", robot.name}, {"model", robot.description.name}});
    ordered_json& meshes = json_["meshes"] = ordered_json::array();
    for (const DisplayMesh& mesh : scene_.meshes)
      meshes.push_back(
          {{"origin", jsonOf(mesh.origin)},
           {"positions", jsonOf(buffers_.add(mesh.positions))},
           {"indices", jsonOf(buffers_.addIndices(mesh.indices, mesh.positions.size() / 3))}});
    ordered_json& bodies = json_["bodies"] = ordered_json::array();
    for (const DisplayBody& body : scene_.bodies) {
      bodies.push_back({{"name", body.name},
                        {"mesh", body.mesh},
                        {"frame", frameNumber(body.frame)},
                        {"robot", body.robot ? ordered_json(*body.robot) : ordered_json()}});
      if (body.X_WB) bodies.back()["pose"] = displayPose(scene_, *body.X_WB);
    }
  }

  /// Returns −1 for the world's frame, else the frame's index in the page's poses.
  int frameNumber(std::size_t frame) const {
    if (frame == 0) return -1;
    return static_cast<int>(std::lower_bound(scene_.frames.begin(), scene_.frames.end(), frame) -
                            scene_.frames.begin());
  }

  ordered_json poses(const Configuration& q) {
    return jsonOf(buffers_.add(displayPoses(scene_, framePoses(problem_.model.tree, q))));
  }

  void addEnds() {
    json_["start"] = poses(problem_.task.start);
    ordered_json& goals = json_["goals"] = ordered_json::array();
    for (const Configuration& goal : problem_.task.goals)
      if (goals.size() < kMostGoals) goals.push_back(poses(goal));
    json_["goal_count"] = problem_.task.goals.size();
  }

  /// Adds the number of tested pairs, the skipped pairs by reason, the pairs that are tested once,
  /// and those tested pairs whose bodies can never reach each other.
  void addPairs() {
    std::size_t tested = 0;
    std::map<std::string, std::vector<std::uint32_t>> skipped;
    std::vector<std::uint32_t> far, atRest;
    const std::vector<ReachBox> reach = reachOf(problem_.model);
    const Required need = requiredBy(problem_.task);
    forEachPair(problem_.model, need, [&](std::size_t a, std::size_t b, std::string_view why) {
      tested += why.empty();
      if (why.empty() && !outOfReach(problem_.task, reach[a], reach[b])) return;
      std::vector<std::uint32_t>& list = why.empty()            ? far
                                         : why == kTestedAtRest ? atRest
                                                                : skipped[std::string(why)];
      list.push_back(static_cast<std::uint32_t>(a));
      list.push_back(static_cast<std::uint32_t>(b));
    });
    const std::size_t bodies = problem_.model.bodies.size();
    ordered_json& pairs = json_["pairs"] = {{"tested", tested}, {"skipped", ordered_json::array()}};
    for (const auto& [reason, list] : skipped)
      pairs["skipped"].push_back(
          {{"reason", reason}, {"pairs", jsonOf(buffers_.addIndices(list, bodies))}});
    pairs["at_rest"] = jsonOf(buffers_.addIndices(atRest, bodies));
    pairs["far"] = jsonOf(buffers_.addIndices(far, bodies));
  }

  /// Adds, for each mesh, the boxes of the trees of its shapes, level by level.
  void addTrees() {
    ordered_json& trees = json_["trees"] = ordered_json::array();
    std::vector<bool> done(scene_.meshes.size(), false);
    const std::size_t most =
        kMostBoxes / std::max<std::size_t>(1, checker_.scene().bodies().size());
    for (std::size_t body = 0, shape = 0; body < problem_.model.bodies.size(); ++body) {
      const std::size_t first = shape;
      shape += problem_.model.bodies[body].shapes.size();
      const std::size_t mesh = scene_.bodies[body].mesh;
      if (done[mesh]) continue;
      done[mesh] = true;
      ordered_json all = ordered_json::array();
      for (std::size_t i = first; i < shape; ++i) {
        const Obb4Tree& tree = checker_.scene().bodies()[i].body.tree();
        const TreeBoxes boxes =
            treeBoxes(tree, scene_.meshes[mesh].origin, std::max<std::size_t>(most, 85));
        all.push_back({{"counts", boxes.counts},
                       {"boxes", jsonOf(buffers_.add(boxes.numbers))},
                       {"leaves", jsonOf(buffers_.add(boxes.leaves))},
                       {"whole", boxes.counts.size() > 1 || tree.hasParts()}});
      }
      trees.push_back({{"mesh", mesh}, {"shapes", all}});
    }
  }

  void addSolution() {
    const Solution& s = path_->solution;
    const VerifyReport& r = path_->report;
    const PathLength length = lengthOf(problem_.model.space, s.path);
    bool lengths = false, angles = false;
    const bool straight = !r.between || *r.between == RowInterpolation::linear;
    for (const Coordinate& c : problem_.model.space.coordinates())
      (isLength(c) ? lengths : angles) = straight;
    ordered_json& solution = json_["solution"] = {
        {"planner", s.planner},
        {"certified", s.certified},
        {"checker", s.checker},
        {"states", s.path.size()},
        {"length_m", lengths ? ordered_json(length.metres) : ordered_json()},
        {"rotation_rad", angles ? ordered_json(length.radians) : ordered_json()},
        {"length_of", summands(problem_.model.space)},
        {"other_files", r.digest == DigestState::differs},
        {"margin_m", r.margin}};
    if (!s.digest.empty()) solution["seed"] = s.seed;
    if (r.between) solution["between"] = nameOf(*r.between);
    ordered_json& verdict = json_["verdict"] = {{"verdict", verdictName(r)},
                                                {"edges", r.pathReport.edges},
                                                {"edges_proved", r.pathReport.edgesProved},
                                                {"reaches_goal", r.reachesGoal},
                                                {"violations", r.violations},
                                                {"findings", ordered_json::array()}};
    const LeftOut leftOut = leftOutOf(checker_);
    verdict["left_out"] = ordered_json::array();
    for (const LeftOutPair& pair : leftOut.except)
      verdict["left_out"].push_back({pair.a, pair.b, nameOf(pair.reason)});
    if (r.verdict == PathVerdict::proved && !r.otherProblem)
      verdict["except"] = exceptText(problem_.model, leftOut);
    if (r.pathReport.verdict == PathVerdict::proved) {
      verdict["proved_clearance_m"] = r.pathReport.provedClearance;
      verdict["closest_found_m"] = r.pathReport.closestFound;
    }
    if (r.limits)
      verdict["limits"] = {{"verdict", limitsVerdict(*r.limits)}, {"text", path_->limitsText}};
    for (const PathFinding& f : r.pathReport.findings) {
      verdict["findings"].push_back({{"verdict", nameOf(f.verdict)},
                                     {"reason", f.reason},
                                     {"edge", f.edge},
                                     {"t", f.t},
                                     {"in_every_state", f.inEveryState},
                                     {"a", bodyNamed(f.a)},
                                     {"b", bodyNamed(f.b)},
                                     {"point", jsonOf(Vec3(f.point - scene_.origin))},
                                     {"gap_m", f.gap}});
      if (r.times.empty() || f.inEveryState) continue;
      const auto k = static_cast<std::size_t>(f.edge);
      verdict["findings"].back()["time_s"] = r.times[k] + f.t * (r.times[k + 1] - r.times[k]);
    }
  }

  static bool isLength(const Coordinate& c) {
    return c.kind == Coordinate::Kind::line && !c.angular;
  }

  ordered_json bodyNamed(const std::string& name) const {
    for (std::size_t i = 0; i < problem_.model.bodies.size(); ++i)
      if (problem_.model.bodies[i].name == name) return i;
    return {};
  }

  void addPath() {
    const std::vector<PathFinding>& findings = path_->report.pathReport.findings;
    const ConfigurationSpace& space = problem_.model.space;
    const PathSamples samples =
        path_->curve ? samplePath(
                           problem_, path_->curve->pieces.size(),
                           [&](std::size_t edge, double t) {
                             return configurationAt(space, path_->curve->pieces[edge], t);
                           },
                           path_->report.times, findings)
                     : samplePath(problem_, path_->solution.path, findings);
    std::vector<float> at, t, poses;
    std::vector<std::uint32_t> edges;
    for (const PathSample& sample : samples.samples) {
      at.push_back(static_cast<float>(sample.at));
      t.push_back(static_cast<float>(sample.t));
      edges.push_back(static_cast<std::uint32_t>(sample.edge));
      const std::vector<float> pose = displayPoses(scene_, sample.X_WF);
      poses.insert(poses.end(), pose.begin(), pose.end());
    }
    std::vector<int> trace;
    for (const std::size_t frame : scene_.tips) trace.push_back(frameNumber(frame));
    json_["path"] = {{"at", jsonOf(buffers_.add(at))},
                     {"edge", jsonOf(buffers_.add(edges))},
                     {"t", jsonOf(buffers_.add(t))},
                     {"poses", jsonOf(buffers_.add(poses))},
                     {"states", samples.states},
                     {"findings", samples.findings},
                     {"trace", trace}};
    if (const std::vector<double>& times = path_->report.times; !times.empty()) {
      json_["path"]["times"] = {times.front(), times.back()};
      addPlots();
    }
    addDistances(samples);
  }

  /// Adds the positions, velocities and accelerations of the joints over time.
  void addPlots() {
    const ConfigurationSpace& space = problem_.model.space;
    const CurvePlots plots = curvePlots(space, *path_->curve);
    const double begin = plots.times.front(), duration = plots.times.back() - begin;
    std::vector<float> at;
    for (const double time : plots.times)
      at.push_back(static_cast<float>((time - begin) / duration));
    const auto array = [&](const std::vector<double>& values) {
      return jsonOf(buffers_.add(std::vector<float>(values.begin(), values.end())));
    };
    const auto ifFinite = [](double x) {
      return std::isfinite(x) ? ordered_json(x) : ordered_json();
    };
    ordered_json joints = ordered_json::array();
    for (const CurvePlots::Number& n : plots.numbers) {
      const Coordinate& c = space.coordinates()[n.coordinate];
      const bool isBounded = c.kind == Coordinate::Kind::line && std::isfinite(c.upper - c.lower);
      joints.push_back(
          {{"name", c.name},
           {"unit", isLength(c) ? "m" : "rad"},
           {"bounds", isBounded ? ordered_json{c.lower, c.upper} : ordered_json()},
           {"velocity", ifFinite(limitOf(space, n.coordinate, path_->velocityLimits))},
           {"acceleration", ifFinite(limitOf(space, n.coordinate, path_->accelerationLimits))},
           {"values", {array(n.position), array(n.velocity), array(n.acceleration)}}});
    }
    json_["plots"] = {{"at", jsonOf(buffers_.add(at))}, {"joints", joints}};
  }

  /// Adds the closest pairs: at evenly chosen samples, at all findings, and at all states if there
  /// are at most 2·kMostDistances states.
  void addDistances(const PathSamples& samples) {
    const std::size_t count = samples.samples.size();
    const std::size_t stride = (count + kMostDistances - 1) / kMostDistances;
    std::vector<bool> chosen(count, false);
    for (std::size_t i = 0; i < count; i += stride) chosen[i] = true;
    for (const std::size_t i : samples.findings) chosen[i] = true;
    if (samples.states.size() <= 2 * kMostDistances)
      for (const std::size_t i : samples.states) chosen[i] = true;
    std::vector<std::uint32_t> sample, bodies;
    std::vector<float> metres, points;
    QueryContext context;
    for (std::size_t i = 0; i < count; ++i) {
      if (!chosen[i]) continue;
      const std::optional<ClosestPair> pair =
          closestPair(checker_, samples.samples[i].X_WF, context);
      if (!pair) return;
      sample.push_back(static_cast<std::uint32_t>(i));
      metres.push_back(static_cast<float>(pair->distance));
      bodies.push_back(static_cast<std::uint32_t>(pair->a));
      bodies.push_back(static_cast<std::uint32_t>(pair->b));
      for (const Vec3& p : {pair->p_WA, pair->p_WB})
        for (int k = 0; k < 3; ++k) points.push_back(static_cast<float>(p[k] - scene_.origin[k]));
    }
    json_["distances"] = {
        {"sample", jsonOf(buffers_.add(sample))},
        {"metres", jsonOf(buffers_.add(metres))},
        {"bodies", jsonOf(buffers_.addIndices(bodies, problem_.model.bodies.size()))},
        {"points", jsonOf(buffers_.add(points))}};
  }

  const Problem& problem_;
  const std::optional<ViewedPath>& path_;
  const std::optional<ViewDirection>& from_;
  DisplayScene scene_;
  Checker checker_;
  PageBuffers buffers_;
  ordered_json json_;
};

/// The page's own scripts. They share one scope, so each must come after the scripts that it uses.
constexpr std::array kScripts = {"data.js",   "shapes.js", "stage.js", "robots.js", "glass.js",
                                 "extras.js", "chart.js",  "plots.js", "panel.js",  "main.js"};

}  // namespace
}  // namespace view

std::string viewPage(const Problem& problem, const std::optional<ViewedPath>& path,
                     const std::optional<ViewDirection>& from) {
  using namespace view;
  PageData data(problem, path, from);
  // Names in files need not be UTF-8: invalid bytes become replacement characters.
  const std::string json =
      data.make().dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::string scripts;
  for (const char* name : kScripts)
    scripts += "<script>\n" + std::string(pageFile(name)) + "</script>\n";
  return filled(pageFile("view.html"), {{"title", escapedHtml(problem.source.name)},
                                        {"style", std::string(pageFile("view.css"))},
                                        {"three", std::string(pageFile("three.min.js"))},
                                        {"orbit", std::string(pageFile("OrbitControls.js"))},
                                        {"data", scriptJson(json)},
                                        {"buffers", base64(data.buffers().bytes())},
                                        {"scripts", scripts}});
}

}  // namespace corridor
