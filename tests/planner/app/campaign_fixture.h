#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <sstream>
#include <string>
#include <vector>

#include "tests/planner/app/program_test.h"

namespace corridor::test {

/// A campaign of 72 short runs: 2 planners, 3 checkers, 12 seeds.
class CampaignTest : public ProgramTest {
 protected:
  CampaignTest() {
    write("robot.yaml",
          "format: corridor-robot-1\nname: cube\nrigid: SE2\nshapes: [{box: [0.2, 0.2, 0.2]}]\n");
    write("hall.yaml",
          "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  wall: {box: [0.01, 6, 1], at: "
          "[0, -1, 0]}\nstart: {at: [-2, 0]}\ngoal: {at: [2, 0]}\nbounds: {at: [[-4, -4], [4, "
          "4]]}\n");
    write("campaign.yaml",
          "format: corridor-campaign-1\nproblems: [hall.yaml]\n"
          "planners: [RRTConnect, {name: RRT, label: short, params: {range: 0.3}}]\n"
          "checkers:\n  certified: {edges: certified}\n  sampled: {edges: discrete, resolution: "
          "[0.2, 0.01]}\nruns: 12\n");
  }

  /// Returns the number of stored runs in a folder; 0 while there are none. A line that is being
  /// written doesn't count.
  int runsIn(const std::string& folder) const {
    const std::string text = contents(folder_ / folder / "runs.jsonl");
    int runs = 0;
    for (std::size_t at = 0, end; (end = text.find('\n', at)) != text.npos; at = end + 1)
      runs += text.compare(at, 8, "{\"cell\":") == 0;
    return runs;
  }
  /// Returns the first value of a query of a folder's database.
  std::string query(const std::string& folder, const std::string& sql) const {
    SQLite::Database base((folder_ / folder / "campaign.db").string());
    return base.execAndGet(sql).getString();
  }

  /// Returns the rows of runs.csv without the columns of times, which don't repeat.
  std::vector<std::string> repeatable(const std::string& folder) const {
    std::vector<std::string> rows;
    std::vector<bool> keep;
    for (const std::string& line : lines(read(folder + "/runs.csv"))) {
      std::vector<std::string> cells;
      std::istringstream in(line);
      for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
      if (keep.empty())
        for (const std::string& name : cells) keep.push_back(!name.ends_with("_s"));
      std::string row;
      for (std::size_t i = 0; i < cells.size() && i < keep.size(); ++i)
        if (keep[i]) row += cells[i] + ",";
      rows.push_back(row);
    }
    return rows;
  }
};

}  // namespace corridor::test
