// The program behind `corridor query` and `corridor inspect --against`.
#include "planner/app/run_program.h"
#include "planner/query/commands.h"

int main(int argc, char** argv) {
  return corridor::app::runProgram(argc, argv,
                                   {corridor::app::addQuery, corridor::app::addInspectCost});
}
