#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace corridor {

/// A file of text lines that only grows. While a process has it open to append, no other process
/// can open it, and while a process has it open to read, no other process can open it to append.
/// Methods throw InputError with the file's name if the system refuses the operation.
class LineFile {
 public:
  enum class Use { read, append };

  /// Opens a file. With `append`, a missing file is created.
  /// @pre this process has the file open only once, since closing it gives up all locks of it.
  LineFile(const std::filesystem::path& file, Use use);
  LineFile(const LineFile&) = delete;
  LineFile& operator=(const LineFile&) = delete;
  ~LineFile();

  const std::filesystem::path& path() const { return path_; }
  /// The number of bytes of the whole lines, as far as they were read or appended.
  std::uint64_t size() const { return size_; }

  /// Reads the file from its beginning. Calls `visit` with each whole line, without its line break,
  /// with the offset of its first byte, and with its number, from 1.
  /// @returns the text after the last line break. It is not empty if a line was not written whole.
  std::string forEachLine(
      const std::function<void(const std::string& line, std::uint64_t offset, int number)>& visit);
  /// Reads a part of the file.
  std::string at(std::uint64_t offset, std::size_t length) const;

  /// Appends whole lines, and waits until they have reached the disk. If this fails, the file has
  /// none of them, and the message ends with `kept`, which says what became of the data.
  void append(const std::string& lines, const std::string& kept);
  /// Makes the file end after `size` bytes.
  void cut(std::uint64_t size);
  /// Renames the file. An existing file of this name is replaced.
  void rename(const std::filesystem::path& to);

 private:
  [[noreturn]] void refuse(const std::string& why) const;

  std::filesystem::path path_;
  int file_;
  std::uint64_t size_ = 0;
};

/// Returns the system's reason for an error number (errno), with a hint for `ulimit -f`.
std::string reasonOf(int error);

}  // namespace corridor
