#include "collision/geometry/mesh_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <system_error>

#include "collision/core/decimal_number.h"
namespace corridor {

std::string printable(std::string_view word) {
  constexpr std::size_t longest = 32;
  std::string text;
  for (const char c : word.substr(0, longest)) text += c >= ' ' && c <= '~' ? c : '?';
  return word.size() > longest ? text + "..." : text;
}

std::string inQuotes(std::string_view word) {
  return '"' + printable(word) + '"';
}

void addNote(std::vector<std::string>& notes, const std::string& text) {
  constexpr std::size_t most = 100;
  if (notes.size() > most || std::ranges::count(notes, text) > 0) return;
  notes.push_back(notes.size() < most ? text : "more is not read than these notes say");
}

void MeshFaults::fail(int line, std::string text) {
  add(line, std::move(text));
  faults_.throwIfAny();
  std::abort();  // not reached: there is a fault
}

void MeshFaults::failCount(std::uint64_t count, std::string_view what, int line) {
  fail(line, "has " + std::to_string(count) + " " + std::string(what) + " or more; at most " +
                 std::to_string(kMaxMeshElements) + " are read: use a coarser mesh, or split it");
}

std::optional<std::string> parseCoordinate(std::string_view word, double& value,
                                           bool notFiniteToo) {
  const auto complaint = [&](const char* text) { return "coordinate " + inQuotes(word) + text; };
  const auto number = decimalNumber(word);
  if (!number) return complaint(" is not a number; write decimal numbers such as -1.25e-3");
  value = *number;
  if (std::isinf(value) && word.find_first_of("0123456789") != word.npos)
    return complaint(" is too large for a double");
  if (!notFiniteToo && !std::isfinite(value)) return complaint(" is not finite");
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
  while (stop != end && (*stop > ' ' || (!isBlank(*stop) && !isLineEnd(*stop)))) ++stop;
  rest_ = {stop, static_cast<std::size_t>(end - stop)};
  return {start, static_cast<std::size_t>(stop - start)};
}

std::string_view TextCursor::word() {
  std::string_view word = wordInLine();
  while (word.empty() && nextLine()) word = wordInLine();
  return word;
}

const char* TextCursor::lineEnd() {
  const char* const start = rest_.data();
  const char* const end = start + rest_.size();
  const auto seek = [&](const char*& found, char c) {
    if (found && found >= start) return;
    const void* const at = rest_.empty() ? nullptr : std::memchr(start, c, rest_.size());
    found = at ? static_cast<const char*>(at) : end;
  };
  seek(lf_, '\n');
  seek(cr_, '\r');
  return std::min(lf_, cr_);
}

std::string_view TextCursor::takeRestOfLine() {
  const auto size = static_cast<std::size_t>(lineEnd() - rest_.data());
  const std::string_view rest = rest_.substr(0, size);
  rest_.remove_prefix(size);
  return rest;
}

std::string_view TextCursor::takeLineFrom(std::string_view word) {
  const std::string_view rest = takeRestOfLine();
  return {word.data(), static_cast<std::size_t>(rest.data() + rest.size() - word.data())};
}

bool TextCursor::nextLine() {
  const auto stop = static_cast<std::size_t>(lineEnd() - rest_.data());
  if (stop == rest_.size()) {
    rest_.remove_prefix(stop);
    return false;
  }
  const bool isPair = rest_.substr(stop).starts_with("\r\n");
  if (ends_ == LineEnds::unknown)
    ends_ = rest_[stop] == '\n' || isPair ? LineEnds::lfOrCrLf : LineEnds::cr;
  rest_.remove_prefix(stop + (isPair && ends_ != LineEnds::cr ? 2 : 1));
  if (line_ < std::numeric_limits<int>::max()) ++line_;
  return true;
}

}  // namespace corridor
