// Tests of the program `corridor verify`. Solutions of other problems are tested in
// other_problem_test.cpp.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/planner/app/program_fixtures.h"

namespace {

using testing::HasSubstr;

using VerifyCommand = corridor::test::CubeTest;

TEST_F(VerifyCommand, VerifyRefutes) {
  write("s.yaml",
        "format: corridor-solution-1\nspace: SE3\npath:\n- [-2, 0, 0, 0, 0, 0, "
        "1]\n- [2, 0, 0, 0, 0, 0, 1]\n");
  const Result verified = run("verify problem.yaml s.yaml");
  EXPECT_EQ(verified.status, 1);
  EXPECT_THAT(verified.out, HasSubstr("verdict: refuted\n"));
  EXPECT_THAT(verified.out, HasSubstr("finding: refuted: edge 0 at t = "));
  EXPECT_THAT(verified.out, HasSubstr("\"cube\" (triangle "));
  EXPECT_EQ(verified.err, "");
}

TEST_F(VerifyCommand, ReadsTheSolutionFromStandardInput) {
  write("s.yaml",
        "format: corridor-solution-1\nspace: SE3\npath:\n- [-2, 0, 0, 0, 0, 0, "
        "1]\n- [2, 0, 0, 0, 0, 0, 1]\n");
  const Result piped = run("verify problem.yaml -", "cat s.yaml | ");
  EXPECT_EQ(piped.status, 1) << piped.err;
  EXPECT_THAT(piped.out, HasSubstr("solution: -\nverdict: refuted\n"));
  EXPECT_EQ(run("verify problem.yaml - </dev/null").err, "-: is empty; a solution is needed\n");
  EXPECT_EQ(run("verify problem.yaml -", "echo x | ").status, 2);
}

TEST_F(VerifyCommand, BadInputIsOneLineAndExit2) {
  write("empty.yaml", "format: corridor-solution-1\nspace: SE3\npath: []\n");
  expectFault("verify problem.yaml empty.yaml",
              "empty.yaml:3: path: has no states; at least one is needed");
  expectFaultThatBegins("verify problem.yaml none.yaml", "none.yaml: ");
}

}  // namespace
