#include "planner/app/options.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "planner/problem/number_text.h"

namespace corridor::app {

CLI::Validator isOneOf(std::vector<std::string> words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "{" : ",") + word;
  return {[words = std::move(words)](std::string& text) {
            return std::find(words.begin(), words.end(), text) != words.end()
                       ? std::string()
                       : notOneOf(text, words);
          },
          list + "}"};
}

CLI::Validator isWithin(const ClosedRange& range) {
  return isWithin(range.lower, range.upper, range.text());
}

CLI::Validator isSeconds() {
  return isWithin(std::numeric_limits<double>::min(), std::numeric_limits<double>::max(),
                  "a number of seconds above 0");
}

CLI::Validator isMetres() {
  return isWithin(0.0, std::numeric_limits<double>::max(), "a number of metres, 0 or more,");
}

CLI::Validator isSeed() {
  return isWithin<std::uint64_t>(0, std::numeric_limits<std::uint64_t>::max(),
                                 "a whole number from 0 to 2^64 - 1");
}

CLI::Validator isResolution() {
  return {[](std::string& text) {
            double value = 0;
            return parseNumber(text, Range::Resolution, value);
          },
          ""};
}

void addJson(CLI::App& command, bool& json, const char* heading) {
  command.add_flag("--json", json, "results as JSON")->group(heading);
}

void addQuiet(CLI::App& command, bool& quiet, const char* heading) {
  command.add_flag("--quiet", quiet, "print no report on stdout")->group(heading);
}

void addFrom(CLI::App& command, std::optional<std::string>& from, const char* heading) {
  command
      .add_option("--from", from,
                  "direction from which the picture is seen: front (the viewer is at +x), back, "
                  "left (+y), right, top, bottom, or AZIMUTH,ELEVATION in degrees, such as "
                  "--from=-60,38")
      ->group(heading);
}

void addIgnoreDigest(CLI::App& command, bool& ignore) {
  command.add_flag(
      "--ignore-digest", ignore,
      "verify the solution even if its digest is not the problem's: it was made for another "
      "problem, or a file has changed since (without this option the verdict is: other problem)");
}

}  // namespace corridor::app
