#pragma once

#include <algorithm>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/planner/app/program_test.h"

namespace corridor::test {

inline const std::string kStill = "1 0 0 0 1 0 0 0 1 ";  // the identity

/// Runs `corridor query` on two triangles.
class QueryCommand : public ProgramTest {
 protected:
  QueryCommand() {
    write("a.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
    write("b.obj", "v 1 1 -1\nv 1 1 1\nv 3 1 1\nf 1 2 3\n");
    // Four poses, in this order: b crosses a's face; a corner of b is on the face; b is just above
    // the face; b crosses an edge of a.
    write("poses.txt", "# R t\n" + kStill +
                           "0 0 0\n1,0,0,0,1,0,0,0,1,0,0,1  # comma separated\n\n" + kStill +
                           "0 0 1.0000001\n" + kStill + "-1.5 0 0\n");
  }
  Result query(const std::string& more) const { return run("query a.obj b.obj " + more); }

  static std::map<std::string, std::string> summary(const Result& result) {
    std::map<std::string, std::string> values;
    std::istringstream lines(result.err);
    for (std::string line; std::getline(lines, line);) {
      const auto at = line.find('=');
      EXPECT_NE(at, line.npos) << line;
      values[line.substr(0, at)] = line.substr(at + 1);
    }
    return values;
  }
  /// Runs the query, and returns the numbers in each line of the CSV, without the header.
  std::vector<std::vector<double>> rows(const std::string& options) const {
    const Result result = query(options);
    EXPECT_EQ(result.status, 0) << result.err;
    std::vector<std::vector<double>> all;
    std::istringstream lines(result.out);
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
      std::replace(line.begin(), line.end(), ',', ' ');
      std::istringstream words(line);
      all.emplace_back(std::istream_iterator<double>(words), std::istream_iterator<double>());
    }
    return all;
  }
};

}  // namespace corridor::test
