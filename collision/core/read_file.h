#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

/// The one door through which input files are read. It opens ordinary files only, looks at their
/// size before memory is taken for them, and never waits for a device or a pipe, unless the input
/// is documented to take one (`readTextStream`).
namespace corridor {

/// 4 GiB: of any one input.
constexpr std::uint64_t kMostFileBytes = std::uint64_t{1} << 32;
/// 256 MiB: of a document that is parsed as a whole (YAML, JSON, XML, .cfg). A solution file of a
/// million states of seven numbers has 150 MB.
constexpr std::uint64_t kMostDocumentBytes = std::uint64_t{1} << 28;

/// What keeps a path from being an ordinary file ("no such file …"), or "". Opens nothing.
std::string whyNoFile(const std::filesystem::path& file);

/// @param what "a mesh file", for messages. @param most bytes that it may have.
/// @throws InputError: no such file, not an ordinary one, unreadable, empty, or larger.
void requireFile(const std::filesystem::path& file, const std::string& what,
                 std::uint64_t most = kMostFileBytes);

/// The bytes of a file. @throws InputError: as `requireFile`.
std::string readFile(const std::filesystem::path& file, const std::string& what,
                     std::uint64_t most = kMostFileBytes);

/// The text of a document. @param what "a problem", for messages.
/// @throws InputError: as `requireFile`; also above 256 MiB, only blanks, or not text (a byte 0).
std::string readTextFile(const std::filesystem::path& file, const std::string& what);

/// The text of a list that may be long or come from a pipe; "-" and "/dev/stdin" are the standard
/// input. Waits for the other end of a pipe, as programs do.
/// @throws InputError: as `requireFile`; also only blanks, or not text (a byte 0, noticed at once).
std::string readTextStream(const std::filesystem::path& file, const std::string& what);

}  // namespace corridor
