#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "collision/core/spelling.h"
#include "planner/model/settings.h"

/// Options, validators and texts that several commands share.
namespace corridor::app {

/// The last lines of every help text.
inline constexpr const char* kExitStatus =
    "Exit status: 0 done; 1 no: nothing found, not proved, or not valid; 2 bad input, or a result "
    "can't be written; 3 internal error; 128 + N stopped by signal N (130: Ctrl-C).";

/// Accepts numbers from `low` to `high`; `needed` describes them in the error. (CLI11's own ranges
/// accept NaN, and print 309 digits.)
template <class Number>
CLI::Validator isWithin(Number low, Number high, const std::string& needed) {
  const auto complaint = [=](std::string& text) -> std::string {
    Number value{};
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool isNumber = error == std::errc{} && stop == text.data() + text.size();
    if (isNumber && low <= value && value <= high) return "";
    return needed + " is needed, not " + quotedWord(text);
  };
  return {complaint, ""};
}
CLI::Validator isWithin(const ClosedRange& range);
/// Accepts these words only. The error for another word suggests the most similar one of them.
CLI::Validator isOneOf(std::vector<std::string> words);
CLI::Validator isSeconds();  ///< a number above 0
CLI::Validator isMetres();   ///< a number of 0 or more
CLI::Validator isSeed();     ///< a whole number of 64 bits
/// Accepts the numbers that `checker: {resolution: …}` in problem files accepts. The error has the
/// same message.
CLI::Validator isResolution();

/// The heading under which CLI11's help lists the options that have no heading of their own.
inline constexpr const char* kOptions = "Options";

void addJson(CLI::App& command, bool& json, const char* heading = kOptions);
void addQuiet(CLI::App& command, bool& quiet, const char* heading = kOptions);
void addFrom(CLI::App& command, std::optional<std::string>& from, const char* heading);
void addIgnoreDigest(CLI::App& command, bool& ignore);

}  // namespace corridor::app
