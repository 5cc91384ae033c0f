#include "planner/app/output.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <numbers>
#include <system_error>
#include <unistd.h>

#include "collision/core/error.h"
#include "collision/core/file_cache.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/jobs/ranks.h"
#include "planner/problem/nothing_tested.h"
#include "planner/solve/finish_path.h"

namespace corridor::app {

void ResultPrinter::line(std::string_view key, const std::string& value, Tone tone) const {
  if (quiet_) return;
  // The stdout of a rank is a terminal even if the stdout of `mpirun` is a file.
  static const bool colour = ::isatty(STDOUT_FILENO) != 0 && !startedByMpirun();
  const char* on = !colour              ? ""
                   : tone == Tone::good ? "\033[32m"
                   : tone == Tone::bad  ? "\033[31m"
                                        : "";
  std::cout << withoutControls(std::string(key)) << ": " << on << withoutControls(value)
            << (*on ? "\033[0m" : "") << '\n';
}

std::string provedClearanceText(double metres) {
  return metres > 0 ? "proved: " + rounded(1e3 * metres) + " mm"
                    : "free, but no distance is proved";
}

std::string marginText(const Task& task, double margin) {
  const double beyond = task.padding.beyond.largest();
  if (!(margin > 0 || beyond > 0)) return "";
  return rounded(margin) + (beyond > 0 ? " to " + rounded(margin + beyond) : "") + " m";
}

std::string jsonText(const nlohmann::ordered_json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

void ResultPrinter::blank() const {
  if (!quiet_) std::cout << '\n';
}

void warn(const std::string& text) {
  std::cerr << "corridor: warning: " << withoutControls(text) << '\n';
}

std::string rounded(double value) {
  return withDigits(value + 0.0);  // no "-0"
}

std::string rounded(const Vec3& v, int dimension) {
  std::string text = "[";
  for (int i = 0; i < dimension; ++i) text += (i ? ", " : "") + rounded(v[i]);
  return text + "]";
}

Vec3 rpyDegrees(const Mat3& R) {
  const double flat = std::hypot(R(0, 0), R(1, 0));
  return Vec3(std::atan2(R(2, 1), R(2, 2)), std::atan2(0.0 - R(2, 0), flat),
              std::atan2(R(1, 0), R(0, 0))) *
         (180 / std::numbers::pi);
}

std::string poseText(const RigidPose& pose) {
  const Vec3 rpy = rpyDegrees(pose.q.normalized().toRotationMatrix());
  return "at " + rounded(pose.p) + (rpy.isZero(0) ? "" : ", rpy_deg " + rounded(rpy));
}

nlohmann::ordered_json poseJson(const RigidPose& pose) {
  const Eigen::Quaterniond q = pose.q.normalized();
  return {{"position", numbersJson(pose.p)},
          {"quat_xyzw", std::vector<double>{q.x(), q.y(), q.z(), q.w()}}};
}

namespace {

struct Amounts {
  double metres = 0, radians = 0;
};

bool isLength(const Coordinate& c) {
  return c.kind == Coordinate::Kind::line && !c.angular;
}

Amounts largestParts(const ConfigurationSpace& space, const Configuration& tube) {
  Amounts parts;
  for (const Coordinate& c : space.coordinates()) {
    double& part = isLength(c) ? parts.metres : parts.radians;
    part = std::max(part, tube[static_cast<Eigen::Index>(c.first)]);
  }
  return parts;
}

/// Returns the amounts with their units, such as "0.1 m, 0.2 rad". If the space has no coordinate
/// in metres, the metres are left out; if it has none in radians, the radians. `between` separates
/// the two.
std::string amountText(const ConfigurationSpace& space, const Amounts& amounts,
                       const char* between) {
  bool lengths = false, angles = false;
  for (const Coordinate& c : space.coordinates()) (isLength(c) ? lengths : angles) = true;
  return (lengths ? rounded(amounts.metres) + " m" : "") + (lengths && angles ? between : "") +
         (angles ? rounded(amounts.radians) + " rad" : "");
}

}  // namespace

std::string lengthText(const ConfigurationSpace& space, double metres, double radians) {
  const bool hasPose = std::any_of(
      space.groups().begin(), space.groups().end(),
      [](const CoordinateGroup& group) { return group.kind != CoordinateGroup::Kind::joints; });
  const std::string sum = summands(space);
  return amountText(space, {metres, radians}, hasPose ? ", turning " : ", ") +
         (sum.empty() ? "" : " (" + sum + ")");
}

std::string tubeText(const ConfigurationSpace& space, const Configuration& tube) {
  const Amounts parts = largestParts(space, tube);
  return amountText(space, parts, ", ");
}

nlohmann::ordered_json tubeJson(const ConfigurationSpace& space, const Configuration& tube) {
  const Amounts parts = largestParts(space, tube);
  return {{"position_m", parts.metres}, {"rotation_rad", parts.radians}};
}

std::string stateText(const ConfigurationSpace& space, const Configuration& q) {
  std::string text;
  const std::vector<std::string> names = space.numberNames();
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i ? ", " : "") + names[i] + " = " + rounded(q[static_cast<Eigen::Index>(i)]);
  return text;
}

Problem readProblemOf(const std::string& file, std::shared_ptr<FileCache> cache) {
  Problem problem = readProblem(file, std::move(cache));
  if (nothingIsTested(problem)) warn(file + ": " + kNothingTested);
  return problem;
}

void saveCache(FileCache* cache, bool quiet) {
  if (!cache) return;
  std::cout.flush();
  cache->save();
  if (!quiet) printCacheNotes(cache->takeNotes());
}

void printCacheNotes(const std::vector<std::string>& notes) {
  for (const std::string& note : condensed(notes, ""))
    std::cerr << "corridor: note: " << withoutControls(note) << '\n';
}

Verified verifyWithWarning(const Problem& problem, const Solution& solution,
                           const std::string& problemFile, const std::string& solutionFile,
                           bool ignoreDigest) {
  Verified verified{
      verifySolution(problem, solution,
                     ignoreDigest ? DigestMismatch::ignored : DigestMismatch::refused),
      {}};
  const VerifyReport& report = verified.report;
  const auto warn = [&](const std::string& text) {
    app::warn(text);
    verified.warnings.push_back(text);
  };
  if (report.digest == DigestState::differs)
    warn(solutionFile + ": made for other files than those of " + problemFile +
         " (the digests differ)" +
         (ignoreDigest ? "" : "; it is not verified: --ignore-digest verifies it anyway"));
  if (report.otherProblem) return verified;
  if (solution.margin > problem.task.margin)
    warn(solutionFile + ": it claims a margin of " + shortest(solution.margin) +
         " m; it is verified with the problem's, " + shortest(problem.task.margin) + " m");
  if (report.pathReport.verdict == PathVerdict::proved &&
      solution.clearance > report.pathReport.provedClearance)
    warn(solutionFile + ": it claims a clearance of " + shortest(solution.clearance) + " m; only " +
         rounded(report.pathReport.provedClearance) + " m is proved");
  if (solution.tube.size() == problem.task.tube.size() &&
      (solution.tube.array() > problem.task.tube.array()).any())
    warn(solutionFile +
         ": it claims a larger tube than the problem's; it is verified with the problem's");
  return verified;
}

std::vector<std::string> condensed(const std::vector<std::string>& notes, const std::string& rest) {
  // Returns the note without quoted text and without numbers. Digits after a letter are kept,
  // because they belong to a name.
  const auto kindOf = [](const std::string& note) {
    std::string kind;
    bool quoted = false;
    for (const char c : note) {
      if (c == '"') quoted = !quoted;
      const bool isDigit = std::isdigit(static_cast<unsigned char>(c));
      const bool inName =
          isDigit && !kind.empty() &&
          (std::isalnum(static_cast<unsigned char>(kind.back())) || kind.back() == '_');
      if (!quoted && (!isDigit || inName)) kind += c;
    }
    return kind;
  };
  std::map<std::string, std::size_t> counts;
  for (const std::string& note : notes) ++counts[kindOf(note)];
  std::vector<std::string> lines;
  for (const std::string& note : notes) {
    std::size_t& count = counts[kindOf(note)];
    if (count == 0) continue;  // counted with an earlier note of this kind
    const std::size_t others = count - 1;
    lines.push_back(note);
    if (others > 0)
      lines.back() += " (and " + std::to_string(others) +
                      (others == 1 ? " similar note" : " similar notes") + rest + ")";
    count = 0;
  }
  return lines;
}

void printFaults(const InputError& error) {
  std::cerr << error.what() << '\n';
  if (const auto* const noted = dynamic_cast<const NotedInputError*>(&error))
    printNotes(noted->notes(), "");
}

void printNotes(const std::vector<Note>& notes, const std::string& rest) {
  for (const std::string& note : condensed(textsOf(notes), rest))
    std::cerr << "note: " << note << '\n';
}

void requireWritable(const std::optional<std::string>& file, const char* option) {
  if (!file) return;
  const std::filesystem::path path(*file);
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code none, unusable;
  // A type of none: neither found nor missing, as for names that are too long.
  if (std::filesystem::status(path, unusable).type() == std::filesystem::file_type::none)
    throw InputError(Fault{option, 0, *file + ": " + unusable.message() + "; name another file"});
  if (std::filesystem::is_directory(path, none))
    throw InputError(Fault{option, 0, *file + " is a folder; a file's name is needed"});
  if (!std::filesystem::is_directory(folder, none))
    throw InputError(Fault{option, 0, "there is no folder " + folder.string()});
  // A regular file is replaced by a new one, made in its folder. A device or a pipe is written to
  // directly, so its folder need not be writable.
  const bool takesItsPlace =
      !std::filesystem::exists(path, none) || std::filesystem::is_regular_file(path, none);
  if (takesItsPlace && ::access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(Fault{option, 0,
                           "no file can be made in the folder " + folder.string() + ": " +
                               std::generic_category().message(errno) + "; name another folder"});
}

void requireNotAnInput(const std::optional<std::string>& file, const char* option,
                       const std::vector<std::filesystem::path>& read, const std::string& what) {
  std::error_code none;
  for (const std::filesystem::path& other : read)
    if (file && std::filesystem::equivalent(*file, other, none))
      throw InputError(
          Fault{option, 0,
                *file + " belongs to " + what + " and would be overwritten; name another file"});
}

nlohmann::ordered_json numbersJson(const Configuration& q) {
  return std::vector<double>(q.begin(), q.end());
}

nlohmann::ordered_json numberJson(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

nlohmann::ordered_json leftOutJson(const Model& model, const LeftOut& leftOut) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const LeftOutPair& pair : leftOut.except)
    list.push_back({{"a", model.bodies[pair.a].name},
                    {"b", model.bodies[pair.b].name},
                    {"reason", nameOf(pair.reason)}});
  return list;
}

std::string grouped(std::uint64_t count) {
  std::string text = std::to_string(count);
  for (auto at = static_cast<int>(text.size()) - 3; at > 0; at -= 3)
    text.insert(static_cast<std::size_t>(at), ",");
  return text;
}

std::string counted(std::uint64_t count, const std::string& noun) {
  return grouped(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace corridor::app
