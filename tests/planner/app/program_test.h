#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <sys/wait.h>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace corridor::test {

/// A test that runs the program in a temporary folder, which the test creates and removes.
class ProgramTest : public testing::Test {
 protected:
  struct Result {
    int status = -1;
    std::string out, err;
  };

  ~ProgramTest() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  static std::vector<std::string> lines(const std::string& text) {
    std::vector<std::string> all;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) all.push_back(line);
    return all;
  }
  std::string read(const std::string& name) const { return contents(folder_ / name); }
  /// @param input shell commands before the program, such as "echo 0 | " for its stdin.
  Result run(const std::string& arguments, const std::string& input = "") const {
    const std::string command = "export CORRIDOR_CACHE='" + cache_ + "' && cd '" +
                                folder_.string() + "' && " + input + "'" CORRIDOR_PROGRAM "' " +
                                arguments + " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read("out.txt"), read("err.txt")};
  }

  /// Runs the program with bad input. Expects exactly the line `message` on stderr, nothing on
  /// stdout, and exit status 2.
  void expectFault(const std::string& arguments, const std::string& message) const {
    const Result result = run(arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_EQ(result.err, message + "\n") << arguments;
    EXPECT_EQ(result.out, "") << arguments;
  }

  /// Expects the same as `expectFault`, but `message` is only the beginning of the line on stderr.
  void expectFaultThatBegins(const std::string& arguments, const std::string& message) const {
    const Result result = run(arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_TRUE(result.err.starts_with(message)) << arguments << ": " << result.err;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
  }

  /// Returns the commands that `corridor --help` lists.
  std::vector<std::string> commands() const {
    std::vector<std::string> names;
    bool listed = false;
    for (const std::string& line : lines(run("--help").out)) {
      if (listed && line.starts_with("  ") && line.size() > 2 && line[2] != ' ')
        names.push_back(line.substr(2, line.find(' ', 2) - 2));
      if (line.starts_with("Subcommands")) listed = true;
    }
    EXPECT_FALSE(names.empty());
    return names;
  }

  std::filesystem::path folder_ = newFolder();
  std::string cache_ = "off";  ///< value of CORRIDOR_CACHE
};

}  // namespace corridor::test
