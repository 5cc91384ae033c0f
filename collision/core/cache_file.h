#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "collision/core/digest.h"

namespace corridor {

/// The pieces of a result, to be written to a file of a `FileCache`: lists, values and texts.
class CacheFileWriter {
 public:
  template <class T>
  void put(const std::vector<T>& list) {
    add(bytesOf(list));
  }
  template <class T>
  void put(const T& value) {
    add(bytesOf(value));
  }
  void put(const std::string& text) { add(bytesOf(text)); }

  /// Returns the length of all pieces, in bytes.
  std::uint64_t size() const;
  /// Returns the bytes of the file: a header, the length of each piece, and the pieces. The header
  /// has the key and a checksum of all that follows it.
  std::string bytes(const Digest& key) const;

 private:
  void add(Bytes bytes);

  std::vector<std::string> pieces_;
};

/// Reads a file that a `CacheFileWriter` wrote, piece by piece in the order in which they were put.
/// Nothing that was taken may be used before `isWhole` has returned true.
class CacheFileReader {
 public:
  /// A file that can't be opened, is no ordinary file, has another key, or another length than its
  /// header says, has no pieces.
  CacheFileReader(const std::filesystem::path& file, const Digest& key);
  CacheFileReader(const CacheFileReader&) = delete;
  CacheFileReader& operator=(const CacheFileReader&) = delete;
  ~CacheFileReader();

  /// Returns whether there is such a file, damaged or not.
  bool exists() const { return file_ >= 0; }
  /// Each function reads the next piece. If there is none, or it has the wrong length, `isWhole`
  /// will return false.
  template <class T>
  void take(std::vector<T>& list) {
    static_assert(kIsBytes<T>);
    if (size() % sizeof(T) != 0) return refuse();
    list.resize(size() / sizeof(T));
    read(std::as_writable_bytes(std::span(list)));
  }
  template <class T>
  void take(T& value) {
    static_assert(kIsBytes<T>);
    if (next_ == sizes_.size() || size() != sizeof(T)) return refuse();
    read(std::as_writable_bytes(std::span(&value, 1)));
  }
  void take(std::string& text) {
    text.resize(size());
    read(std::as_writable_bytes(std::span(text)));
  }
  /// Returns false once a piece could not be taken.
  bool isSound() const { return !refused_; }
  /// Returns whether all pieces were taken, and their bytes are those that were written.
  bool isWhole() const;

 private:
  std::uint64_t size() const { return next_ < sizes_.size() ? sizes_[next_] : 0; }
  void read(std::span<std::byte> to);
  void refuse() { refused_ = true; }

  int file_ = -1;
  bool refused_ = false;
  Digest checksum_;
  std::vector<std::uint64_t> sizes_;
  std::size_t next_ = 0;
  Digester digester_;
};

}  // namespace corridor
