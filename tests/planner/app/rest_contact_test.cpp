// Tests of what the program says about bodies that are in contact in every state: links on held
// joints, bases on a table, and pairs that are allowed to touch.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/app/program_test.h"

namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// A foot with two arms: the left one is held, and turns up and down; the right one turns about z.
/// The foot's lower face is at z = 0. The upper face of a table is at z = `top`.
class RestContact : public corridor::test::ProgramTest {
 protected:
  RestContact() {
    const std::string arm =
        "<collision><origin xyz='0.4 0 0'/><geometry><box size='0.7 0.1 0.1'/></geometry>"
        "</collision></link>";
    const std::string limits = "<limit lower='-2' upper='2' effort='1' velocity='1'/></joint>";
    write("two.urdf",
          "<robot name='two'><link name='foot'><collision><origin xyz='0 0 0.05'/><geometry>"
          "<box size='0.2 0.2 0.1'/></geometry></collision></link><link name='l3'>" +
              arm + "<link name='r3'>" + arm +
              "<joint name='left' type='revolute'><parent link='foot'/><child link='l3'/>"
              "<origin xyz='0 0.5 0.5'/><axis xyz='0 1 0'/>" +
              limits +
              "<joint name='right' type='revolute'><parent link='foot'/><child link='r3'/>"
              "<origin xyz='0 -0.5 0.5'/><axis xyz='0 0 1'/>" +
              limits + "</robot>");
    write("rows.csv", "time,right\n0,0\n1,0.5\n");
    write("states.txt", "0\n0.5\n");
    write("edges.txt", "0 0.5\n");
  }

  void writeProblem(double left, double top, const std::string& more = "") const {
    write("robot.yaml", "format: corridor-robot-1\nurdf: two.urdf\njoints: [right]\nhold: {left: " +
                            std::to_string(left) + "}\n");
    write("p.yaml",
          "format: corridor-problem-1\nrobot: robot.yaml\nworld: {table: {box: [3, 3, 0.1], at: "
          "[0, 0, " +
              std::to_string(top - 0.05) + "]}}\nstart: {right: 0}\ngoal: {right: 0.5}\n" + more);
  }
  json jsonOf(const std::string& arguments) const { return json::parse(run(arguments).out); }
};

constexpr double kDown = 1.5, kLevel = 0;

const std::string kWhy =
    "in contact in every state: \"l3\" and \"table\" touch, and the joint between them, \"left\", "
    "is held; hold it at another value, or add allow: [[l3, table]] if this is intended";

TEST_F(RestContact, OfAHeldArmIsAFault) {
  writeProblem(kDown, -0.1);
  const Result checked = run("check p.yaml");
  EXPECT_EQ(checked.status, 1);
  EXPECT_THAT(checked.out, HasSubstr("start: " + kWhy + "\ngoal: " + kWhy + "\n"));
  EXPECT_EQ(run("check p.yaml --states states.txt").out,
            "state,valid,pairs\n0,0,l3~table\n1,0,l3~table\n");
  EXPECT_EQ(run("check p.yaml --states states.txt").status, 1);
  EXPECT_EQ(run("check p.yaml --edges edges.txt").out,
            "edge,verdict,t0,t1,pair,reason\n0,contact,0,0,l3~table,\n");
  const json report = jsonOf("check p.yaml --json");
  EXPECT_EQ(report["valid"], false);
  EXPECT_EQ(report["ends"]["start"], kWhy);
  expectFault("solve p.yaml", "p.yaml:4: start: " + kWhy);
  EXPECT_EQ(run("inspect p.yaml").status, 1);
  EXPECT_THAT(run("inspect p.yaml").out, HasSubstr("start: " + kWhy + "\n"));
}

TEST_F(RestContact, IsRefutedByTheVerifier) {
  writeProblem(kDown, -0.1);
  const Result verified = run("verify p.yaml rows.csv");
  EXPECT_EQ(verified.status, 1);
  EXPECT_THAT(verified.out, HasSubstr("verdict: refuted\n"));
  EXPECT_THAT(verified.out, HasSubstr("edges proved: 0 of 1\n"));
  EXPECT_THAT(verified.out,
              testing::ContainsRegex(
                  "finding: refuted: in every state: contact: \"l3\" and \"table\", near [^;]*, "
                  "and the joint between them, \"left\", is held; hold it at another value, or "
                  "add allow: [[][[]l3, table[]][]] if this is intended\n"));
  EXPECT_THAT(verified.out, Not(HasSubstr("clearance")));
  const json report = jsonOf("verify p.yaml rows.csv --json");
  EXPECT_EQ(report["verdict"], "refuted");
  ASSERT_EQ(report["findings"].size(), 1u);
  EXPECT_EQ(report["findings"][0]["in_every_state"], true);
  EXPECT_EQ(report["findings"][0]["a"], "l3");
  EXPECT_EQ(report["findings"][0]["b"], "table");
  EXPECT_TRUE(report["findings"][0]["free_until"].is_null());
  // Margin and padding count, too: the arm's lower face is at z = 0.45.
  writeProblem(kLevel, 0.44, "allow: [[foot, table], [r3, table]]\n");
  EXPECT_EQ(run("verify p.yaml rows.csv").status, 0);
  const Result near = run("verify p.yaml rows.csv --margin 0.02");
  EXPECT_EQ(near.status, 1);
  EXPECT_THAT(near.out, HasSubstr("in every state: closer than the margin: \"l3\" and \"table\", "
                                  "0.01 m apart, and more than 0.02 m is needed, near "));
}

TEST_F(RestContact, IsMendedByAnotherValueOrByAllow) {
  writeProblem(kLevel, -0.1);
  const Result free = run("check p.yaml");
  EXPECT_EQ(free.status, 0);
  EXPECT_THAT(free.out, HasSubstr("start: free\ngoal: free\n"
                                  "not tested: 3 pairs: 2 adjacent, 1 never move relative to "
                                  "each other\n"));
  writeProblem(kDown, -0.1, "allow: [[l3, table]]\n");
  const std::string except = ", except 1 pair that touches at rest or is allowed to: l3 ~ table";
  const Result allowed = run("check p.yaml");
  EXPECT_EQ(allowed.status, 0);
  EXPECT_THAT(allowed.out, HasSubstr("start: free" + except + "\ngoal: free" + except + "\n"));
  const Result solved = run("solve p.yaml -o s.yaml");
  EXPECT_EQ(solved.status, 0);
  EXPECT_THAT(solved.out, HasSubstr("certified: yes" + except + "\n"));
  const Result verified = run("verify p.yaml s.yaml");
  EXPECT_EQ(verified.status, 0);
  EXPECT_THAT(verified.out, HasSubstr("verdict: proved" + except + "\n"));
  EXPECT_THAT(verified.out, HasSubstr("not tested: 4 pairs: 2 adjacent, 1 allow, 1 never move "
                                      "relative to each other\n"));
}

/// Only fixed joints are between the foot and the world, so its contact is no fault. But every
/// word of proof names it.
TEST_F(RestContact, OfABaseOnItsTableIsANote) {
  writeProblem(kLevel, 0);
  const std::string except = ", except 1 pair that touches at rest or is allowed to: foot ~ table";
  const std::string note =
      "note: in every state, these bodies touch: foot ~ table; no proof covers these pairs, "
      "because only fixed joints are between their bodies (allow: [[foot, table]] if this is "
      "intended)\n";
  const Result checked = run("check p.yaml");
  EXPECT_EQ(checked.status, 0);
  EXPECT_THAT(checked.out, HasSubstr("start: free" + except + "\n"));
  EXPECT_LT(checked.out.find(note), checked.out.find("note: joints that are not planned"));
  const Result states = run("check p.yaml --states states.txt");
  EXPECT_EQ(states.out, "state,valid,pairs\n0,1,\n1,1,\n");
  EXPECT_THAT(states.err, HasSubstr("note: the states are tested" + except + "\n"));
  EXPECT_THAT(run("check p.yaml --edges edges.txt").err,
              HasSubstr("note: the edges are tested" + except + "\n"));
  const Result solved = run("solve p.yaml -o s.yaml --trajectory t.csv");
  EXPECT_EQ(solved.status, 0);
  EXPECT_THAT(solved.out, HasSubstr("certified: yes" + except + "\n"));
  EXPECT_THAT(solved.out, HasSubstr("trajectory proved: yes, as it is written" + except + "\n"));
  for (const char* file : {"s.yaml", "t.csv"})
    EXPECT_THAT(run(std::string("verify p.yaml ") + file).out,
                HasSubstr("verdict: proved" + except + "\n"));
  EXPECT_THAT(run("view p.yaml s.yaml").out, HasSubstr("verdict: proved" + except + "\n"));
  EXPECT_THAT(run("inspect p.yaml").out, HasSubstr("start: free" + except + "\n"));
}

TEST_F(RestContact, IsInTheReportsOfAllCommands) {
  writeProblem(kLevel, 0, "allow: [[r3, table]]\n");
  const json leftOut = {{{"a", "foot"}, {"b", "table"}, {"reason", "touch at rest"}},
                        {{"a", "r3"}, {"b", "table"}, {"reason", "allow"}}};
  const json notTested = {{"adjacent", 2}, {"allow", 1}, {"never move relative to each other", 1}};
  run("solve p.yaml -o s.yaml");
  for (const char* arguments :
       {"check p.yaml --json", "check p.yaml --states states.txt --json",
        "check p.yaml --edges edges.txt --json", "verify p.yaml s.yaml --json"}) {
    const json report = jsonOf(arguments);
    EXPECT_EQ(report["left_out"], leftOut) << arguments;
    EXPECT_EQ(report["not_tested"], notTested) << arguments;
  }
  EXPECT_EQ(jsonOf("solve p.yaml --json")["problems"][0]["left_out"], leftOut);
  const json pairs = jsonOf("inspect p.yaml --json")["pairs"];
  EXPECT_EQ(pairs["left_out"], leftOut);
  EXPECT_EQ(pairs["not_tested"], notTested);
  EXPECT_EQ(pairs["skipped"], notTested);
  EXPECT_EQ(pairs["tested_at_rest"], 1) << "l3 and the table";
  EXPECT_THAT(run("inspect p.yaml --pairs").out,
              HasSubstr("pair: l3~table: only held joints between them: tested once"));
}

/// Several problems: each has a line of its own.
TEST_F(RestContact, IsCountedInAList) {
  writeProblem(kLevel, 0);
  write("q.yaml", read("p.yaml"));
  const Result solved = run("solve p.yaml q.yaml");
  EXPECT_EQ(solved.status, 0) << solved.err;
  EXPECT_THAT(solved.out, HasSubstr(", certified except 1 pair, "));
}

}  // namespace
