#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace SQLite {
class Database;
}

/// Functions that the writer and the merger of campaign databases share. They report faults of
/// SQLite files to users.
namespace corridor {

/// "corr" marks Corridor's files (PRAGMA application_id). The version is the version of Corridor's
/// tables (PRAGMA user_version). Files of version 2 become version 3 when a session opens them
/// (campaign_database.cpp); their runs stay as they are.
constexpr int kCampaignApplication = 0x636f7272, kCampaignVersion = 3, kFirstCampaignVersion = 2;

[[noreturn]] void refuseFile(const std::filesystem::path& file, const std::string& why);

/// Does a step, and turns exceptions of SQLite and exceptions on damaged JSON in the file into
/// InputError, because users can remove the causes, such as a full disk or a file of another
/// program.
/// @param kept what the message says about the stored data if the file can't be written.
void withFileInErrors(const std::filesystem::path& file, const std::function<void()>& step,
                      const std::string& kept = "finished runs are kept; continue with --resume");

/// Removes a database, and the files that SQLite keeps beside it. Files that don't exist are no
/// error.
void removeDatabase(const std::filesystem::path& file);
/// Renames a closed database to `to`. First removes an existing file of the name `to` and the log
/// of that file, because SQLite would apply this log to the renamed database. @throws InputError if
/// a file can't be removed or renamed.
void renameDatabase(const std::filesystem::path& from, const std::filesystem::path& to);

/// Tests that an open file is an undamaged campaign database. @returns the version of its tables.
/// @throws InputError
int requireCampaignFile(SQLite::Database& base, const std::filesystem::path& file);

}  // namespace corridor
