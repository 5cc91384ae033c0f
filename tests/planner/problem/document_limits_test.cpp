// A document that is nested too deeply, is too large, or expands without bound must be refused at
// once, and must not use up memory, time or stack.
#include "planner/problem/yaml_reader.h"
#include "tests/planner/problem/problem_fixture.h"

namespace corridor::test {
namespace {

using testing::HasSubstr;

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  all.reserve(text.size() * times);
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

class DocumentLimits : public ProblemTest {
 protected:
  static std::string complaintOfYaml(const std::string& text, const YamlLimits& limits = {}) {
    try {
      parseYaml("a.yaml", text, limits);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no complaint";
  }
};

TEST_F(DocumentLimits, YamlDepth) {
  const std::string message =
      ":1: has lists and maps nested more than 64 deep; no valid file needs more";
  EXPECT_EQ(complaintOfYaml(repeated("[", 64) + repeated("]", 64)), "no complaint");
  for (const std::size_t depth : {std::size_t{65}, std::size_t{100'000}}) {
    EXPECT_EQ(complaintOfYaml(repeated("[", depth) + repeated("]", depth)), "a.yaml" + message);
    EXPECT_EQ(complaintOfYaml(repeated("{a: ", depth) + repeated("}", depth)), "a.yaml" + message);
    EXPECT_EQ(complaintOfYaml(repeated("- ", depth) + "1\n"), "a.yaml" + message);
  }
  std::string blocks;
  for (std::size_t i = 0; i < 1000; ++i) blocks += std::string(i, ' ') + "a:\n";
  EXPECT_EQ(complaintOfYaml(blocks).substr(0, 9), "a.yaml:65");
  EXPECT_EQ(
      complaintOf(head + "start: " + repeated("[", 100'000) + repeated("]", 100'000)),
      "problem.yaml:5: has lists and maps nested more than 64 deep; no valid file needs more");
}

TEST_F(DocumentLimits, YamlNodes) {
  EXPECT_EQ(YamlLimits{}.nodes, 10'000'000u);
  const YamlLimits limits{1000, 64};
  EXPECT_EQ(complaintOfYaml(repeated("- 1\n", 999), limits),
            "no complaint");  // the list counts, too
  const std::string message = ": has more than 1000 keys and values; split the file";
  EXPECT_EQ(complaintOfYaml(repeated("- 1\n", 1000), limits), "a.yaml:1000" + message);
  EXPECT_EQ(complaintOfYaml(repeated("- a: {b: \n    []}\n", 1000), limits),
            "a.yaml:400" + message);
}

/// Nine lists, each of ten aliases of the list before: expanded, they would have 10^9 values.
TEST_F(DocumentLimits, YamlAliases) {
  std::string laughs = "a: &a [lol, lol, lol, lol, lol, lol, lol, lol, lol, lol]\n";
  for (char c = 'b'; c < 'j'; ++c) {
    const std::string last = std::string(", *") + static_cast<char>(c - 1);
    laughs += std::string(1, c) + ": &" + c + " [" + repeated(last, 10).substr(2) + "]\n";
  }
  EXPECT_EQ(complaintOfYaml(laughs),
            "a.yaml:2: aliases (*name) are not read here; write the value out");
}

/// 200,000 keys in one map: reading must not take quadratic time.
TEST_F(DocumentLimits, YamlKeys) {
  std::string text = "same: 1\n";
  for (int i = 0; i < 200'000; ++i) text += "key" + std::to_string(i) + ": " + "1\n";
  text += "same: 2\n";
  const YamlValue document = parseYaml("a.yaml", text);
  FaultList faults;
  YamlSource source{"a.yaml", faults, {}};
  const YamlMap map(document, "", nullptr, source);
  double sum = 0;
  for (const auto* entry : map.entries()) sum += map.number(entry->key).value_or(0);
  EXPECT_EQ(sum, 200'001);
  EXPECT_EQ(faults.size(), 1u);
}

TEST_F(DocumentLimits, FaultsAreListedUpToAThousand) {
  std::string text = head + poses;
  for (int i = 0; i < 100'000; ++i) text += "unknown" + std::to_string(i) + ": 1\n";
  const std::string message = complaintOf(text);
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1000);
  EXPECT_THAT(message,
              HasSubstr("problem.yaml: reading stopped at 1000 faults; there may be more"));
}

TEST_F(DocumentLimits, Json) {
  const std::string deep =
      ": has lists and objects nested more than 64 deep; a set needs no more than six";
  for (const std::string& open : {std::string("["), std::string("{\"a\": ")})
    EXPECT_EQ(complaint(write("a.json", repeated(open, 100'000))), "a.json" + deep);
  EXPECT_EQ(complaint(write("a.json", "[" + repeated("[],", 10'000'000) + "1]")),
            "a.json: has more than 10000000 keys and values; split the set");
  EXPECT_EQ(complaint(write("a.json", repeated("[", 100) + std::string(1, '\0'))),
            "a.json:1: is not text: it has a byte 0; UTF-8 is needed");
}

TEST_F(DocumentLimits, CfgLines) {
  EXPECT_THAT(complaint(write("a.cfg", std::string(50'000'000, 'x'))),
              HasSubstr("a.cfg:1: [section] or key = value is needed, not \"xxx"));
  EXPECT_THAT(complaint(write("a.cfg", "[problem]\nrobot = " + std::string(5'000'000, '[') + "\n")),
              HasSubstr("a.cfg:2: robot: "));
  const std::string message = complaint(write("a.cfg", repeated("x\n", 1'000'000)));
  EXPECT_THAT(message, HasSubstr("a.cfg: reading stopped at 1000 faults; there may be more"));
}

TEST_F(DocumentLimits, PairsOfBodies) {
  // 4,600 spheres, each on a joint of its own, have more than 10^7 pairs.
  std::string urdf = "<robot name=\"r\">\n<link name=\"l0\"/>\n", state;
  for (int i = 1; i <= 4600; ++i) {
    const std::string n = std::to_string(i);
    state += (i > 1 ? ", j" : "j") + n + ": 0";
    urdf += "<link name=\"l" + n +
            "\"><collision><geometry><sphere radius=\"1\"/></geometry></collision></link>\n"
            "<joint name=\"j" +
            n + "\" type=\"continuous\"><parent link=\"l0\"/><child link=\"l" + n +
            "\"/></joint>\n";
  }
  write("many.urdf", urdf + "</robot>\n");
  EXPECT_THAT(
      complaintOf("format: corridor-problem-1\nrobot: many.urdf\nstart: {" + state + "}\ngoal: {" +
                  state + "}\n"),
      HasSubstr("problem.yaml: has 10577700 pairs of bodies, but at most 10000000 are "
                "supported; join shapes that do not move relative to each other into one body"));
}

}  // namespace
}  // namespace corridor::test
