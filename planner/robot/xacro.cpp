#include "planner/robot/xacro.h"

#include <algorithm>
#include <sstream>
#include <system_error>

#include "collision/core/error.h"
#include "collision/core/external_program.h"
#include "collision/core/read_file.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"

namespace corridor {
namespace {

/// Returns the last three lines that are not blank, as one line of at most 400 bytes.
std::string lastLines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (line.find_first_not_of(" \t\r") != line.npos) lines.push_back(line);
  std::string joined;
  for (std::size_t i = lines.size() - std::min<std::size_t>(lines.size(), 3); i < lines.size(); ++i)
    joined += (joined.empty() ? "" : " | ") + lines[i];
  return joined.size() > 400 ? "…" + joined.substr(joined.size() - 400) : joined;
}

}  // namespace

bool isXacro(const std::filesystem::path& file) {
  return lowered(file.extension().string()) == ".xacro";
}

std::string expandXacro(const std::filesystem::path& file,
                        const std::vector<std::string>& arguments, double seconds) {
  const auto fail = [&](const std::string& what) {
    throw InputError(Fault{file.string(), 0, what});
  };
  requireFile(file, "a xacro file", kMostDocumentBytes);
  const std::filesystem::path program = findProgram("xacro");
  const std::string name = file.filename().string();
  std::string given = name;
  for (const std::string& argument : arguments) given += " " + argument;
  if (program.empty())
    fail(
        "needs xacro, and there is no program xacro in PATH; where it is installed, convert the "
        "file: xacro " +
        given + " > " + file.stem().string() + (file.stem().has_extension() ? "" : ".urdf") +
        ", and name the result");
  ProgramCall call{.words = {program.string(), "./" + name}, .seconds = seconds};
  call.words.insert(call.words.end(), arguments.begin(), arguments.end());
  call.folder = file.has_parent_path() ? file.parent_path() : ".";
  call.bytes = kMostDocumentBytes;
  ProgramEnd end;
  try {
    end = runProgram(call);
  } catch (const std::system_error& error) {
    fail(program.string() + " can't be started: " + error.code().message());
  }
  if (end.why == ProgramEnd::Why::timedOut)
    fail("xacro took more than " + shortest(seconds) + " s and was stopped");
  if (end.why == ProgramEnd::Why::tooMuchOutput)
    fail("xacro has printed more than 256 MiB, and was stopped");
  if (end.exitStatus != 0) {
    const std::string said = lastLines(end.err);
    fail("xacro " + given + " failed" +
         (end.exitStatus > 0 ? " (exit status " + std::to_string(end.exitStatus) + ")" : "") +
         (said.empty() ? ", and said nothing" : ": " + said));
  }
  if (end.out.find_first_not_of(" \t\r\n") == end.out.npos) fail("xacro has printed nothing");
  if (end.out.find('\0') != end.out.npos) fail("xacro has printed a byte 0, which no text has");
  return std::move(end.out);
}

}  // namespace corridor
