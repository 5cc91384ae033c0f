#pragma once

#include <string>

#include <CLI/CLI.hpp>

/// Faults of the command line itself.
namespace corridor::app {

/// Lets every option of every command refuse an empty name or value. They come from unset shell
/// variables, and a later message could not name them.
void refuseEmptyValues(CLI::App& program);

/// Returns what is wrong with the command line, in one line, and which help to read.
/// @param firstWord of the command line, or "".
std::string usageFault(const CLI::App& program, const CLI::ParseError& error,
                       const std::string& firstWord);

}  // namespace corridor::app
