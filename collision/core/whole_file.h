#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <system_error>

namespace corridor {

/// Writes a regular file whole or not at all. `write` (or the text) fills a temporary file in the
/// same folder; then the temporary file replaces the file, and keeps its mode. A symbolic link
/// stays one: the file to which it leads is written. On failure no temporary file is left, and an
/// existing file stays as it is. Meanwhile SIGQUIT and `kUserSignals` are blocked in the calling
/// thread. Only a device, a pipe, or the file to which the standard output or the errors go is
/// written to directly, without these guarantees.
/// @throws InputError with the system's reason if the file can't be written.
void writeWhole(const std::filesystem::path& file, const std::function<void(std::ostream&)>& write);
void writeWhole(const std::filesystem::path& file, const std::string& text);

/// Does the same, but returns the system's error instead of throwing. @returns no error: the file
/// is written.
std::error_code tryWriteWhole(const std::filesystem::path& file,
                              const std::function<void(std::ostream&)>& write);

}  // namespace corridor
