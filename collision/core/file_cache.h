#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "collision/core/cache_file.h"
#include "collision/core/digest.h"

namespace corridor {

/// Results that take long to compute, kept in files for later programs: meshes as they were read,
/// trees, hulls. Each file has one result. Its name is a digest of everything that the result
/// depends on: all inputs, and the code that computed it. So a result is never out of date. Results
/// of older code are not looked up any more, and are removed when space is needed.
///
/// A file is used only if its checksum holds for all its bytes. A damaged file counts as none, and
/// is removed. A file appears in its folder as a whole, so many programs may use the folder at the
/// same time. A checksum is no protection against files that somebody makes on purpose. So the
/// folder must belong to the user, and no other user may have the right to write to it. Files that
/// have other names than a cache gives stay as they are.
///
/// Thread safety: all functions but `save` may be called from several threads at once.
class FileCache {
 public:
  /// A folder that does not exist is made by `save`. If the folder can't be used, the cache finds
  /// and keeps nothing, and `whyUnusable` says why.
  /// @param code identifies the code that computes the results, and how it was compiled.
  /// @param mostBytes `save` removes the files that were not used for longest, until all files of
  /// the cache together have at most this length.
  FileCache(std::filesystem::path folder, std::string code,
            std::uint64_t mostBytes = 1'000'000'000);

  /// Returns the key of a result, except for the code, which is added here.
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
  /// be written is dropped, with a note. So is, without one, a result of more than half of the
  /// cache's limit, since it would push out many others.
  void save();

  /// Removes all files of the cache. Returns their number. There is a note for those that can't be
  /// removed.
  std::uint64_t clear();

  const std::filesystem::path& folder() const { return folder_; }
  std::uint64_t mostBytes() const { return mostBytes_; }
  struct Size {
    std::uint64_t files = 0, bytes = 0;
  };
  Size size() const;

  /// Returns why the folder can't be used, with its name, or "".
  const std::string& whyUnusable() const { return whyUnusable_; }
  /// Returns what users should know since the last call, each in a sentence: that the cache can't
  /// be used, that files were damaged, could not be written, or could not be removed.
  std::vector<std::string> takeNotes();

  struct Counts {
    std::uint64_t found = 0, missed = 0, damaged = 0, written = 0, failed = 0;
  };
  Counts counts() const;

 private:
  /// What happened since the last `takeNotes`: how often, and the file of the first time.
  struct Events {
    std::uint64_t count = 0;
    std::string first;
    void add(const std::string& text) {
      if (++count == 1) first = text;
    }
  };
  std::filesystem::path fileOf(const Digest& key) const;
  void noteUnread(const std::error_code& error) const;
  /// Writes a result. @returns nothing if it is too large to be kept.
  std::optional<std::error_code> write(const std::filesystem::path& file, const Digest& key,
                                       const Put& put) const;

  std::filesystem::path folder_;
  std::string code_;
  std::uint64_t mostBytes_;
  std::string whyUnusable_;
  mutable std::mutex mutex_;  // guards all that follows
  std::vector<std::pair<Digest, Put>> offered_;
  mutable Counts counts_;
  mutable Events damaged_, unwritten_, unremoved_;
  mutable std::string whyUnread_;  // the list of its files, or ""
  bool saidUnusable_ = false;
};

}  // namespace corridor
