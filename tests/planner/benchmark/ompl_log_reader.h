#pragma once

#include <algorithm>
#include <charconv>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace corridor::test {

/// A log of OMPL's Benchmark, read by the grammar of `ompl_benchmark_statistics` (OMPL 1.5), but
/// more strictly: the reader throws for text that OMPL's program would skip, or store as another
/// value.
struct OmplLog {
  struct Planner {
    std::string name;
    std::map<std::string, std::string> settings;
    std::vector<std::pair<std::string, std::string>> properties;  ///< name, type
    /// Values by name; "": the run has no value.
    std::vector<std::map<std::string, std::string>> runs;
    std::vector<std::string> progressNames;
    std::vector<std::size_t> progressSamples;  ///< number of samples of each run
  };
  std::string version, experiment, host, setup, cpu;
  /// Values by name and type, such as "resolution REAL".
  std::map<std::string, std::string> parameters;
  std::string seed;
  double time = 0, memory = 0, seconds = 0;
  std::size_t runs = 0;
  std::vector<std::string> statuses;  ///< names of the values of `status`
  std::vector<Planner> planners;
};

class OmplLogReader {
 public:
  /// Reads a log. @throws std::runtime_error with the faulty line.
  static OmplLog read(const std::string& text) {
    OmplLogReader reader(text);
    return reader.log();
  }

 private:
  explicit OmplLogReader(const std::string& text) : in_(text) {
    if (text.empty() || text.back() != '\n') throw std::runtime_error("no line end at the end");
  }

  [[noreturn]] void fail(const std::string& why) const {
    throw std::runtime_error("line " + std::to_string(number_) + ": " + why + ": " + line_);
  }
  const std::string& next() {
    ++number_;
    line_.clear();
    if (!std::getline(in_, line_)) fail("the log ends");
    return line_;
  }
  std::string after(const std::string& prefix) {
    if (next().rfind(prefix, 0) != 0) fail("\"" + prefix + "\" is missing");
    return line_.substr(prefix.size());
  }
  std::string before(const std::string& suffix) {
    next();
    if (line_.size() <= suffix.size() || !line_.ends_with(suffix))
      fail("\"" + suffix + "\" is missing");
    return line_.substr(0, line_.size() - suffix.size());
  }
  std::string word(const std::string& text) const {
    if (text.empty() || text.find_first_of(" \t") != std::string::npos) fail("not one word");
    return text;
  }
  template <class Number>
  Number number(const std::string& text) const {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) fail("\"" + text + "\"?");
    return value;
  }
  std::size_t count(const std::string& suffix) { return number<std::size_t>(before(suffix)); }
  std::string block() {
    if (next() != "<<<|") fail("<<<| is missing");
    std::string text;
    while (next() != "|>>>") text += line_ + '\n';
    return text;
  }
  std::pair<std::string, std::string> assignment() {
    next();
    const auto at = line_.find(" = ");
    if (at == std::string::npos || line_.find(" = ", at + 1) != std::string::npos)
      fail("not NAME = VALUE");
    return {line_.substr(0, at), line_.substr(at + 3)};
  }
  /// Reads a name and a type: "planner_s REAL".
  std::pair<std::string, std::string> property() {
    next();
    const auto at = line_.rfind(' ');
    if (at == std::string::npos) fail("no type");
    std::pair<std::string, std::string> p{line_.substr(0, at), line_.substr(at + 1)};
    const std::vector<std::string> types{"REAL", "INTEGER", "BOOLEAN", "ENUM"};
    if (std::find(types.begin(), types.end(), p.second) == types.end()) fail("unknown type");
    std::replace(p.first.begin(), p.first.end(), ' ', '_');
    return p;
  }
  void checkValue(const std::string& type, const std::string& value, const OmplLog& log) const {
    if (value.empty() || value == "nan" || value == "inf") return;  // stored as NULL
    if (type == "REAL")
      number<double>(value);
    else if (type == "BOOLEAN" && value != "0" && value != "1")
      fail("neither 0 nor 1");
    else if (number<unsigned long long>(value) >= log.statuses.size() && type == "ENUM")
      fail("no such status");
  }

  OmplLog log() {
    OmplLog log;
    log.version = word(after("OMPL version "));
    log.experiment = word(after("Experiment "));
    for (std::size_t n = count(" experiment properties"); n > 0; --n)
      if (!log.parameters.insert(assignment()).second) fail("a second time");
    log.host = word(after("Running on "));
    after("Starting at ");
    log.setup = block();
    log.cpu = block();
    log.seed = word(before(" is the random seed"));
    log.time = number<double>(before(" seconds per run"));
    log.memory = number<double>(before(" MB per run"));
    log.runs = count(" runs per planner");
    log.seconds = number<double>(before(" seconds spent to collect the data"));
    if (next() != "1 enum type") fail("one enumeration is expected");
    std::istringstream statuses(after("status|"));
    for (std::string status; std::getline(statuses, status, '|');) log.statuses.push_back(status);
    for (std::size_t n = count(" planners"); n > 0; --n) log.planners.push_back(planner(log));
    if (std::getline(in_, line_)) fail("more than was announced");
    return log;
  }

  OmplLog::Planner planner(const OmplLog& log) {
    OmplLog::Planner p;
    p.name = word(next());
    for (std::size_t n = count(" common properties"); n > 0; --n) p.settings.insert(assignment());
    for (std::size_t n = count(" properties for each run"); n > 0; --n)
      p.properties.push_back(property());
    std::vector<std::string> names;  // SQL column names are not case-sensitive
    for (const auto& [name, type] : p.properties) {
      names.push_back(name);
      for (char& c : names.back()) c = static_cast<char>(std::tolower(c));
    }
    std::sort(names.begin(), names.end());
    if (std::adjacent_find(names.begin(), names.end()) != names.end()) fail("a column twice");
    for (std::size_t n = count(" runs"); n > 0; --n) {
      const std::vector<std::string> values = fields(next(), "; ");
      if (values.size() != p.properties.size()) fail("another number of values than of properties");
      p.runs.emplace_back();
      for (std::size_t i = 0; i < values.size(); ++i) {
        checkValue(p.properties[i].second, values[i], log);
        p.runs.back()[p.properties[i].first] = values[i];
      }
    }
    next();
    if (line_ == ".") return p;
    const std::string suffix = " progress properties for each run";
    if (!line_.ends_with(suffix)) fail("neither progress nor the planner's end");
    for (auto n = number<std::size_t>(line_.substr(0, line_.size() - suffix.size())); n > 0; --n)
      p.progressNames.push_back(property().first);
    if (count(" runs") != p.runs.size()) fail("progress of another number of runs");
    for (std::size_t n = p.runs.size(); n > 0; --n) {
      const std::vector<std::string> samples = fields(next(), ";");
      for (const std::string& sample : samples)
        if (fields(sample, ",").size() != p.progressNames.size()) fail("not a sample: " + sample);
      p.progressSamples.push_back(samples.size());
    }
    if (next() != ".") fail("the planner's end is missing");
    return p;
  }
  /// Splits a text into fields, each of which must be followed by the separator.
  std::vector<std::string> fields(const std::string& text, const std::string& separator) const {
    std::vector<std::string> all;
    std::size_t at = 0;
    while (at < text.size()) {
      const auto end = text.find(separator, at);
      if (end == std::string::npos) fail("\"" + separator + "\" is missing at the end");
      all.push_back(text.substr(at, end - at));
      at = end + separator.size();
    }
    return all;
  }

  std::istringstream in_;
  std::string line_;
  int number_ = 0;
};

}  // namespace corridor::test
