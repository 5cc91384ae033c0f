// The program `corridor`. The commands are in NAME_command.cpp; three of them belong to programs of
// their own, so that a first `corridor solve` does not build them (other_program.h).
#include <string_view>

#include "planner/app/commands.h"
#include "planner/app/other_program.h"
#include "planner/app/run_commands.h"

using namespace corridor::app;

int main(int argc, char** argv) {
  const std::string_view command = argc > 1 ? argv[1] : "";
  if (command == "benchmark") return becomeProgram("corridor_benchmark", {argv + 1, argv + argc});
  if (command == "query" || command == "course")
    return becomeProgram("corridor_query", {argv + 1, argv + argc});
  return runCommands(argc, argv,
                     {addSolve, addVerify, addView, listBenchmark, addCheck, addInspect, addPose,
                      listQuery, listCourse, addNew, addCache});
}
