// Tests of the program `corridor pose`.
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/app/program_fixtures.h"

namespace {

using testing::HasSubstr;

using PoseCommand = corridor::test::ArmTest;

TEST_F(PoseCommand, PosesAtAState) {
  EXPECT_EQ(run("pose arm.urdf").out,
            "link: \"base\": at [0, 0, 0], rpy_deg [0, 0, 0]\n"
            "link: \"upper\": at [0, 0, 0], rpy_deg [0, 0, 0]\n"
            "link: \"lower\": at [1, 0, 0], rpy_deg [0, 0, 0]\n");
  EXPECT_THAT(run("pose arm.urdf --state 'shoulder_deg: 90, elbow_deg: -30' --link lower").out,
              testing::MatchesRegex("link: \"lower\": at \\[[0-9.e-]+, 1, 0\\], rpy_deg \\[0, 0, "
                                    "60\\]\n"));
  write("robot.yaml",
        "format: corridor-robot-1\nurdf: arm.urdf\njoints: [elbow]\nhold: {shoulder: 0.5}\nstates: "
        "{up: {shoulder: 1, elbow: 1}}\n");
  const auto report =
      nlohmann::json::parse(run("pose . --state '{from: up, elbow: 0.25}' --json").out);
  EXPECT_EQ(report["format"], "corridor-pose-1");
  EXPECT_EQ(report["root"], "base");
  EXPECT_EQ(report["joints"]["shoulder"], 1);
  EXPECT_EQ(report["joints"]["elbow"], 0.25);
  EXPECT_NEAR(report["links"][2]["position"][0], std::cos(1.0), 1e-15);
  EXPECT_NEAR(report["links"][2]["quat_xyzw"][2], std::sin(1.25 / 2), 1e-15);
  EXPECT_EQ(nlohmann::json::parse(run("pose robot.yaml --json").out)["joints"]["shoulder"], 0.5)
      << "where the robot's file holds it";
}

TEST_F(PoseCommand, BadInputIsOneLineAndExit2) {
  const auto fault = [&](const std::string& options) {
    const Result result = run("pose " + options);
    EXPECT_EQ(result.status, 2) << options;
    EXPECT_EQ(result.out, "");
    return result.err;
  };
  EXPECT_EQ(fault("arm.urdf --state 'sholder: 1'"),
            "--state: sholder: there is no joint \"sholder\" (did you mean \"shoulder\"?) (known: "
            "shoulder, "
            "elbow)\n");
  EXPECT_EQ(fault("arm.urdf --state 'shoulder: 90'"),
            "--state: shoulder: 90 is outside of its limits, [-3, 3]; in degrees, write "
            "shoulder_deg: 90\n");
  EXPECT_EQ(fault("arm.urdf --state up"),
            "--state: there is no state \"up\" (neither robot.yaml nor SRDF names any)\n");
  EXPECT_EQ(fault("arm.urdf --link hand"),
            "--link: there is no link \"hand\" (known: base, upper, lower)\n");
  EXPECT_EQ(fault("none.urdf"), "none.urdf: no such file\n");
  EXPECT_THAT(fault("robot.yaml"), HasSubstr("is a rigid robot; only a robot with joints has"));
  EXPECT_THAT(fault("arm.urdf --state '{shoulder: '"), HasSubstr("--state: is not YAML"));
}

}  // namespace
