#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "collision/core/cache_file.h"
#include "collision/core/digest.h"

namespace corridor {

/// Results that take long to compute, kept in files for later programs: meshes as they were read,
/// trees, hulls. Each file has one result. Its name is a digest of everything that the result
/// depends on: all inputs, and the build of the program that computed it. So a result is never out
/// of date; only nobody asks for it any more.
///
/// A file is used only if its checksum holds for all its bytes. A damaged file counts as none. A
/// file appears in its folder as a whole, so many programs may use the folder at the same time.
/// A checksum is no protection against files that somebody makes on purpose. So the folder must
/// belong to the user, and nobody else may have the right to write to it.
///
/// Thread safety: all functions but `save` may be called from several threads at once.
class FileCache {
 public:
  /// Whether results are kept that are offered. If not, no `save` is needed.
  enum class Use { readAndWrite, readOnly };

  /// If the folder is not the user's alone, or the program has no build id, the cache finds and
  /// keeps nothing, and `complaint` says why. A folder that does not exist is made by `save`.
  /// @param mostBytes `save` removes the files that were not used for longest, until all files of
  /// the cache together have at most this length.
  explicit FileCache(std::filesystem::path folder, Use use = Use::readAndWrite,
                     std::uint64_t mostBytes = std::uint64_t{1} << 30);

  /// Returns the key of a result, except for the build, which is added here.
  /// @param kind names the function that computes the result. @param inputs all that it depends on
  Digest key(std::string_view kind, std::span<const Bytes> inputs) const;

  /// Calls take(reader) if there is a file with this key. Returns whether `take` took all pieces,
  /// and they are what was written. Otherwise nothing may be used of what was taken.
  bool find(const Digest& key, const std::function<void(CacheFileReader&)>& take) const;

  using Put = std::function<void(CacheFileWriter&)>;
  /// Keeps a result until it is saved. @param put puts the pieces of the result. `save` calls it,
  /// so it must own what it needs.
  void offer(const Digest& key, Put put);
  /// Writes what was offered since the last call. A program does this after its answer. What can't
  /// be written is dropped, and `complaint` says why.
  void save();

  /// Removes all files of the cache. Returns their number.
  std::uint64_t clear();

  const std::filesystem::path& folder() const { return folder_; }
  std::uint64_t mostBytes() const { return mostBytes_; }
  struct Size {
    std::uint64_t files = 0, bytes = 0;
  };
  Size size() const;
  /// Returns why the cache, or a file of it, can't be used, or "". The text names it.
  std::string complaint() const;

  struct Counts {
    std::uint64_t found = 0, missed = 0, damaged = 0, written = 0;
  };
  Counts counts() const;

 private:
  std::filesystem::path fileOf(const Digest& key) const;
  void complain(const std::string& why) const;

  std::filesystem::path folder_;
  std::uint64_t mostBytes_;
  Bytes build_;  // empty: the cache is not used
  bool keeps_;
  mutable std::mutex mutex_;  // guards all that follows
  std::vector<std::pair<Digest, Put>> offered_;
  mutable Counts counts_;
  mutable std::string complaint_;
};

}  // namespace corridor
