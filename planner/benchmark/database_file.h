#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace SQLite {
class Database;
}

/// What the writer and the merger of campaign databases share: faults of SQLite files, for users.
namespace corridor {

/// "corr" marks our files (PRAGMA application_id). The version is that of our tables. Files of
/// version 2 become version 3 when a session opens them (campaign_database.cpp); their runs stay as
/// they are.
constexpr int kCampaignApplication = 0x636f7272, kCampaignVersion = 3, kFirstCampaignVersion = 2;

[[noreturn]] void refuseFile(const std::filesystem::path& file, const std::string& why);

/// Does a step, and turns the exceptions of SQLite, and those of damaged JSON in the file, into
/// InputError. Users can mend the causes, such as a full disk or a file of another program.
/// @param kept what remains if the file can't be written.
void withFileInErrors(const std::filesystem::path& file, const std::function<void()>& step,
                      const std::string& kept = "finished runs are kept; continue with --resume");

/// Removes a database with the files that SQLite keeps beside it, if they are there.
void removeDatabase(const std::filesystem::path& file);
/// Renames a closed database to `to`. First removes an earlier file of the name `to` and its log,
/// because SQLite would apply that log to the renamed database. @throws InputError
void renameDatabase(const std::filesystem::path& from, const std::filesystem::path& to);

/// Tests that an open file is an undamaged campaign database. @returns the version of its tables.
/// @throws InputError
int requireCampaignFile(SQLite::Database& base, const std::filesystem::path& file);

}  // namespace corridor
