#include "collision/core/fault_list.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <system_error>

namespace corridor {

void FaultList::add(std::string file, int line, std::string text) {
  faults_.push_back({std::move(file), line, std::move(text)});
}

void FaultList::add(const InputError& error) {
  faults_.insert(faults_.end(), error.faults().begin(), error.faults().end());
}

void FaultList::throwIfAny() const {
  if (faults_.empty()) return;
  std::vector<std::string> files{mainFile_};
  for (const Fault& fault : faults_)
    if (std::find(files.begin(), files.end(), fault.file) == files.end())
      files.push_back(fault.file);
  const auto rank = [&](const Fault& fault) {
    return std::find(files.begin(), files.end(), fault.file) - files.begin();
  };
  std::vector<Fault> sorted = faults_;
  std::stable_sort(sorted.begin(), sorted.end(), [&](const Fault& a, const Fault& b) {
    return rank(a) != rank(b) ? rank(a) < rank(b) : a.line < b.line;
  });
  throw InputError(std::move(sorted));
}

std::string whyNoFile(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) return "no such file";
  if (std::filesystem::is_directory(status)) return "is a folder; a file is needed";
  if (!std::filesystem::is_regular_file(status)) return "is not an ordinary file";
  return "";
}

namespace {

/// @throws InputError
std::ifstream opened(const std::filesystem::path& file, const std::string& name) {
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    throw InputError(Fault{name, 0, std::string("cannot be read: ") + std::strerror(errno)});
  return stream;
}

/// @returns the text. @throws InputError
std::string notEmpty(std::string text, const std::string& name, const std::string& what) {
  if (text.find_first_not_of(" \t\r\n") == text.npos)
    throw InputError(Fault{name, 0, "is empty; " + what + " is needed"});
  return text;
}

}  // namespace

std::string readTextFile(const std::filesystem::path& file, const std::string& what) {
  if (const std::string why = whyNoFile(file); !why.empty())
    throw InputError(Fault{file.string(), 0, why});
  std::ifstream stream = opened(file, file.string());
  std::string text(std::filesystem::file_size(file), '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return notEmpty(std::move(text), file.string(), what);
}

std::string readTextStream(const std::filesystem::path& file, const std::string& what) {
  if (file == "-" || file == "/dev/stdin")
    return notEmpty({std::istreambuf_iterator<char>(std::cin), {}}, file.string(), what);
  std::error_code none;
  if (!std::filesystem::is_fifo(file, none)) return readTextFile(file, what);
  std::ifstream stream = opened(file, file.string());
  return notEmpty({std::istreambuf_iterator<char>(stream), {}}, file.string(), what);
}

}  // namespace corridor
