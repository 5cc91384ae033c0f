#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>

namespace corridor {

/// Writes a file whole or not at all: `write` (or the text) goes into a file of another name beside
/// it, which then takes its place. Where that fails nothing is left, and a file that was there
/// stays as it is. SIGINT, SIGTERM, SIGHUP and SIGQUIT wait for the end meanwhile. A device or a
/// pipe is written to directly.
/// @throws InputError with the system's reason where it can't be written.
void writeWhole(const std::filesystem::path& file, const std::function<void(std::ostream&)>& write);
void writeWhole(const std::filesystem::path& file, const std::string& text);

}  // namespace corridor
