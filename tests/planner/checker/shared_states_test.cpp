// Tests of states with known verdicts, of the robots in the shared data: contacts between links of
// a robot, labelled states in scenes, and starts and goals of benchmark problems.
#include <fstream>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "planner/checker/checker.h"
#include "planner/model/model_builder.h"
#include "planner/model/planned_joints.h"
#include "planner/problem/problem.h"
#include "planner/robot/joint_types.h"
#include "planner/robot/urdf_file.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using Names = std::set<std::string>;
const char* const kAbsent = "set CORRIDOR_DATA to the folder of shared test data";

std::string joined(std::string a, std::string b) {
  if (b < a) std::swap(a, b);
  return a + "~" + b;
}

Names touching(const Checker& checker, const Configuration& q) {
  Names names;
  for (const Checker::PairNotFree& pair : checker.pairsNotFree(q))
    names.insert(joined(checker.model().bodies[pair.a].name, checker.model().bodies[pair.b].name));
  return names;
}

Configuration numbers(const nlohmann::json& list) {
  const std::vector<double> values = list;
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

TEST(SharedStates, LinksThatTouchEachOther) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << kAbsent;
  const std::filesystem::path robots = *data / "robots";
  const auto reference = nlohmann::json::parse(std::ifstream(robots / "fk_reference.json"));
  std::size_t states = 0, contacts = 0;
  for (const auto& robot : reference.at("robots")) {
    const std::string file = robot.at("urdf"), srdf = robot.value("srdf", std::string());
    SCOPED_TRACE(file);
    std::vector<Fault> faults;
    std::vector<std::filesystem::path> files;
    auto model = readUrdf(robots / file,
                          {.packages = {{"example-robot-data", robots / "example-robot-data"}}},
                          faults, files);
    ASSERT_TRUE(model) << InputError(faults).what();
    // The reference excludes only the pairs of the SRDF. So adjacent links must be tested here,
    // too.
    model->allowed.clear();
    if (!srdf.empty()) readSrdf(robots / srdf, *model, faults);
    ASSERT_TRUE(faults.empty()) << InputError(faults).what();
    ModelRobot arm;
    arm.description = *model;
    std::vector<std::size_t> moving;
    for (std::size_t j = 0; j < model->joints.size(); ++j)
      if (hasOwnValue(model->joints[j])) moving.push_back(j);
    chooseJoints(arm, moving);
    Problem problem;
    problem.model = ModelBuilder().addRobot(arm).buildForReader();
    problem.model.filter = PairFilter();
    problem.task.tube = tubeOf(problem.model.space);
    Names disabled;
    for (const AllowedPair& pair : model->allowed) disabled.insert(joined(pair.a, pair.b));
    for (std::size_t a = 0; a < problem.model.bodies.size(); ++a)
      for (std::size_t b = a + 1; b < problem.model.bodies.size(); ++b)
        if (disabled.contains(joined(problem.model.bodies[a].name, problem.model.bodies[b].name)))
          problem.model.filter.skip(a, b, "SRDF");
    const Checker checker(problem);
    for (const auto& state : robot.at("states")) {
      Configuration q(static_cast<Eigen::Index>(problem.model.space.size()));
      for (const Coordinate& c : problem.model.space.coordinates())
        q[static_cast<Eigen::Index>(c.first)] = state.at("q").at(c.name);
      Names expected;
      for (const auto& pair : state.at("self_contacts"))
        expected.insert(joined(pair.at(0), pair.at(1)));
      Names found = touching(checker, q);
      // The top of the base and the joint above it are both at z = 0.15675, so these links touch.
      // The reference rounds vertices to floats, which leaves a gap of some 1e-9 m.
      const std::string flush = "j2s6s200_link_1~j2s6s200_link_base";
      if (!expected.contains(flush)) found.erase(flush);
      EXPECT_EQ(found, expected) << "state " << states;
      ++states;
      contacts += expected.size();
    }
  }
  EXPECT_EQ(states, 30u);
  EXPECT_GT(contacts, 70u);
}

class SharedSets : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Robots, SharedSets, testing::Values("panda", "ur5"));

TEST_P(SharedSets, LabelledStates) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << kAbsent;
  const std::string robot = GetParam();
  const auto labels =
      nlohmann::json::parse(std::ifstream(*data / "mbm" / "labels" / (robot + ".json")));
  std::size_t robust = 0, colliding = 0;
  for (const auto& query : labels.at("queries")) {
    const std::string scene = query.at("scene");
    const int index = query.at("index");
    const Problem problem = readProblem((*data / "mbm" / robot / (scene + ".json")).string() + "#" +
                                        std::to_string(index));
    SCOPED_TRACE(problem.source.name);
    const Checker checker(problem);
    for (const auto& state : query.at("states")) {
      if (!state.at("robust")) continue;
      const Configuration q = numbers(state.at("q"));
      Names expected;
      for (const auto& pair : state.at("pairs")) expected.insert(joined(pair.at(0), pair.at(1)));
      ASSERT_EQ(expected.empty(), !state.at("collision"));
      EXPECT_EQ(touching(checker, q), expected) << "state " << state.at("q");
      EXPECT_EQ(checker.interference(q).has_value(), !expected.empty()) << state.at("q");
      ++robust;
      colliding += !expected.empty();
    }
  }
  EXPECT_GT(robust, 450u);
  EXPECT_GT(colliding, 100u);
}

TEST_P(SharedSets, EveryStartAndGoalIsFree) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << kAbsent;
  int problems = 0;
  for (const auto& entry : std::filesystem::directory_iterator(*data / "mbm" / GetParam()))
    for (int index = 1; index <= 50; ++index) {
      const Problem problem = readProblem(entry.path().string() + "#" + std::to_string(index));
      const Checker checker(problem);
      EXPECT_TRUE(checker.isProvedFree(problem.task.start)) << problem.source.name << " start";
      for (const Configuration& goal : problem.task.goals)
        EXPECT_TRUE(checker.isProvedFree(goal)) << problem.source.name << " goal";
      ++problems;
    }
  EXPECT_EQ(problems, 350);
}

}  // namespace
}  // namespace corridor
