// The program behind `corridor benchmark`.
#include "planner/app/commands.h"
#include "planner/app/run_commands.h"

int main(int argc, char** argv) {
  return corridor::app::runCommands(argc, argv, {corridor::app::addBenchmark});
}
