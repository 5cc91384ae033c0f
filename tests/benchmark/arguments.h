#pragma once

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <map>
#include <sched.h>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/support.h"
#include "tests/support/workload.h"

namespace corridor::bench {

/// A benchmark's command line: options `--name value`, each of which may be repeated, and flags
/// without a value.
class Arguments {
 public:
  /// @throws std::runtime_error for an option that is not in `known`, or that has no value.
  Arguments(int argc, char** argv, const std::vector<std::string>& known,
            const std::vector<std::string>& flags = {}) {
    const std::vector<std::string> words(argv + 1, argv + argc);
    for (auto word = words.begin(); word != words.end(); ++word) {
      std::vector<std::string>& values = values_[*word];
      if (std::find(flags.begin(), flags.end(), *word) != flags.end()) continue;
      if (std::find(known.begin(), known.end(), *word) == known.end())
        throw std::runtime_error(*word + ": unknown option");
      if (word + 1 == words.end()) throw std::runtime_error(*word + ": the value is missing");
      values.push_back(*++word);
    }
  }
  bool has(const std::string& name) const { return values_.count(name) > 0; }
  std::vector<std::string> texts(const std::string& name) const {
    const auto found = values_.find(name);
    return found == values_.end() ? std::vector<std::string>() : found->second;
  }
  std::string text(const std::string& name, const std::string& fallback = "") const {
    const auto all = texts(name);
    return all.empty() ? fallback : all.back();
  }
  /// Returns the option's values as numbers, or `fallback` if the option is not given. @throws
  /// std::runtime_error for a value that is not a number above 0.
  std::vector<double> numbers(const std::string& name, const std::vector<double>& fallback) const {
    std::vector<double> all;
    for (const std::string& text : texts(name)) {
      std::size_t end = 0;
      double value = 0;
      try {
        value = std::stod(text, &end);
      } catch (const std::logic_error&) {
      }
      if (end != text.size() || !(value > 0))
        throw std::runtime_error(name + ": a number above 0 is required, not " + text);
      all.push_back(value);
    }
    return all.empty() ? fallback : all;
  }
  double number(const std::string& name, double fallback) const {
    return numbers(name, {fallback}).back();
  }
  /// Returns the value of --rounds, rounded down to an integer but at least 1; `fallback` without
  /// the option.
  int rounds(int fallback) const {
    return std::max(static_cast<int>(number("--rounds", fallback)), 1);
  }
  /// Returns the folder that --data names; without --data, the folder of shared test data; an empty
  /// path if there is neither.
  std::filesystem::path data() const {
    const auto shared = test::dataFolder();
    return text("--data", shared ? shared->string() : "");
  }
  /// Returns the names of the workloads in `data()` that contain one of the texts given with
  /// --workload; without --workload, all names. @throws std::runtime_error if there is none.
  std::vector<std::string> workloads() const {
    if (data().empty())
      throw std::runtime_error("--data DIR is required if $CORRIDOR_DATA is not set");
    const auto wanted = texts("--workload");
    std::vector<std::string> names;
    for (const std::string& name : test::workloadNames(data() / "collision")) {
      const auto named = [&](const std::string& text) { return name.find(text) != name.npos; };
      if (wanted.empty() || std::any_of(wanted.begin(), wanted.end(), named)) names.push_back(name);
    }
    if (names.empty())
      throw std::runtime_error("--workload: no workload's name contains any of these texts");
    return names;
  }

 private:
  std::map<std::string, std::vector<std::string>> values_;
};

/// Pins the program to the core that --cpu names, or to the last core that the program may use.
/// Returns the core's number.
/// @throws std::runtime_error if there is no such core.
inline int pin(const Arguments& arguments) {
  cpu_set_t set;
  int cpu = -1;
  if (arguments.has("--cpu")) {
    cpu = std::stoi(arguments.text("--cpu"));
  } else {
    sched_getaffinity(0, sizeof set, &set);
    for (int i = 0; i < CPU_SETSIZE; ++i)
      if (CPU_ISSET(i, &set)) cpu = i;
  }
  CPU_ZERO(&set);
  CPU_SET(cpu, &set);
  if (cpu < 0 || sched_setaffinity(0, sizeof set, &set) != 0)
    throw std::runtime_error("--cpu: there is no CPU " + std::to_string(cpu) + " to use");
  return cpu;
}

/// The body of a benchmark's main function. Calls run(Arguments), and returns the exit status: 0,
/// or 2 after printing the message of an exception.
template <class Run>
int runWith(int argc, char** argv, const std::vector<std::string>& known, const Run& run,
            const std::vector<std::string>& flags = {}) {
  try {
    run(Arguments(argc, argv, known, flags));
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
  return 0;
}

}  // namespace corridor::bench
