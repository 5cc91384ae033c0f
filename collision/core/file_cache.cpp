#include "collision/core/file_cache.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

#include "collision/core/error.h"
#include "collision/core/whole_file.h"

namespace corridor {
namespace {

using Clock = std::filesystem::file_time_type::clock;

constexpr const char* kExtension = ".cache";

std::string reason(int error) {
  return std::generic_category().message(error);
}

/// Returns why a folder must not be used, or "". A folder that does not exist may be used.
std::string whyNotOwn(const std::filesystem::path& folder) {
  struct stat status {};
  if (::stat(folder.c_str(), &status) != 0) return errno == ENOENT ? "" : reason(errno);
  if (!S_ISDIR(status.st_mode)) return "it is not a folder";
  if (status.st_uid != ::geteuid()) return "it belongs to another user";
  if (status.st_mode & (S_IWGRP | S_IWOTH)) return "other users may write to it";
  return "";
}

/// Sets the time of a file to now, if it is more than a day old. So the files that were not used
/// for longest are known, without a write for each use.
void touch(const std::filesystem::path& file) {
  std::error_code none;
  const auto time = std::filesystem::last_write_time(file, none);
  if (!none && Clock::now() - time > std::chrono::hours(24))
    std::filesystem::last_write_time(file, Clock::now(), none);
}

struct CachedFile {
  Clock::time_point time;  // of its last use
  std::uint64_t bytes;
  std::filesystem::path file;
};

/// Returns the files of a cache, in any order. Removes drafts of programs that were killed.
std::vector<CachedFile> filesIn(const std::filesystem::path& folder) {
  std::vector<CachedFile> files;
  std::error_code error;
  std::filesystem::directory_iterator each(folder, error);
  for (; !error && each != std::filesystem::directory_iterator(); each.increment(error)) {
    std::error_code gone;  // another program may have removed it
    if (!each->is_regular_file(gone)) continue;
    const std::uint64_t bytes = each->file_size(gone);
    const auto time = each->last_write_time(gone);
    const auto extension = each->path().extension();
    if (gone) continue;
    // `writeWhole` renames its drafts within seconds.
    if (extension == ".tmp" && Clock::now() - time > std::chrono::hours(1))
      std::filesystem::remove(each->path(), gone);
    if (extension == kExtension) files.push_back({time, bytes, each->path()});
  }
  return files;
}

std::uint64_t sumOf(const std::vector<CachedFile>& files) {
  std::uint64_t sum = 0;
  for (const CachedFile& file : files) sum += file.bytes;
  return sum;
}

/// Removes the files that were not used for longest, until the others have at most `most` bytes.
void removeOldest(const std::filesystem::path& folder, std::uint64_t most) {
  std::vector<CachedFile> files = filesIn(folder);
  std::uint64_t total = sumOf(files);
  if (total <= most) return;
  std::sort(files.begin(), files.end(),
            [](const CachedFile& a, const CachedFile& b) { return a.time < b.time; });
  for (const CachedFile& oldest : files) {
    if (total <= most) break;
    std::error_code none;
    std::filesystem::remove(oldest.file, none);
    total -= oldest.bytes;
  }
}

}  // namespace

FileCache::FileCache(std::filesystem::path folder, Use use, std::uint64_t mostBytes)
    : folder_(std::move(folder)),
      mostBytes_(mostBytes),
      build_(buildId()),
      keeps_(use == Use::readAndWrite) {
  const std::string why =
      build_.empty() ? "this program was linked without a build id" : whyNotOwn(folder_);
  if (why.empty()) return;
  build_ = {};
  complain(why);
}

Digest FileCache::key(std::string_view kind, std::span<const Bytes> inputs) const {
  Digester digester;
  digester.add(build_).add(bytesOf(kind));
  for (const Bytes input : inputs) digester.add(input);
  return digester.result();
}

std::filesystem::path FileCache::fileOf(const Digest& key) const {
  std::array<char, 33> name{};
  std::snprintf(name.data(), name.size(), "%016llx%016llx",
                static_cast<unsigned long long>(key.high),
                static_cast<unsigned long long>(key.low));
  return folder_ / (name.data() + std::string(kExtension));
}

bool FileCache::find(const Digest& key, const std::function<void(CacheFileReader&)>& take) const {
  if (build_.empty()) return false;
  const std::filesystem::path file = fileOf(key);
  CacheFileReader reader(file, key);
  if (reader.exists()) take(reader);
  const bool found = reader.isWhole();
  if (found) touch(file);
  const std::lock_guard lock(mutex_);
  ++(found ? counts_.found : reader.exists() ? counts_.damaged : counts_.missed);
  if (!found && reader.exists()) complaint_ = file.string() + " is damaged, and is not used";
  return found;
}

void FileCache::offer(const Digest& key, Put put) {
  if (build_.empty() || !keeps_) return;
  const std::lock_guard lock(mutex_);
  offered_.emplace_back(key, std::move(put));
}

void FileCache::save() {
  std::vector<std::pair<Digest, Put>> offered;
  {
    const std::lock_guard lock(mutex_);
    offered.swap(offered_);
  }
  if (offered.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder_.parent_path(), error);
  if (!error && ::mkdir(folder_.c_str(), S_IRWXU) != 0 && errno != EEXIST)
    error = {errno, std::generic_category()};
  if (error) return complain(error.message());
  for (const auto& [key, put] : offered) {
    CacheFileWriter writer;
    put(writer);
    const std::filesystem::path file = fileOf(key);
    // `writeWhole` would write into a pipe or a device that has this name.
    if (!std::filesystem::is_regular_file(file, error)) std::filesystem::remove(file, error);
    try {
      writeWhole(file, writer.bytes(key));
    } catch (const InputError& failure) {
      return complain(failure.faults().front().text);
    }
    const std::lock_guard lock(mutex_);
    ++counts_.written;
  }
  removeOldest(folder_, mostBytes_);
}

std::uint64_t FileCache::clear() {
  std::uint64_t removed = 0;
  for (const CachedFile& each : filesIn(folder_)) {
    std::error_code error;
    if (std::filesystem::remove(each.file, error)) ++removed;
    if (error) complain(error.message());
  }
  return removed;
}

FileCache::Size FileCache::size() const {
  const std::vector<CachedFile> files = filesIn(folder_);
  return {files.size(), sumOf(files)};
}

void FileCache::complain(const std::string& why) const {
  const std::lock_guard lock(mutex_);
  complaint_ = "the cache in " + folder_.string() + " is not used: " + why;
}

std::string FileCache::complaint() const {
  const std::lock_guard lock(mutex_);
  return complaint_;
}

FileCache::Counts FileCache::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

}  // namespace corridor
