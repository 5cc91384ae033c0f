#include "planner/problem/yaml_ledger.h"

#include <gmock/gmock.h>

#include "planner/problem/yaml_reader.h"
#include "tests/planner/problem/arm_fixture.h"

namespace corridor::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class YamlLedger : public testing::Test {
 protected:
  explicit YamlLedger() : faults_("f.yaml"), source_{"f.yaml", faults_, {}} {}

  static std::vector<std::string> unread(const YamlValue& document,
                                         DefaultValues defaults = DefaultValues::count) {
    std::vector<std::string> texts;
    for (const UnreadKey& key : unreadKeys(document, defaults))
      texts.push_back(key.path + ":" + std::to_string(key.line) + ":" + std::to_string(key.count));
    return texts;
  }

  FaultList faults_;
  YamlSource source_;
};

TEST_F(YamlLedger, KeysThatWereNotFoundAreUnread) {
  const YamlValue document =
      parseYaml("f.yaml", "a: 1\nb: {c: 2, d: 3}\ne: [{f: 1, g: 2}, {f: 1, g: 2}]\nh: {i: 1}\n");
  EXPECT_THAT(unread(document), ElementsAre("a:1:1", "b:2:1", "e:3:1", "h:4:1"));
  const YamlMap map(document, "", nullptr, source_);
  map.number("a");
  const YamlMap b(*map.find("b"), "b", nullptr, source_);
  b.number("c");
  for (const YamlValue* const item : itemsOf(map, "e"))
    YamlMap(*item, "e", nullptr, source_).number("f");
  map.find("h");
  EXPECT_THAT(unread(document), ElementsAre("b.d:2:1", "e[].g:3:2", "h:4:1"))
      << "a map whose key was read, but that was never opened, is unread";
  b.ignore({"d", "absent"});
  markRead(*map.find("h"));
  EXPECT_THAT(unread(document), ElementsAre("e[].g:3:2"));
  EXPECT_THAT(notesOnUnread(document, "f.yaml", DefaultValues::count).at(0).text,
              "f.yaml: not used: e[].g (line 3, and 1 more)");
}

TEST_F(YamlLedger, AnItemThatWasNotOpenedIsUnread) {
  const YamlValue document = parseYaml("f.yaml", "e: [{f: 1}, {f: 2}]\n");
  const YamlMap map(document, "", nullptr, source_);
  const auto items = itemsOf(map, "e");
  YamlMap(*items[0], "e[0]", nullptr, source_).number("f");
  EXPECT_THAT(unread(document), ElementsAre("e[]:1:1"));
}

TEST_F(YamlLedger, DefaultValuesMaySayNothing) {
  const YamlValue document = parseYaml(
      "f.yaml", "a: 0\nb: false\nc: \"\"\nd: []\ne: {f: 0.0, g: [0, 0]}\nh:\ni: 1\nj: [0, 1]\n");
  const YamlMap map(document, "", nullptr, source_);
  EXPECT_THAT(unread(document, DefaultValues::sayNothing), ElementsAre("i:7:1", "j:8:1"));
  EXPECT_EQ(unread(document).size(), 8u);
}

/// The ledger of the files that come with Corridor is empty: no key is dropped, and none that is
/// used is reported.
class LedgerOfProblems : public ArmTest {};

TEST_F(LedgerOfProblems, EachKeyOfAProblemIsRead) {
  write("arm.yaml",
        "format: corridor-robot-1\nname: a\nurdf: arm.urdf\nsrdf: arm.srdf\nvisuals: ignore\n"
        "limits: hard\ncollada_up: file\nstates: {own: {pan: 0, lift_deg: 10, slide: 0.02}}\n"
        "hold: {slide: 0.03}\njoints: [pan, lift]\nallow: [[base, lower]]\n"
        "weights: {rotation: 1, joints: {pan: 2}}\n");
  const Problem problem = read(
      "format: corridor-problem-1\nrobot: arm.yaml\nbase: {at: [0, 0, 1], rpy_deg: [0, 0, 9]}\n"
      "world:\n  ball: {sphere: {radius: 0.1}, at: [9, 0, 0]}\n"
      "  both: {shapes: [{box: [1, 1, 1], at: [9, 9, 0]}, {capsule: {radius: 1, length: 1}, at: "
      "[9, 9, 9]}]}\n"
      "start: {from: own, pan: 0.5}\ngoal: {any: [{pan: 1, lift: 0}], within: {joints: 0.1}}\n"
      "margin: 0.001\npadding: {bodies: {ball: 0.01}, pairs: [[ball, lower, 0.02]]}\n"
      "tube: {joints: 1e-6}\n"
      "limits: {joints: {pan: {velocity: 1}}}\nplanner: {name: RRTConnect, time: 1, params: "
      "{range: 1}}\nseed: 3\n");
  for (const Note& note : problem.source.notes)
    EXPECT_THAT(note.text, testing::Not(HasSubstr("not used"))) << note.text;
}

}  // namespace
}  // namespace corridor::test
