// The program behind `corridor query`, `corridor course` and `corridor inspect --against`.
#include "planner/app/run_commands.h"
#include "planner/query/commands.h"

int main(int argc, char** argv) {
  return corridor::app::runCommands(
      argc, argv,
      {corridor::app::addQuery, corridor::app::addCourse, corridor::app::addInspectCost});
}
