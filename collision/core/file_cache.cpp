#include "collision/core/file_cache.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <fcntl.h>
#include <new>
#include <ostream>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

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
  if (::stat(folder.c_str(), &status) != 0) {
    if (errno != ENOENT) return reason(errno);
    std::error_code none;
    return std::filesystem::is_symlink(folder, none) ? "it is a link to nothing" : "";
  }
  if (!S_ISDIR(status.st_mode)) return "it is not a folder";
  if (status.st_uid != ::geteuid()) return "it belongs to another user";
  if (status.st_mode & (S_IWGRP | S_IWOTH))
    return "other users may write to it (chmod go-w changes that)";
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

std::string quotedName(const std::filesystem::path& file) {
  return '"' + file.filename().string() + '"';
}

/// Returns whether a name is one that a cache gives: of 32 hexadecimal digits.
bool isNameOfKey(const std::filesystem::path& name) {
  const std::string digits = name.stem().string();
  return name.extension() == kExtension && digits.size() == 32 &&
         digits.find_first_not_of("0123456789abcdef") == digits.npos;
}

/// Returns the files of a cache, in any order. Removes drafts of `tryWriteWhole` that are older
/// than `age`: those of programs that were killed.
/// @param error set if the folder can't be read.
std::vector<CachedFile> filesIn(const std::filesystem::path& folder, std::error_code& error,
                                std::chrono::seconds age = std::chrono::hours(1)) {
  std::vector<CachedFile> files;
  error.clear();
  std::filesystem::directory_iterator each(folder, error);
  for (; !error && each != std::filesystem::directory_iterator(); each.increment(error)) {
    std::error_code gone;  // another program may have removed it
    if (!each->is_regular_file(gone)) continue;
    const std::filesystem::path name = each->path().filename();
    const bool isDraft = name.extension() == ".tmp" && name.string().starts_with(".corridor");
    if (!isDraft && !isNameOfKey(name)) continue;
    const std::uint64_t bytes = each->file_size(gone);
    const auto time = each->last_write_time(gone);
    if (gone) continue;
    if (!isDraft)
      files.push_back({time, bytes, each->path()});
    else if (Clock::now() - time > age)
      std::filesystem::remove(each->path(), gone);
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
  std::error_code none;
  std::vector<CachedFile> files = filesIn(folder, none);
  std::uint64_t total = sumOf(files);
  if (total <= most) return;
  std::sort(files.begin(), files.end(),
            [](const CachedFile& a, const CachedFile& b) { return a.time < b.time; });
  for (const CachedFile& oldest : files) {
    if (total <= most) break;
    std::filesystem::remove(oldest.file, none);
    total -= oldest.bytes;
  }
}

}  // namespace

FileCache::FileCache(std::filesystem::path folder, std::string code, std::uint64_t mostBytes)
    : folder_(std::move(folder)), code_(std::move(code)), mostBytes_(mostBytes) {
  if (const std::string why = whyNotOwn(folder_); !why.empty())
    whyUnusable_ = "the cache in " + folder_.string() + " is not used: " + why;
}

Digest FileCache::key(std::string_view kind, std::span<const Bytes> inputs) const {
  Digester digester;
  digester.add(bytesOf(code_)).add(bytesOf(kind));
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
  if (!whyUnusable_.empty()) return false;
  const std::filesystem::path file = fileOf(key);
  CacheFileReader reader(file, key);
  if (reader.exists()) take(reader);
  const bool found = reader.isWhole(), damaged = !found && reader.exists();
  std::error_code failure;
  if (found) touch(file);
  // If another program has just replaced it, that file is lost: it is computed once more.
  if (damaged) std::filesystem::remove(file, failure);
  const std::lock_guard lock(mutex_);
  ++(found ? counts_.found : damaged ? counts_.damaged : counts_.missed);
  if (damaged) damaged_.add(quotedName(file));
  if (failure) unremoved_.add(quotedName(file) + ": " + failure.message());
  return found;
}

void FileCache::offer(const Digest& key, Put put) {
  if (!whyUnusable_.empty()) return;
  const std::lock_guard lock(mutex_);
  offered_.emplace_back(key, std::move(put));
}

std::optional<std::error_code> FileCache::write(const std::filesystem::path& file,
                                                const Digest& key, const Put& put) const {
  try {
    CacheFileWriter writer;
    put(writer);
    if (writer.size() > mostBytes_ / 2) return std::nullopt;
    std::error_code none;
    // What is no file is removed first: writing into a pipe would wait for a reader.
    if (!std::filesystem::is_regular_file(file, none)) std::filesystem::remove(file, none);
    return tryWriteWhole(file, [bytes = writer.bytes(key)](std::ostream& out) { out << bytes; });
  } catch (const std::bad_alloc&) {
    return std::make_error_code(std::errc::not_enough_memory);
  }
}

void FileCache::save() {
  std::vector<std::pair<Digest, Put>> offered;
  {
    const std::lock_guard lock(mutex_);
    offered.swap(offered_);
  }
  if (offered.empty()) return;
  std::error_code noFolder;
  std::filesystem::create_directories(folder_.parent_path(), noFolder);
  if (!noFolder && ::mkdir(folder_.c_str(), S_IRWXU) != 0 && errno != EEXIST)
    noFolder = {errno, std::generic_category()};
  // Somebody else may have made the folder since the constructor looked.
  const std::string whyNone =
      noFolder ? "the folder can't be made: " + noFolder.message() : whyNotOwn(folder_);
  for (const auto& [key, put] : offered) {
    const std::filesystem::path file = fileOf(key);
    const auto failure = whyNone.empty() ? write(file, key, put) : std::error_code();
    const bool failed = !whyNone.empty() || (failure && *failure);
    const std::lock_guard lock(mutex_);
    if (failure) ++(failed ? counts_.failed : counts_.written);
    if (failed)
      unwritten_.add(whyNone.empty() ? quotedName(file) + ": " + failure->message() : whyNone);
  }
  removeOldest(folder_, mostBytes_);
}

std::uint64_t FileCache::clear() {
  std::uint64_t removed = 0;
  std::error_code error;
  for (const CachedFile& each : filesIn(folder_, error, std::chrono::seconds(0))) {
    std::error_code failure;
    removed += std::filesystem::remove(each.file, failure);
    const std::lock_guard lock(mutex_);
    if (failure) unremoved_.add(quotedName(each.file) + ": " + failure.message());
  }
  noteUnread(error);
  return removed;
}

FileCache::Size FileCache::size() const {
  std::error_code error;
  const std::vector<CachedFile> files = filesIn(folder_, error);
  noteUnread(error);
  return {files.size(), sumOf(files)};
}

void FileCache::noteUnread(const std::error_code& error) const {
  const std::lock_guard lock(mutex_);
  if (error && error != std::errc::no_such_file_or_directory) whyUnread_ = error.message();
}

std::vector<std::string> FileCache::takeNotes() {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> notes;
  if (!whyUnusable_.empty() && !std::exchange(saidUnusable_, true)) notes.push_back(whyUnusable_);
  const auto note = [&](Events& events, const char* what) {
    if (events.count > 0)
      notes.push_back("in the cache " + folder_.string() + ", " + std::to_string(events.count) +
                      (events.count == 1 ? " file " : " files ") + what +
                      (events.count == 1 ? " (" : " (the first: ") + events.first + ")");
    events = {};
  };
  if (!whyUnread_.empty())
    notes.push_back("the cache in " + folder_.string() +
                    " can't be read: " + std::exchange(whyUnread_, ""));
  note(damaged_, "had damaged contents, which are not used");
  note(unremoved_, "could not be removed");
  note(unwritten_, "could not be written");
  return notes;
}

FileCache::Counts FileCache::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

}  // namespace corridor
