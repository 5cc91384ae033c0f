// Tests of robots that are written as xacro files. A script stands in for the program xacro.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/app/program_fixtures.h"

namespace {

using testing::EndsWith;
using testing::HasSubstr;

class Xacro : public corridor::test::ArmTest {
 protected:
  Xacro() {
    write("arm.urdf.xacro", read("arm.urdf"));
    write("xacro.yaml", named("arm.urdf.xacro"));
    install("exec cat \"$1\"");
  }
  /// Returns the problem of arm.yaml for another robot.
  std::string named(const std::string& robot) const {
    std::string problem = read("arm.yaml");
    return problem.replace(problem.find("arm.urdf"), 8, robot);
  }
  /// Writes a script as the program xacro.
  void install(const std::string& script) const {
    std::filesystem::create_directory(folder_ / "bin");
    write("bin/xacro", "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(folder_ / "bin/xacro", std::filesystem::perms::owner_all);
  }
  Result runWith(const std::string& arguments) const {
    return run(arguments, "PATH='" + (folder_ / "bin").string() + "':/usr/bin:/bin ");
  }
  std::string digest() const {
    const Result result = runWith("inspect xacro.yaml --json");
    EXPECT_EQ(result.err, "");
    return result.out.empty() ? "" : nlohmann::json::parse(result.out)["digest"].get<std::string>();
  }
};

TEST_F(Xacro, AProblemAndARobotNameAXacroFile) {
  const Result plain = runWith("check arm.yaml"), expanded = runWith("check xacro.yaml");
  EXPECT_EQ(expanded.status, 0) << expanded.err;
  EXPECT_EQ(expanded.out, "problem: xacro.yaml" + plain.out.substr(plain.out.find('\n')));
  EXPECT_THAT(runWith("inspect arm.urdf.xacro").out, HasSubstr("joint: \"shoulder\": revolute"));
  EXPECT_EQ(runWith("pose arm.urdf.xacro").status, 0);
}

TEST_F(Xacro, GetsArgumentsAndRunsInTheFolderOfItsFile) {
  std::filesystem::create_directory(folder_ / "sub");
  std::filesystem::rename(folder_ / "arm.urdf.xacro", folder_ / "sub/arm.urdf.xacro");
  write("robot.yaml",
        "format: corridor-robot-1\nurdf: sub/arm.urdf.xacro\nxacro: {prefix: left arm, dof: 7}\n");
  install("[ \"$2,$3,$#\" = 'prefix:=left arm,dof:=7,3' ] && exec cat \"$1\"");
  EXPECT_EQ(runWith("inspect robot.yaml").err, "");
  write("robot.yaml", "format: corridor-robot-1\nurdf: arm.urdf\nxacro: {a: b}\n");
  EXPECT_EQ(runWith("inspect robot.yaml").err,
            "robot.yaml:3: xacro: is for a URDF or SRDF whose name ends in .xacro; leave it out\n");
  write("robot.yaml", "format: corridor-robot-1\nurdf: sub/arm.urdf.xacro\nxacro: {--o: b}\n");
  EXPECT_EQ(runWith("inspect robot.yaml").status, 2);
}

/// The digest covers the text that xacro made, and therefore all files that the xacro file
/// includes.
TEST_F(Xacro, TheDigestIsThatOfTheExpandedText) {
  const std::string before = digest();
  EXPECT_EQ(digest(), before);
  write("arm.urdf.xacro", read("arm.urdf") + "<!-- more -->");
  const std::string after = digest();
  EXPECT_NE(after, before);
  install("cat arm.urdf");  // the same text as at first
  EXPECT_EQ(digest(), before);
}

TEST_F(Xacro, FaultsAreOneLine) {
  const auto fault = [&](const std::string& script) {
    install(script);
    const Result result = runWith("check xacro.yaml");
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
    return result.err;
  };
  EXPECT_EQ(fault("echo ignored >&2; echo 'undefined macro: wheel' >&2; exit 2"),
            "arm.urdf.xacro: xacro arm.urdf.xacro failed (exit status 2): ignored | undefined "
            "macro: wheel\n");
  EXPECT_EQ(fault("kill -9 $$"), "arm.urdf.xacro: xacro arm.urdf.xacro failed, and said nothing\n");
  EXPECT_EQ(fault("true"), "arm.urdf.xacro: xacro has printed nothing\n");
  EXPECT_THAT(fault("echo '<robot name=\"r\"/>'"),
              testing::StartsWith("arm.urdf.xacro, expanded by xacro:1: "));
  const Result missing = run("check xacro.yaml", "PATH=/nowhere ");
  EXPECT_EQ(missing.status, 2);
  EXPECT_EQ(missing.err,
            "arm.urdf.xacro: needs xacro, and there is no program xacro in PATH; where it is "
            "installed, convert the file: xacro arm.urdf.xacro > arm.urdf, and name the result\n");
  write("none.yaml", named("none.urdf.xacro"));
  EXPECT_THAT(runWith("check none.yaml").err, EndsWith("none.urdf.xacro: no such file\n"));
}

}  // namespace
