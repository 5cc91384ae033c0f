#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unistd.h>

#include "collision/core/error.h"

/// The entry point of every fuzz target. libFuzzer or replay.cpp calls this function for each
/// input.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace corridor::fuzz {

/// Reports a finding: prints it and aborts, so that the fuzzer keeps the input.
[[noreturn]] inline void fail(const std::string& what) {
  std::fprintf(stderr, "FINDING: %s\n", what.c_str());
  std::abort();
}

inline std::string_view textOf(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A folder under TMPDIR for the files of one process. The folder is removed when the process ends
/// normally.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() /
              ("corridor_fuzz_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
    return file;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// An input of a target that reads several formats. Its first line is the extension of the file's
/// name.
struct NamedInput {
  std::string ending;
  std::string_view bytes;
};
/// Splits an input after its first line. Returns nullopt if that line is not an extension of 1 to
/// 12 letters and digits.
inline std::optional<NamedInput> namedInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = textOf(data, size);
  const std::size_t end = text.find('\n');
  if (end == text.npos || end == 0 || end > 12) return std::nullopt;
  for (const char c : text.substr(0, end))
    if (!(c >= '0' && c <= '9') && !(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z'))
      return std::nullopt;
  return NamedInput{std::string(text.substr(0, end)), text.substr(end + 1)};
}

/// Reports a finding if a fault has an empty text, a negative line number, or a control character
/// (such as a line break) in its text.
inline void checkFaults(const std::vector<Fault>& faults) {
  for (const Fault& fault : faults) {
    if (fault.text.empty()) fail("a fault without a text");
    if (fault.line < 0) fail("a fault with a negative line");
    for (const char c : fault.text)
      if (c >= 0 && c < ' ') fail("a control character in a fault: " + fault.text);
  }
}

/// Calls a reader, which may succeed, or throw InputError with at least one fault, each with a text
/// that passes `checkFaults`. Any other exception is reported as a finding. @returns whether the
/// reader succeeded.
inline bool readsOrRefuses(const std::function<void()>& read) {
  try {
    read();
    return true;
  } catch (const InputError& error) {
    if (error.faults().empty()) fail("an InputError without faults");
    checkFaults(error.faults());
  } catch (const std::exception& error) {
    fail(std::string("not an InputError: ") + error.what());
  }
  return false;
}

}  // namespace corridor::fuzz
