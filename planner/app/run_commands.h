#pragma once

#include <functional>
#include <initializer_list>

namespace CLI {
class App;
}

namespace corridor::app {

/// Runs a program: standard streams, help, errors and exit statuses.
/// @param commands adds the commands (commands.h). @returns the exit status.
int runCommands(int argc, char** argv,
                std::initializer_list<std::function<void(CLI::App&, int&)>> commands);

}  // namespace corridor::app
