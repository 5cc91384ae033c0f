#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace corridor {

/// Statements of an SQLite database that are prepared once and executed often, and rows of tables
/// whose columns are added when a row first has them. Methods throw SQLite::Exception.
class DatabaseStatements {
 public:
  explicit DatabaseStatements(SQLite::Database& base) : base_(base) {}

  /// Executes a statement. @returns the id of the last inserted row.
  template <class... Values>
  std::int64_t execute(const std::string& sql, const Values&... values) {
    SQLite::Statement& statement = prepared(sql);
    SQLite::bind(statement, values...);
    statement.exec();
    statement.reset();
    return base_.getLastInsertRowid();
  }

  /// Inserts a row. @param properties maps OMPL's words for the name and type of a column to the
  /// value: "graph states INTEGER" is the column graph_states. An empty value, nan and inf are
  /// stored as NULL, as OMPL's script does. @param ids values of further columns, which must exist
  /// already.
  /// @returns the row's id.
  std::int64_t addRow(const std::string& table,
                      const std::map<std::string, std::string>& properties,
                      const std::vector<std::pair<std::string, std::int64_t>>& ids);
  /// Sets the value in one column of a row. Adds the column if it does not exist. @param words the
  /// column's name and type, as in `addRow`.
  void setValue(const std::string& table, std::int64_t id, const std::string& words,
                const std::string& value);

  /// Forgets the columns and the statements. Call this after a failed transaction: its rollback
  /// removes the columns that it added.
  void forget();

 private:
  /// Returns the prepared statement, without bound values.
  SQLite::Statement& prepared(const std::string& sql);
  /// Adds a column if it does not exist. @returns its name in quotes.
  const std::string& columnOf(const std::string& table, const std::string& words);

  SQLite::Database& base_;
  std::map<std::string, SQLite::Statement> statements_;
  /// The quoted names of columns, by table and words; and the columns that exist, by table.
  std::map<std::pair<std::string, std::string>, std::string> names_;
  std::map<std::string, std::set<std::string>> columns_;
};

}  // namespace corridor
