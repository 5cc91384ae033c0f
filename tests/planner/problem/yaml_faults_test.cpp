#include <string>

#include <gmock/gmock.h>

#include "planner/problem/yaml_value.h"
#include "tests/planner/problem/problem_faults.h"

namespace corridor::test {
namespace {

/// Faults that make a file no YAML, as users see them in problem files.
using YamlFaults = ProblemFaults;

// A parser finds the fault only at the end of the file, or at the next quote.
TEST_F(YamlFaults, QuotesThatAreNotClosed) {
  const std::string unclosed = "problem.yaml:9: is not YAML: a quote on this line is not closed";
  for (const char* text :
       {"seed: 1\nallow: [[a, \"b]]\nmargin: 0.02\n",
        "seed: 1\nplanner: {name: 'RRT}\nmargin: 1\n\n", "seed: 1\nplanner: \"RRT\r\nmargin: 1\r\n",
        "seed: 1\nplanner: \"", "seed: 1\nplanner: \"\n",
        "seed: 1\nplanner: \"a\\\"\nmargin: 1\n# end",
        "seed: 1\nplanner: \"a\nmargin: 1\n \nb: 'c'\n", "seed: 1\nplanner: !!str 'a\nmargin: 1\n",
        "seed: 1\n\"planner: RRT\nmargin: 1\n"})
    EXPECT_EQ(with(text), unclosed) << text;
  EXPECT_EQ(with("planner: \"of\n  two lines\"\nname: \"x\n"),
            "problem.yaml:10: is not YAML: a quote on this line is not closed");
  for (const char* mark : {"---\na: 1\n", "...\n"})
    EXPECT_EQ(with("planner: \"RRT\n" + std::string(mark)),
              "problem.yaml:8: is not YAML: a quote on this line is not closed");
}

TEST_F(YamlFaults, QuotesThatAreClosedTooLate) {
  for (const char* text :
       {"seed: 1\nplanner: \"RRT\nmargin: 1\nallow: [[\"a\", b]]\n",
        "name: \"x\nmargin: 1\n\n# of 30\"\n", "seed: 1\nname: 'x\n at: [0, 0]\n # the robots'\n",
        "allow:\n - [\"a, b]\n\n - [c, \"]\n", "seed: 1\nname: 'x\n can 1: {}\n y'\n",
        "seed: 1\nname: 'x\n margin : 1\n y'\n", "seed: 1\nname: 'x\n margin:\n y'\n",
        "seed: 1\nname: 'x\n\n éééééééé a: b'\n",
        "seed: 1\np: {name: 'x,\n  \"margin\":0.1,\n # r'}\n",
        "seed: 1\np: {name: 'x, margin: 1,\n\n # r'}\n", "seed: 1\nname: 'x\n-\n # r'\n",
        "seed: 1\nname: 'x\n ? margin\n # r'\n"}) {
    const std::string line = text[0] == 's' || text[0] == 'a' ? "9" : "8";
    EXPECT_EQ(with(text),
              "problem.yaml:" + line +
                  ": a quote on this line is closed only on line 11, "
                  "behind what looks like a key or an item; is a quote missing? If not, "
                  "write the text on one line")
        << text;
  }
  EXPECT_EQ(with("name: \"a\n b\" c\n"),
            "problem.yaml:9: is not YAML: nothing may follow the value on this line; the quote on "
            "line 8 is closed only here: is one missing?");
}

TEST_F(YamlFaults, QuotesMayHaveSeveralLines) {
  for (const char* text : {"planner: !!str\n  'a: b'\n", "planner: \"a\n  b\"\n",
                           "planner: 'a\n\n  b'\n# 'x\n", "planner: 'it''s\n a b'"})
    EXPECT_THAT(with(text), testing::HasSubstr("problem.yaml:8: planner: a map")) << text;
}

// A tag may say something that no reader knows: a unit, another type.
TEST_F(YamlFaults, TagsAreNotRead) {
  const auto fault = [](const std::string& line, const std::string& tag) {
    return "problem.yaml:" + line + ": tags (" + tag +
           ") are not read here; write the value without it";
  };
  EXPECT_EQ(with("bounds:\n  at: !cm [1, 2, 3]\n"), fault("9", "!cm"));
  EXPECT_EQ(with("planner: !deg {time: 1}\n"), fault("8", "!deg"));
  EXPECT_EQ(with("planner:\n  time: !cm 1\n"), fault("9", "!cm"));
  EXPECT_EQ(with("planner: {name: !cm RRT}\n"), fault("8", "!cm"));
  EXPECT_EQ(with("margin: !!python/object:m.Metres 1\n"), fault("8", "!!python/object:m.Metres"));
  EXPECT_EQ(with("allow: !!set {}\n"), fault("8", "!!set"));
  EXPECT_EQ(with("allow: !!map []\n"), fault("8", "!!map"));
  EXPECT_EQ(with("margin: !cm\n"), fault("8", "!cm"));
  EXPECT_EQ(with("!cm margin: 1\n"), fault("8", "!cm"));
  for (const std::string text :
       {"tube: {joints: !degrees 90}\n", "bounds: {max_velocity: !degrees 3}\n"})
    EXPECT_EQ(with(text), fault("8", "!degrees") + ", in the unit of its key");
  EXPECT_EQ(with("planner: !!map {name: !!str RRT}\nallow: !!seq []\n"), "no complaint");
  EXPECT_EQ(with("margin: !!float 0.1\nallow: !!python/tuple []\nseed: !!int 3\n"), "no complaint");
}

TEST_F(YamlFaults, DecimalCommas) {
  const std::string end = "a number is needed, not \"1,5\"; decimals need a point, not a comma";
  EXPECT_EQ(with("margin: 1,5\n"), "problem.yaml:8: margin: " + end);
  EXPECT_THAT(complaintOf("format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  rock:\n    "
                          "box:\n    - 1,5\n    - 2\n    - 3\n"),
              testing::HasSubstr("problem.yaml:6: world.rock.box: " + end));
  EXPECT_EQ(with("margin: 1,500,000\n"),
            "problem.yaml:8: margin: a number is needed, not \"1,500,000\"");
}

TEST_F(YamlFaults, DirectivesAfterOtherLines) {
  const std::string why =
      ": a line that begins with % is not read after the first lines; remove it, or put the value "
      "in quotes";
  EXPECT_EQ(complaintOf("%YAML 1.2\n---\n" + head + poses), "no complaint");
  EXPECT_EQ(complaintOf("# a\na: 1\n%YAML 1.2\n"), "problem.yaml:3" + why);
  EXPECT_EQ(complaintOf("a: 1\n%x\nb: 2\n"), "problem.yaml:2" + why);
}

TEST_F(YamlFaults, Syntax) {
  EXPECT_EQ(complaintOf("format: corridor-problem-1\nrobot: [robot.yaml\nworld: {}\n"),
            "problem.yaml:3: is not YAML: a comma or a ] is missing, here or above");
  EXPECT_EQ(complaintOf("format: corridor-problem-1\nworld: {a: [1, 2}\n"),
            "problem.yaml:2: is not YAML: a comma or a ] is missing, here or above");
  EXPECT_EQ(with("margin: *m\n"),
            "problem.yaml:8: aliases (*name) are not read here; write the value out");
  EXPECT_EQ(with("margin: &m 1\nseed: *m\n"),
            "problem.yaml:9: aliases (*name) are not read here; write the value out");
  EXPECT_EQ(with("[1]: 2\n"), "problem.yaml:8: a key must be a word");
  EXPECT_EQ(with("planner:\n\tname: RRT\n"),
            "problem.yaml:9: is not YAML: the line is indented by a tab; use blanks");
  const auto expectFault = [&](const char* text, const char* fault) {
    EXPECT_EQ(with(text), std::string("problem.yaml:") + fault) << text;
  };
  for (const char* text : {"planner:\n    name: RRT\n  time: 3\n",
                           "allow:\n  - [a, b]\n - [a, c]\n", "allow:\n  - [a, b]\n  [a, c]\n"})
    expectFault(text,
                "10: is not YAML: \"key: value\" or \"- value\" is needed here, indented like the "
                "lines above it, and with a blank after the colon or the minus");
  expectFault("planner:\n  name: RRT\n  time:3\n",
              "10: is not YAML: \"key: value\" or \"- value\" is needed here, indented like the "
              "lines above it, and with a blank after the colon or the minus");
  expectFault("planner: {name: RRT, time:3}\n",
              "8: unknown key \"time:3\" in planner; write a blank after the colon (known: name, "
              "time, stop, restart, params)");
  expectFault("base: {at:[0, 0, 1]}\n",
              "8: is not YAML: a blank is missing behind a colon on this line");
  expectFault("planner: {name: *.urdf}\n",
              "8: is not YAML: a text that begins with * must be in quotes");
  expectFault("...\nmargin: 1\n", "9: is not YAML: nothing may follow the line ...");
  expectFault("seed: \"3\"\n",
              "8: seed: a whole number from 0 to 2^64 - 1 is needed, not \"3\"; write it without "
              "quotes");
  EXPECT_EQ(complaintOf("%YAML 1.2\n" + head + poses),
            "problem.yaml:2: is not YAML: --- is missing below the lines that begin with %");
  expectFault("allow: [[a, b], , ]\n", "8: is not YAML: a value is missing here");
  expectFault("margin: 1\n# old:\u2028margin: 2\n",
              "9: the character U+2028 ends a line in YAML 1.1, but not in 1.2; replace it");
  expectFault("margin: 1\n# bell: \a\n", "9: is not YAML: control characters are not allowed");
  for (const char* text : {"margin: [1, 2],\n", "margin: [1, 2] m\n", "margin: \"A\" \"B\"\n"})
    expectFault(text, "8: is not YAML: nothing may follow the value on this line");
  const std::string colon =
      ": is not YAML: a colon can't be here; perhaps this line or the line above lacks a colon or "
      "the blank after it; a map on one line needs braces, {key: value}, and a text with a colon "
      "needs quotes";
  EXPECT_EQ(with("planner: name: RRT\n"), "problem.yaml:8" + colon);
  EXPECT_EQ(with("planner:\n  name:RRT\n  time: 3\n"), "problem.yaml:10" + colon);
  for (const char* text : {"allow: - [a, b]\n", "allow: [- 1, 0]\n"})
    expectFault(text,
                "8: is not YAML: \"- \" begins a list item; it must begin its line, and can't be "
                "inside [ ] or { }");
  expectFault("planner: {name: @RRT}\n",
              "8: is not YAML: a text that begins with @ must be in quotes");
  EXPECT_EQ(with("---\n---\n"), "no complaint");
  EXPECT_EQ(with("# first\rmargin: x\r\n"),
            "problem.yaml:9: margin: a number is needed, not \"x\"");
  EXPECT_EQ(with("---\n---\na: 1\n"),
            "problem.yaml:8: has more than one YAML document (---); keep one");
  EXPECT_EQ(with("---\na: 1\n"), "problem.yaml:8: has more than one YAML document (---); keep one");
}

}  // namespace
}  // namespace corridor::test
