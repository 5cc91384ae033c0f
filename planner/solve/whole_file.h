#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>

namespace corridor {

/// Writes a file whole or not at all. `write` (or the text) fills a temporary file in the same
/// folder, which then replaces the file. On failure no temporary file is left, and an existing file
/// stays as it is. Meanwhile SIGQUIT and `kUserSignals` are blocked in the calling thread.
/// A device or a pipe is written to directly.
/// @throws InputError with the system's reason if it can't be written.
void writeWhole(const std::filesystem::path& file, const std::function<void(std::ostream&)>& write);
void writeWhole(const std::filesystem::path& file, const std::string& text);

}  // namespace corridor
