#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

/// Functions that read input files. No other code reads input files, except the helper program that
/// uses assimp, and `isSolutionFile`, which reads the first bytes of a file that is there. The
/// functions open only ordinary files, never wait for a device or a pipe, and test the size of a
/// file before they allocate memory for its contents. The exception is `readTextStream`, which also
/// reads pipes. It is used only for inputs that are documented to accept a pipe.
namespace corridor {

/// The maximum number of bytes of any input: 4 GiB.
constexpr std::uint64_t kMostFileBytes = std::uint64_t{1} << 32;
/// The maximum number of bytes of a document that is parsed as a whole (YAML, JSON, XML, .cfg): 256
/// MiB. For comparison, a solution file of a million states of seven numbers has 150 MB.
constexpr std::uint64_t kMostDocumentBytes = std::uint64_t{1} << 28;

/// Returns why a path is not an ordinary file ("no such file", …), or "" if it is an ordinary file.
/// Does not open the file.
std::string whyNotOrdinaryFile(const std::filesystem::path& file);

/// Checks that `file` is a readable, non-empty, ordinary file of at most `most` bytes.
/// @param what  the kind of input for messages: "a mesh file".
/// @throws InputError: no such file, not an ordinary file, unreadable, empty, too large, or a
/// pointer of Git LFS in place of the file.
void requireFile(const std::filesystem::path& file, const std::string& what,
                 std::uint64_t most = kMostFileBytes);

/// Returns the bytes of a file. @throws InputError in the cases of `requireFile`.
std::string readFile(const std::filesystem::path& file, const std::string& what,
                     std::uint64_t most = kMostFileBytes);

/// @throws InputError if a file begins like a web page, an archive, an image or another format that
/// is not read here. @param what  for messages: "a mesh file".
void requireOwnFormat(std::string_view bytes, const std::filesystem::path& file,
                      const std::string& what);

/// Returns the text with LF in place of each CR that no LF follows. Such a CR ends a line, but most
/// readers of lines and of comments end them at LF only, and would lose the next line.
std::string withLineFeeds(std::string text);

/// Returns the text of a document, `withLineFeeds`. @param what  for messages: "a problem".
/// @throws InputError in the cases of `requireFile` and `requireOwnFormat`; also if the file has
/// more than 256 MiB (`kMostDocumentBytes`), consists of blanks only, or contains a byte 0, which
/// no text has.
std::string readTextFile(const std::filesystem::path& file, const std::string& what);

/// Returns the text of a list that may be long or come from a pipe, `withLineFeeds`; "-" and
/// "/dev/stdin" are the standard input. Reads a pipe to its end, and waits for its writer.
/// @throws InputError for an ordinary file: as `requireFile` and `requireOwnFormat`. For every
/// input: if the text has more than 4 GiB (`kMostFileBytes`), consists of blanks only, or contains
/// a byte 0. After a byte 0, a pipe is not read further.
std::string readTextStream(const std::filesystem::path& file, const std::string& what);

}  // namespace corridor
