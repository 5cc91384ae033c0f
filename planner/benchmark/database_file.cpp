#include "planner/benchmark/database_file.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "collision/core/error.h"

namespace corridor {
namespace {

/// Returns a text on the limit of file sizes (`ulimit -f`), or "" if there is no limit. SQLite has
/// the same error code for this limit and for a failing disk.
std::string sizeLimit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return "";
  return " (no file may be larger than " + std::to_string(limit.rlim_cur) + " bytes: ulimit -f)";
}

}  // namespace

void refuseFile(const std::filesystem::path& file, const std::string& why) {
  throw InputError(Fault{file.string(), 0, why});
}

void withFileInErrors(const std::filesystem::path& file, const std::function<void()>& step,
                      const std::string& kept) {
  try {
    step();
  } catch (const nlohmann::json::exception& error) {  // the stored JSON is damaged
    refuseFile(file, "is damaged: " + std::string(error.what()));
  } catch (const SQLite::Exception& error) {
    switch (error.getErrorCode()) {
      case SQLITE_NOTADB:
        refuseFile(file, "is not a campaign database");
      case SQLITE_BUSY:
      case SQLITE_LOCKED:
        refuseFile(file, "is in use by another process");
      case SQLITE_CANTOPEN:
        refuseFile(file, "can't be created or opened");
      case SQLITE_READONLY:
        refuseFile(file, "can't be written to");
      case SQLITE_FULL:
        refuseFile(file, "can't be written: the disk is full; " + kept);
      case SQLITE_IOERR:
        refuseFile(file, "can't be read or written: " + std::string(error.what()) + sizeLimit() +
                             "; " + kept);
      case SQLITE_CORRUPT:
        refuseFile(file, "is damaged: " + std::string(error.what()));
      default:
        refuseFile(file, "can't be read or written: " + std::string(error.what()));
    }
  }
}

void removeDatabase(const std::filesystem::path& file) {
  std::error_code ignored;
  for (const char* end : {"", "-journal", "-wal"})
    std::filesystem::remove(file.string() + end, ignored);
}

void renameDatabase(const std::filesystem::path& from, const std::filesystem::path& to) {
  removeDatabase(to);
  std::error_code failure;
  std::filesystem::rename(from, to, failure);
  if (failure) refuseFile(to, "can't be written: " + failure.message());
}

int requireCampaignFile(SQLite::Database& base, const std::filesystem::path& file) {
  if (base.execAndGet("PRAGMA application_id").getInt() != kCampaignApplication)
    refuseFile(file, "is a database, but not of a campaign");
  const int version = base.execAndGet("PRAGMA user_version").getInt();
  if (version < kFirstCampaignVersion || version > kCampaignVersion)
    refuseFile(file, "is a campaign database of version " + std::to_string(version) +
                         "; this program needs version " + std::to_string(kCampaignVersion) +
                         "; name another folder");
  if (const std::string check = base.execAndGet("PRAGMA quick_check(1)").getString(); check != "ok")
    refuseFile(file, "is damaged: " + check);
  return version;
}

}  // namespace corridor
