#pragma once

#include <string>

#include <CLI/CLI.hpp>

/// Faults of the command line itself.
namespace corridor::app {

/// Makes every option of every command refuse an empty value. An unset shell variable gives an
/// empty value, and the messages of later checks could not name the option.
void refuseEmptyValues(CLI::App& program);

/// Returns a message, in one line: what is wrong with the command line, and which help to read.
/// @param firstWord the first word of the command line, or "".
std::string usageFault(const CLI::App& program, const CLI::ParseError& error,
                       const std::string& firstWord);

}  // namespace corridor::app
