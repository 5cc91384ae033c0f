#include "planner/app/other_program.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <unistd.h>

#include <CLI/CLI.hpp>

#include "planner/app/commands.h"

namespace corridor::app {

int becomeProgram(const std::string& name, const std::vector<std::string>& arguments) {
  std::cout.flush();
  std::error_code error;
  const auto folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  std::string why = "it is not found";
  // An empty folder (no /proc) would name a file of the current folder.
  for (const std::filesystem::path& file : {folder / name, folder / CORRIDOR_HELPERS / name}) {
    if (folder.empty()) break;
    std::string program = file.string();
    std::vector<char*> words{program.data()};
    for (const std::string& argument : arguments)
      words.push_back(const_cast<char*>(argument.c_str()));  // execv changes nothing
    words.push_back(nullptr);
    ::execv(program.c_str(), words.data());
    if (errno != ENOENT) why = program + ": " + std::strerror(errno);
  }
  std::cerr << "corridor: this command needs the program " << name << ", and " << why
            << "; in a checkout, call ./corridor, which builds it\n";
  return kInternal;
}

void listBenchmark(CLI::App& program, int&) {
  program.add_subcommand("benchmark", kBenchmarkHelp);
}

void listQuery(CLI::App& program, int&) {
  program.add_subcommand("query", kQueryHelp);
}

void listCourse(CLI::App& program, int&) {
  program.add_subcommand("course", kCourseHelp);
}

}  // namespace corridor::app
