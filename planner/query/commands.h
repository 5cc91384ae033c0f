#pragma once

namespace CLI {
class App;
}

/// The commands of the program `corridor_query`, which `corridor` runs (app/other_program.h).
namespace corridor::app {

/// Adds a command, as planner/app/commands.h says. `inspect` has the options of
/// `corridor inspect --against`, which `corridor` has checked.
void addQuery(CLI::App& program, int& status);
void addCourse(CLI::App& program, int& status);
void addInspectCost(CLI::App& program, int& status);

}  // namespace corridor::app
