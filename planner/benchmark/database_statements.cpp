#include "planner/benchmark/database_statements.h"

#include <algorithm>

#include "planner/solve/csv_text.h"

namespace corridor {
namespace {

/// Returns whether OMPL's script stores a value as NULL.
bool isNull(const std::string& value) {
  return value.empty() || value == "nan" || value == "inf" || value == "-nan" || value == "-inf";
}

}  // namespace

SQLite::Statement& DatabaseStatements::prepared(const std::string& sql) {
  SQLite::Statement& statement = statements_.try_emplace(sql, base_, sql).first->second;
  statement.reset();
  statement.clearBindings();
  return statement;
}

const std::string& DatabaseStatements::columnOf(const std::string& table,
                                                const std::string& words) {
  std::string& quoted = names_[{table, words}];
  if (!quoted.empty()) return quoted;
  std::set<std::string>& known = columns_[table];
  if (known.empty()) {
    SQLite::Statement columns(base_, "PRAGMA table_info(" + table + ")");
    while (columns.executeStep()) known.insert(columns.getColumn(1).getString());
  }
  const auto blank = words.rfind(' ');
  std::string name = words.substr(0, blank);
  std::replace(name.begin(), name.end(), ' ', '_');
  const std::string type = blank == std::string::npos ? "TEXT" : words.substr(blank + 1);
  if (known.insert(name).second)
    base_.exec("ALTER TABLE " + table + " ADD " + inDoubleQuotes(name) + " " + type);
  return quoted = inDoubleQuotes(name);
}

std::int64_t DatabaseStatements::addRow(
    const std::string& table, const std::map<std::string, std::string>& properties,
    const std::vector<std::pair<std::string, std::int64_t>>& ids) {
  std::string names, marks;
  for (const auto& [name, id] : ids) names += "," + name, marks += ",?";
  for (const auto& [words, value] : properties)
    names += "," + columnOf(table, words), marks += ",?";
  SQLite::Statement& row = prepared("INSERT INTO " + table + " (" + names.substr(1) + ") VALUES (" +
                                    marks.substr(1) + ")");
  int at = 0;
  for (const auto& [name, id] : ids) row.bind(++at, id);
  for (const auto& [words, value] : properties) {
    ++at;
    if (!isNull(value)) row.bind(at, value);  // SQLite converts the value to the column's type
  }
  row.exec();
  row.reset();
  return base_.getLastInsertRowid();
}

void DatabaseStatements::setValue(const std::string& table, std::int64_t id,
                                  const std::string& words, const std::string& value) {
  execute("UPDATE " + table + " SET " + columnOf(table, words) + " = ? WHERE id = ?", value, id);
}

void DatabaseStatements::forget() {
  statements_.clear();
  names_.clear();
  columns_.clear();
}

}  // namespace corridor
