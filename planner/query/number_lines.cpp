#include "planner/query/number_lines.h"

#include <algorithm>
#include <cstdint>

#include "collision/core/fault_list.h"
#include "collision/core/read_file.h"
#include "collision/core/spelling.h"
#include "collision/core/text_encoding.h"
#include "planner/app/output.h"
#include "planner/problem/number_text.h"
#include "planner/problem/table_lines.h"

namespace corridor::app {
namespace {

/// At most this many faulty lines are reported one by one, because a file in another format has a
/// fault in every line. If there are more, the last faulty line is reported, too.
constexpr int kFaultsListed = 10;

/// Reads the numbers of a line into `values`. Returns what is wrong, or "".
std::string numbersOf(std::string_view line, std::vector<double>& values) {
  while (true) {
    constexpr std::string_view kBlanks = " \t\r,";
    line.remove_prefix(std::min(line.size(), line.find_first_not_of(kBlanks)));
    if (line.empty()) return "";
    const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
    line.remove_prefix(word.size());
    double value = 0;
    if (std::string complaint = parseNumber(word, Range::Any, value); !complaint.empty())
      return complaint;
    values.push_back(value);
  }
}

/// Returns what is wrong with a comment that gives another unit, or that names the numbers of a
/// pose in another order; otherwise "".
std::string whyNotComment(const std::string& comment) {
  if (const std::string unit = otherUnit(comment); !unit.empty())
    return "the comment says " + quotedWord(unit) + ", but lengths are read in metres";
  const std::string text = lowered(comment);
  if (const auto t = text.find("tx"), r = text.find("r00");
      t != text.npos && r != text.npos && t < r)
    return "the comment names the numbers in another order than r00 r01 … r22 tx ty tz, in which "
           "they are read";
  return "";
}

}  // namespace

void readNumberLines(const std::filesystem::path& file, const std::string& what,
                     const std::function<std::string(const std::vector<double>&)>& take) {
  const std::string name = file.string();
  FaultList faults(name);
  const std::string text = readTextStream(file, "a file of " + what + ", one per line,");
  int number = 0, faulty = 0, lastFaulty = 0;
  bool isEmpty = true;
  for (std::size_t begin = text.size() - withoutByteOrderMark(text).size(); begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line(text.data() + begin, end - begin);
    begin = end + 1;
    ++number;
    const std::string comment(line.substr(std::min(line.find('#'), line.size())));
    line = line.substr(0, line.find('#'));
    std::vector<double> values;
    std::string complaint = numbersOf(line, values);
    if (complaint.empty()) complaint = whyNotComment(comment);
    if (complaint.empty() && values.empty()) continue;
    isEmpty = false;
    if (complaint.empty()) complaint = take(values);
    if (complaint.empty()) continue;
    if (++faulty <= kFaultsListed) faults.add(name, number, complaint);
    lastFaulty = number;
  }
  if (faulty > kFaultsListed)
    faults.add(name, lastFaulty,
               "and so on: " + counted(static_cast<std::uint64_t>(faulty), "line") +
                   " are faulty, this is the last");
  if (isEmpty) faults.add(name, 0, "no " + what);
  faults.throwIfAny();
}

}  // namespace corridor::app
