#include "planner/app/run_commands.h"

#include <csignal>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>

#include "collision/core/error.h"
#include "collision/core/floating_point.h"
#include "collision/core/spelling.h"
#include "planner/app/commands.h"
#include "planner/app/options.h"
#include "planner/app/output.h"
#include "planner/app/rank_job.h"
#include "planner/app/standard_streams.h"
#include "planner/app/usage.h"

namespace corridor::app {

int runCommands(int argc, char** argv,
                std::initializer_list<std::function<void(CLI::App&, int&)>> commands) {
  openStandardStreams();
  // By default SIGXFSZ ends the program when a file reaches the size limit (ulimit -f). If the
  // signal is ignored, writing fails instead, and is reported like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  // If the parent process ignores SIGCHLD, this process inherits that, and the exit statuses of its
  // own children would be lost.
  std::signal(SIGCHLD, SIG_DFL);
  if (const auto arithmetic = floatingPoint(); arithmetic != FloatingPoint::standard) {
    std::cerr << "corridor: nothing can be proved with these floating-point settings: "
              << described(arithmetic)
              << "; remove the library or wrapper that sets them when the program is loaded\n";
    return kInternal;
  }
  CLI::App program("Corridor plans collision-free motions and proves each one.", "corridor");
  program.set_version_flag("--version", CORRIDOR_VERSION);
  program.require_subcommand(1);
  program.footer(
      std::string("corridor COMMAND --help lists a command's options.\n"
                  "In a checkout, ./corridor also has the commands python, test and fuzz.\n") +
      kExitStatus);
  int status = kDone;
  for (const auto& add : commands) add(program, status);
  refuseEmptyValues(program);
  try {
    try {
      program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      if (error.get_exit_code() != 0) {
        letRank0Report();
        std::cerr << usageFault(program, error, argc > 1 ? argv[1] : "") << '\n';
        return kBadInput;
      }
      program.exit(error);  // --help, --version
    }
    requireResultsWritten();
  } catch (const InputError& error) {
    letRank0Report();
    printFaults(error);
    return kBadInput;
  } catch (const std::filesystem::filesystem_error& error) {  // such as a folder that was deleted
    std::cerr << "corridor: " << withoutControls(error.what()) << '\n';
    return kBadInput;
  } catch (const std::system_error& error) {  // such as a pipe for another process
    const bool few = error.code() == std::errc::too_many_files_open ||
                     error.code() == std::errc::too_many_files_open_in_system;
    const bool isShort = few || error.code() == std::errc::resource_unavailable_try_again;
    std::cerr << "corridor: " << (isShort ? "" : "internal error: ")
              << withoutControls(error.what())
              << (few       ? "; raise the limit on open files (ulimit -n)"
                  : isShort ? "; raise the limit on processes (ulimit -u), or ask for fewer jobs"
                            : "")
              << '\n';
    return isShort ? kBadInput : kInternal;
  } catch (const std::bad_alloc&) {
    std::cerr << "corridor: out of memory: too many bodies, pairs of bodies or triangles, or too "
                 "large a parameter";
    for (int i = 2; i < argc; ++i)  // the inputs
      if (argv[i][0] != '-')
        std::cerr << (i == 2 ? "; called with " : " ") << withoutControls(argv[i]);
    std::cerr << '\n';
    return kBadInput;
  } catch (const std::exception& error) {
    std::cerr << "corridor: internal error: " << error.what() << '\n';
    return kInternal;
  }
  return status;
}

}  // namespace corridor::app
