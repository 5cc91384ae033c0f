// Fuzz target: MoveIt's messages as YAML. An input has the planning scene, a line "--- request",
// and the motion-plan request.
#include "planner/checker/checker.h"
#include "planner/problem/problem.h"
#include "tests/stress/fuzz/small_world.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace corridor;
  static const fuzz::Folder folder;
  static const bool ready = (fuzz::writeSmallWorld(folder), true);
  constexpr std::string_view separator = "\n--- request\n";
  const std::string_view text = fuzz::textOf(data, ready ? size : 0);
  const std::size_t at = text.find(separator);
  folder.write("problems/p/scene.yaml", text.substr(0, at));
  folder.write("problems/p/request.yaml",
               at == text.npos ? std::string_view() : text.substr(at + separator.size()));
  const auto file = folder.write("problems/p/problem.yaml",
                                 "format: corridor-problem-1\nrobot: ../../robots/arm6/robot.yaml\n"
                                 "moveit: {scene: scene.yaml, request: request.yaml}\n");
  fuzz::readsOrRefuses([&] {
    const Problem problem = readProblem(file);
    const Checker checker(problem);
    if (!checker.inBounds(problem.task.start)) fuzz::fail("the start is out of bounds");
    checker.interference(problem.task.start);
  });
  return 0;
}
