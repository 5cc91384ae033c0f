#include "collision/geometry/mesh_text.h"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <locale>
#include <sstream>
#include <system_error>

namespace corridor {

void requireMeshFile(const std::filesystem::path& file) {
  const auto fail = [&](std::string text) {
    throw InputError(Fault{file.string(), 0, std::move(text)});
  };
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) fail("no such file");
  if (std::filesystem::is_directory(status)) fail("is a directory; a mesh file is needed");
  if (!std::filesystem::is_regular_file(status))
    fail("is not a regular file; a mesh file is needed");
  errno = 0;
  if (!std::ifstream(file, std::ios::binary))
    fail(std::string("cannot be read: ") + std::strerror(errno));
  if (std::filesystem::file_size(file, error) == 0) fail("is empty; a mesh file is needed");
}

std::string readWholeFile(const std::filesystem::path& file) {
  requireMeshFile(file);
  std::string bytes(std::filesystem::file_size(file), '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (static_cast<std::size_t>(stream.gcount()) != bytes.size()) {
    throw InputError(Fault{file.string(), 0,
                           "cannot be read: it ended after " + std::to_string(stream.gcount()) +
                               " of " + std::to_string(bytes.size()) + " bytes"});
  }
  return bytes;
}

std::string printable(std::string_view word) {
  constexpr std::size_t longest = 32;
  std::string text;
  for (const char c : word.substr(0, longest)) text += c >= ' ' && c <= '~' ? c : '?';
  return word.size() > longest ? text + "..." : text;
}

std::string inQuotes(std::string_view word) {
  return '"' + printable(word) + '"';
}

void MeshFaults::add(int line, std::string text) {
  constexpr std::size_t most = 10;
  faults_.push_back({file_, line, std::move(text)});
  if (faults_.size() == most) throw InputError(faults_);
}

void MeshFaults::fail(int line, std::string text) {
  faults_.push_back({file_, line, std::move(text)});
  throw InputError(faults_);
}

void MeshFaults::throwIfAny() const {
  if (!faults_.empty()) throw InputError(faults_);
}

std::optional<std::string> parseCoordinate(std::string_view word, double& value) {
  const auto complaint = [&](const char* text) { return "coordinate " + inQuotes(word) + text; };
  const char* const end = word.data() + word.size();
  const char* const begin =
      word.data() + (word.size() > 1 && word[0] == '+' && word[1] != '-' ? 1 : 0);
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error == std::errc::invalid_argument || stop != end) {
    return complaint(" is not a number; decimal numbers such as -1.25e-3 are");
  }
  if (error == std::errc::result_out_of_range) {
    // Too large or too small: streams, unlike from_chars, say which, whatever the exponent.
    std::istringstream stream(std::string(begin, end));
    stream.imbue(std::locale::classic());
    if (!(stream >> value)) return complaint(" is too large for a double");
  }
  if (!std::isfinite(value)) return complaint(" is not finite");
  return std::nullopt;
}

bool parseInteger(std::string_view word, std::int64_t& value) {
  const char* const end = word.data() + word.size();
  const char* const begin =
      word.data() + (word.size() > 1 && word[0] == '+' && word[1] != '-' ? 1 : 0);
  const auto [stop, error] = std::from_chars(begin, end, value);
  return error == std::errc() && stop == end;
}

std::string_view TextCursor::wordInLine() {
  const char* start = rest_.data();
  const char* const end = start + rest_.size();
  while (start != end && isBlank(*start)) ++start;
  const char* stop = start;
  while (stop != end && (*stop > ' ' || (!isBlank(*stop) && *stop != '\n'))) ++stop;
  rest_ = {stop, static_cast<std::size_t>(end - stop)};
  return {start, static_cast<std::size_t>(stop - start)};
}

std::string_view TextCursor::word() {
  std::string_view word = wordInLine();
  while (word.empty() && nextLine()) word = wordInLine();
  return word;
}

bool TextCursor::nextLine() {
  const void* const found = std::memchr(rest_.data(), '\n', rest_.size());
  if (!found) {
    rest_.remove_prefix(rest_.size());
    return false;
  }
  rest_.remove_prefix(static_cast<std::size_t>(static_cast<const char*>(found) - rest_.data()) + 1);
  ++line_;
  return true;
}

}  // namespace corridor
