// The program behind `corridor benchmark`.
#include "planner/app/commands.h"
#include "planner/app/run_program.h"

int main(int argc, char** argv) {
  return corridor::app::runProgram(argc, argv, {corridor::app::addBenchmark});
}
