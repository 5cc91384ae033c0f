#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "collision/core/fault_list.h"
#include "collision/core/shortest.h"
#include "planner/app/commands.h"
#include "planner/app/new_file.h"
#include "planner/app/output.h"
#include "planner/checker/pair_survey.h"
#include "planner/model/model_builder.h"
#include "planner/problem/assembly.h"
#include "planner/problem/robot_file.h"
#include "planner/problem/state_text.h"
#include "planner/robot/joint_types.h"

namespace corridor::app {
namespace {

namespace fs = std::filesystem;

/// The maximum number of random states that are tried.
constexpr int kRandomStates = 1000;
/// The maximum number of touching pairs that are named if no valid state is found.
constexpr std::size_t kNamedPairs = 5;

/// A valid state, how it is written, and where it comes from.
struct FoundState {
  Configuration q;
  std::string text;    ///< as the value of `start` or `goal`
  std::string origin;  ///< for a comment
};

/// The model of a problem without obstacles. The positions of a rigid robot, and of planar and
/// floating joints, are bounded by a cube of a few times the robot's size.
struct Alone {
  Model model;
  double size = 1;  ///< metres
};

/// Returns the largest absolute value of a coordinate of the points of the robot's shapes, rounded
/// up to two digits; 1 if there are no shapes. The coordinates of each shape are those in the frame
/// of its link. It is used only as a scale for the lengths in the new file.
double sizeOf(const RobotDescription& description) {
  double size = 0;
  for (const LinkModel& link : description.links)
    for (const PlacedShape& shape : link.shapes)
      forEachPoint(shape, [&](const Vec3& p, double radius) {
        size = std::max(size, p.cwiseAbs().maxCoeff() + radius);
      });
  // Two digits are enough, and easy to edit.
  if (!(size > 0)) return 1;
  const double unit = std::pow(10, std::floor(std::log10(size)) - 1);
  return std::ceil(size / unit) * unit;
}

Alone modelOf(ModelRobot robot) {
  Alone alone;
  alone.size = sizeOf(robot.description);
  const Corners bounds{Vec3::Constant(-4 * alone.size), Vec3::Constant(4 * alone.size)};
  ModelBuilder builder;
  if (robot.isRigid()) builder.bound(robot.description.name, bounds);
  for (const std::size_t j : robot.planned)
    if (isPoseJoint(robot.description.joints[j].type))
      builder.bound(robot.description.joints[j].name, bounds);
  alone.model = builder.addRobot(std::move(robot)).build();
  return alone;
}

std::string pointText(const Vec3& p, std::size_t count) {
  std::string text = "[";
  for (std::size_t i = 0; i < count; ++i)
    text += (i ? ", " : "") + shortest(p[static_cast<Eigen::Index>(i)]);
  return text + "]";
}

/// Rounds to three decimals, which are easy to read and to edit.
double threeDecimals(double number) {
  return std::round(number * 1000) / 1000 + 0.0;  // not -0
}

/// Returns the configuration of a named state, or nullopt if it does not name all joints that are
/// planned for. Also returns nullopt if one of them is planar or floating: named states rarely have
/// these.
std::optional<Configuration> configurationOf(const Model& model, const NamedState& state) {
  Configuration q = Configuration::Zero(static_cast<Eigen::Index>(model.space.size()));
  for (const PlannedJoint& planned : model.robots.front().plannedJoints) {
    const auto value = state.values.find(planned.name);
    if (isPoseJoint(planned.type) || value == state.values.end()) return std::nullopt;
    const std::size_t first = model.space.coordinates()[planned.coordinate].first;
    q[static_cast<Eigen::Index>(first)] = value->second;
  }
  model.space.normalise(q);
  return q;
}

/// Returns whether a problem may refer to the state by its name: each held joint that the state
/// names has the held value in the state.
bool holdsAgree(const ModelRobot& robot, const NamedState& state) {
  return std::all_of(state.values.begin(), state.values.end(), [&](const auto& value) {
    const auto j = findJoint(robot.description, value.first);
    if (!j) return false;
    const auto held = robot.held.find(*j);
    return held == robot.held.end() || held->second == value.second;
  });
}

/// Finds valid states of a robot without obstacles.
class StateFinder {
 public:
  StateFinder(const Checker& checker, std::uint64_t seed)
      : checker_(checker), model_(checker.model()), random_(seed) {}

  /// Returns up to two different valid states, the start first.
  std::vector<FoundState> find() {
    addNamed();
    if (found_.size() < 2) addResting();
    for (int i = 0; found_.size() < 2 && i < kRandomStates; ++i) addRandom();
    if (found_.size() < 2 && spare_) found_.push_back(std::move(*spare_));
    return std::move(found_);
  }

  /// Returns the pairs that were in contact most often in the states that `find` tried, and what to
  /// do; "" if no pair was in contact. The pairs are written as the key `allow` lists them.
  std::string whyNotValid() const {
    std::vector<std::pair<std::size_t, std::pair<std::size_t, std::size_t>>> most;
    for (const auto& [pair, count] : contacts_) most.emplace_back(count, pair);
    // Pairs with equal counts stay in the order of the map.
    std::stable_sort(most.begin(), most.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::string text;
    for (std::size_t i = 0; i < std::min(most.size(), kNamedPairs); ++i) {
      const auto& [count, pair] = most[i];
      const std::size_t percent = 100 * count / tried_;
      text += (i ? ", " : "") +
              yamlList({model_.bodies[pair.first].name, model_.bodies[pair.second].name}) + " in " +
              (percent > 0 ? std::to_string(percent) : "less than 1") + " %";
    }
    if (text.empty()) return "";
    return "most often in contact, in " + counted(tried_, "tried state") + ": " + text +
           (most.size() > kNamedPairs ? ", …" : "") +
           "; allow the pairs that overlap by design (allow), or plan for fewer joints (joints or "
           "group in a robot.yaml)";
  }

 private:
  /// Returns whether the state is valid, and differs from all states found so far. Counts the pairs
  /// that are in contact in it.
  bool isValidAndNew(const Configuration& q) {
    if (std::any_of(found_.begin(), found_.end(),
                    [&](const FoundState& f) { return model_.space.equal(f.q, q); }))
      return false;
    if (!checker_.inBounds(q)) return false;
    ++tried_;
    if (checker_.isProvedFree(q)) return true;
    for (const Checker::PairNotFree& pair : checker_.pairsNotFree(q)) ++contacts_[{pair.a, pair.b}];
    return false;
  }

  void addNamed() {
    const ModelRobot& robot = model_.robots.front();
    for (const auto& [name, state] : robot.description.states) {
      if (found_.size() == 2) return;
      if (!state.unusable.empty()) continue;
      const auto q = configurationOf(model_, state);
      if (!q || !isValidAndNew(*q)) continue;
      const bool byName = holdsAgree(robot, state);
      found_.push_back(
          {*q, byName ? yamlWord(name) : stateText(model_, *q),
           byName ? "a named state of the robot"
                  : "the named state " + yamlWord(name) + ", without the joints that are held"});
    }
  }

  void addResting() {
    Configuration zero = Configuration::Zero(static_cast<Eigen::Index>(model_.space.size())),
                  middle = zero;
    for (const Coordinate& c : model_.space.coordinates()) {
      const auto i = static_cast<Eigen::Index>(c.first);
      if (c.kind == Coordinate::Kind::rotation) zero[i + 3] = middle[i + 3] = 1;
      if (c.kind != Coordinate::Kind::line) continue;
      zero[i] = std::clamp(0.0, c.lower, c.upper);
      if (std::isfinite(c.upper - c.lower))
        middle[i] = std::clamp(threeDecimals(c.lower + (c.upper - c.lower) / 2), c.lower, c.upper);
    }
    add(zero, "every joint at 0, or at the limit nearest to 0");
    if (found_.size() < 2) add(middle, "every joint in the middle of its limits");
  }

  /// A random state becomes the goal only if the edge from the start to it is proved free: then a
  /// path exists. The first valid state without such an edge is kept: it becomes the goal if no
  /// other state does.
  void addRandom() {
    Configuration q = randomConfiguration(model_.space, [&] { return random_(); });
    for (double& number : q) number = threeDecimals(number);  // tested as it is written
    if (!isValidAndNew(q)) return;
    FoundState state{q, stateText(model_, q), "a random valid state"};
    if (found_.empty() || checker_.isProvedFree(found_.front().q, q))
      found_.push_back(std::move(state));
    else if (!spare_)
      spare_ = std::move(state);
  }

  void add(const Configuration& q, const std::string& origin) {
    if (!isValidAndNew(q)) return;
    FoundState state{q, stateText(model_, q), origin};
    if (found_.empty() || checker_.isProvedFree(found_.front().q, q))
      found_.push_back(std::move(state));
  }

  const Checker& checker_;
  const Model& model_;
  std::mt19937_64 random_;
  std::vector<FoundState> found_;
  std::optional<FoundState> spare_;
  std::size_t tried_ = 0;                                                // number of states
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> contacts_;  // number of states
};

/// Returns the line `bounds` for a rigid robot, or for all planar and floating joints; "" if there
/// are none.
std::string boundsText(const Alone& alone) {
  const ModelRobot& robot = alone.model.robots.front();
  std::string text;
  for (const PlannedJoint& planned : robot.plannedJoints) {
    if (!isPoseJoint(planned.type)) continue;
    const std::size_t count = planned.type == JointType::planar ? 2 : 3;
    const double far = 4 * alone.size;
    const std::string box = "{at: [" + pointText(Vec3::Constant(-far), count) + ", " +
                            pointText(Vec3::Constant(far), count) + "]}";
    if (robot.isRigid()) return "bounds: " + box + "  # m: where the reference point may be\n";
    text += (text.empty() ? "" : ", ") + yamlWord(planned.name) + ": " + box;
  }
  return text.empty() ? "" : "bounds: {" + text + "}  # m\n";
}

std::string worldText(const Alone& alone) {
  const double s = alone.size;
  const std::string wall = "wall: {box: " + pointText({0.2 * s, 2 * s, 2 * s}, 3) +
                           ", at: " + pointText({2 * s, 0, 0}, 3) + "}";
  std::string text = comment(
      "Obstacles, by names of your choice; lengths in metres. Also sphere, "
      "capsule, convex, and mesh: {mesh: shelf.stl, unit: mm, at: […]}");
  if (alone.model.robots.front().isRigid())
    return text + "world:\n  " + wall + "  # full edge lengths, centre\n";
  return text +
         "# world:\n#   table: {box: [1.2, 0.8, 0.04], at: [0.6, 0, -0.2]}  # full edge "
         "lengths, centre\n#   post: {cylinder: {radius: 0.03, length: 1.5}, at: [0.4, -0.3, "
         "0.75]}\n";
}

/// Start and goal of a rigid robot: on opposite sides of the wall of `worldText`.
std::vector<FoundState> rigidStates(const Alone& alone, const Checker& checker) {
  std::vector<FoundState> found;
  for (const double x : {0.0, 3.9 * alone.size}) {
    Configuration q = Configuration::Zero(static_cast<Eigen::Index>(alone.model.space.size()));
    q[0] = x;
    if (alone.model.robots.front().description.mount == JointType::floating) q[6] = 1;
    if (checker.isProvedFree(q)) found.push_back({q, stateText(alone.model, q), "an example"});
  }
  return found;
}

constexpr const char* kMore = R"(
# Common keys:
# margin: 0                # m, kept between all bodies; default 0: touching is contact
# prefer: {clearance: 0.005}   # m, kept where there is room; not together with margin; 0: shortest path
# tube: {joints: 0.001}    # the tracking error that the proof covers, too; default: rounding only
# allow: [[hand, table]]   # pairs of bodies that may touch; default: none
# planner: {name: RRTConnect, time: 20}   # s; if no path is found, try params: {range: 0.5}
# simplify: true           # the path is shortened
# seed: 1
)";

}  // namespace

int newProblem(const NewProblemArguments& a) {
  requireNewFile(a.file);
  fs::path file = a.robot;
  std::error_code none;
  if (fs::is_directory(file, none)) file /= "robot.yaml";
  RobotSetup setup = readRobotAlone(file);
  if (!a.file.toStdout()) requireNotAnInput(a.file.output, "--output", setup.files, "the robot");
  const Alone alone = modelOf(std::move(setup.robot));
  const Checker checker(alone.model);
  const bool rigid = alone.model.robots.front().isRigid();
  StateFinder finder(checker, a.seed);
  const std::vector<FoundState> found = rigid ? rigidStates(alone, checker) : finder.find();
  const std::string why = found.size() == 2 || rigid ? "" : finder.whyNotValid();

  std::string text = comment("A problem, written by corridor new problem. Edit it, then:");
  text +=
      "#   corridor check FILE                  # every fault; what start and goal touch\n"
      "#   corridor solve FILE -o path.yaml     # plans, and proves the path\n"
      "format: corridor-problem-1\nrobot: " +
      yamlWord(pathFrom(a.file, file)) + "\n";
  if (!rigid)
    text += "# base: {at: [0, 0, 0], rpy_deg: [0, 0, 0]}  # m: the pose of the robot's root link\n";
  text += "\n" + worldText(alone) + "\n";
  const auto end = [&](const char* key, std::size_t i) {
    if (i < found.size()) return comment(found[i].origin) + key + ": " + found[i].text + "\n";
    const Configuration q = randomConfiguration(alone.model.space, [] { return ~0ull >> 1; });
    return comment(
               std::string("NOT VALID: no ") + (i ? "other " : "") + "valid state was found" +
               (rigid
                    ? ""
                    : " among the named states, the state with every joint near 0, the state with "
                      "every joint in the middle of its limits, and " +
                          std::to_string(kRandomStates) + " random states") +
               ". corridor check names the links that touch.") +
           ((i > 0 && found.empty()) || why.empty() ? "" : comment("Why: " + why)) + key + ": " +
           stateText(alone.model, q) + "\n";
  };
  text += end("start", 0) + end("goal", 1) + boundsText(alone) + kMore;
  writeNewFile(a.file, text);

  std::vector<Note> notes = alone.model.robots.front().description.notes;
  addAll(notesOnMeshes(alone.model.robots.front().description), notes);
  const ResultPrinter out(a.file.toStdout());
  if (a.file.output) out.line("problem", *a.file.output);
  for (std::size_t i = 0; i < 2; ++i)
    if (i < found.size())
      out.line(i == 0 ? "start" : "goal", found[i].origin);
    else
      out.line(i == 0 ? "start" : "goal", "no valid state was found", Tone::bad);
  if (!why.empty()) out.line("why", why);
  printNotes(notes);
  return found.size() == 2 ? kDone : kNegativeResult;
}

}  // namespace corridor::app
