#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <filesystem>
#include <string>
#include <vector>

#include "planner/benchmark/campaign.h"
#include "tests/planner/checker/hall.h"
#include "tests/support/support.h"

namespace corridor::test {

/// Returns a campaign of a cube in a hall, with two seeds.
inline Campaign hallCampaign(const std::vector<std::string>& variants) {
  Campaign campaign;
  campaign.problems = {hallProblem(Rigid::SE3)};
  campaign.problems[0].model.bodies[0].shapes[0] = shapeOf("box", boxMesh({0.1, 0.1, 0.1}));
  for (const std::string& variant : variants) campaign.variants.push_back(readVariant(variant));
  campaign.runs = 2;
  campaign.time = 2.0 * kSlowdown;
  identifyProblems(campaign);
  return campaign;
}

/// Returns all rows of a query of an SQLite file, as text: values are separated by "|".
inline std::vector<std::string> rowsOf(const std::filesystem::path& file, const std::string& sql) {
  SQLite::Database base(file.string());
  SQLite::Statement query(base, sql);
  std::vector<std::string> rows;
  while (query.executeStep()) {
    std::string row;
    for (int i = 0; i < query.getColumnCount(); ++i)
      row += (i ? "|" : "") + std::string(query.getColumn(i).getText());
    rows.push_back(row);
  }
  return rows;
}

}  // namespace corridor::test
