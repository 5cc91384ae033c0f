#pragma once

#include <algorithm>
#include <exception>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace corridor::bench {

/// What a benchmark was called with: `--name value`, any number of times.
class Arguments {
 public:
  /// @throws std::runtime_error for a name that is not in `known`, or without a value.
  Arguments(int argc, char** argv, const std::vector<std::string>& known) {
    const std::vector<std::string> words(argv + 1, argv + argc);
    for (std::size_t i = 0; i < words.size(); i += 2) {
      if (std::find(known.begin(), known.end(), words[i]) == known.end())
        throw std::runtime_error(words[i] + ": unknown option");
      if (i + 1 == words.size()) throw std::runtime_error(words[i] + ": a value is missing");
      values_[words[i]].push_back(words[i + 1]);
    }
  }
  std::vector<std::string> texts(const std::string& name) const {
    const auto found = values_.find(name);
    return found == values_.end() ? std::vector<std::string>() : found->second;
  }
  std::string text(const std::string& name, const std::string& fallback = "") const {
    const auto all = texts(name);
    return all.empty() ? fallback : all.back();
  }
  /// @throws std::runtime_error for one that is not a number above 0.
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
        throw std::runtime_error(name + ": a number above 0 is needed, not " + text);
      all.push_back(value);
    }
    return all.empty() ? fallback : all;
  }
  double number(const std::string& name, double fallback) const {
    return numbers(name, {fallback}).back();
  }

 private:
  std::map<std::string, std::vector<std::string>> values_;
};

/// The body of a benchmark's main. @returns its exit status.
template <class Run>
int runWith(int argc, char** argv, const std::vector<std::string>& known, const Run& run) {
  try {
    run(Arguments(argc, argv, known));
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
  return 0;
}

}  // namespace corridor::bench
