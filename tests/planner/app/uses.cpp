#include "tests/planner/app/uses.h"

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <sys/prctl.h>
#include <thread>
#include <unistd.h>

namespace corridor::test {
namespace {

namespace fs = std::filesystem;

/// Returns a problem: a hall with a wall. If `open` is true, there is a way around the wall; else
/// there is none.
std::string hall(bool open) {
  return std::string(
             "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  wall: {box: [0.1, ") +
         (open ? "2" : "10") +
         ", 1]}\nstart: {at: [-2, 0]}\ngoal: {at: [2, 0]}\nbounds: {at: [[-4, -4], [4, 4]]}\n";
}

std::string solution(int times) {
  std::string text = "format: corridor-solution-1\nspace: SE2\npath:\n- [-2, 0, 0]\n- [-2, 3, 0]\n";
  for (int i = 0; i < times; ++i) text += "- [-1, 3, 0]\n- [-2, 3, 0]\n";
  return text + "- [2, 3, 0]\n- [2, 0, 0]\n";
}

/// Returns an OBJ file of a landscape of 2·(count − 1)² triangles. If count is 500, reading the
/// file and each query take about a second.
std::string landscape(int count) {
  std::string text;
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < count; ++k)
      text += "v " + std::to_string(0.01 * i) + " " + std::to_string(0.01 * k) + " " +
              std::to_string(0.2 * std::sin(0.1 * i) * std::cos(0.07 * k)) + "\n";
  for (int i = 0; i + 1 < count; ++i)
    for (int k = 0; k + 1 < count; ++k) {
      const int a = i * count + k + 1, b = a + count;
      text += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(b + 1) +
              "\nf " + std::to_string(a) + " " + std::to_string(b + 1) + " " +
              std::to_string(a + 1) + "\n";
    }
  return text;
}

/// A script that stands in for Chromium. For a page with the landscape it starts a child process,
/// and never ends. For any other page it writes the picture at once.
constexpr const char* kBrowser = R"(#!/bin/sh
for word in "$@"; do case "$word" in --screenshot=*) file="${word#*=}";; esac; done
if grep -q '"name":"vast"' "${file%/*}/page.html"; then
  sleep 600 & echo started >browser.txt; exec sleep 600
fi
{ printf '\211PNG'; head -c 4096 /dev/zero; printf 'IEND\256B`\202'; } >"$file"
echo 'corridor: the picture is drawn' >&2
)";

}  // namespace

const std::vector<Use>& uses() {
  static const std::vector<Use> all = {
      {"Solve", "solve hall.yaml", {}, "solve closed.yaml --time 600"},
      {"SolveJson", "solve hall.yaml --json", {}, "solve closed.yaml --time 600 --json"},
      {"SolveOutput",
       "solve hall.yaml --seed 1 -o out/s.yaml",
       {"s.yaml"},
       "solve closed.yaml --time 600 -o out/s.yaml"},
      {"SolvePicture",
       "solve hall.yaml --seed 1 --picture out/p.svg",
       {"p.svg"},
       "solve closed.yaml --time 600 --picture out/p.svg"},
      {"Verify", "verify hall.yaml path.yaml", {}, "verify hall.yaml long.yaml"},
      {"VerifyJson", "verify hall.yaml path.yaml --json", {}, "verify hall.yaml long.yaml --json"},
      {"ViewOutput",
       "view hall.yaml path.yaml --output out/page.html",
       {"page.html"},
       "view hall.yaml long.yaml --output out/page.html"},
      {"ViewVolumes",
       "view cube.obj --volume aabb --output out/volumes.svg",
       {"volumes.svg"},
       "view vast.obj --volume sphere --output out/volumes.svg"},
      {"ViewImage",
       "view hall.yaml path.yaml --image out/a.png",
       {"a.png"},
       "view vast.yaml --image out/a.png",
       "browser.txt"},
      {"Benchmark", "benchmark hall.yaml --runs 1", {}, "benchmark hall.yaml --runs 100000"},
      {"BenchmarkJson",
       "benchmark hall.yaml --runs 1 --json",
       {},
       "benchmark hall.yaml --runs 100000 --json"},
      {"BenchmarkOutput",
       "benchmark hall.yaml --runs 1 --variants certified --output out/results",
       {"results/runs.jsonl", "results/campaign.db", "results/runs.csv", "results/summary.csv",
        "results/report.html"},
       "benchmark hall.yaml --runs 100000 --variants certified --output out/results",
       "out/results/runs.jsonl",
       true},
      {"Check", "check hall.yaml", {}, "check vast.yaml"},
      {"CheckJson", "check hall.yaml --json", {}, "check vast.yaml --json"},
      {"CheckStates",
       "check hall.yaml --states states.txt",
       {},
       "check hall.yaml --states -"},  // waits for input that never comes
      {"CheckStatesJson",
       "check hall.yaml --states states.txt --json",
       {},
       "check hall.yaml --states - --json"},
      {"Pose", "pose arm.urdf", {}, "pose vast.urdf"},
      {"PoseJson", "pose arm.urdf --json", {}, "pose vast.urdf --json"},
      {"InspectMesh", "inspect cube.obj", {}, "inspect vast.obj --self-intersections"},
      {"InspectMeshJson", "inspect cube.obj --json", {}, "inspect vast.obj --json"},
      {"InspectRobot", "inspect arm.urdf", {}, "inspect vast.urdf"},
      {"InspectProblem", "inspect hall.yaml --json", {}, "inspect vast.yaml --json"},
      {"InspectAgainst",
       "inspect cube.obj --against cube.obj",
       {},
       "inspect vast.obj --against vast.obj"},
      {"QueryInterference",
       "query cube.obj cube.obj --poses poses.txt",
       {},
       "query cube.obj cube.obj --poses poses.txt --repeat 1000000"},
      {"QueryContacts",
       "query cube.obj cube.obj --query contacts --poses poses.txt",
       {},
       "query cube.obj cube.obj --query contacts --poses -"},
      {"QueryDistance",
       "query cube.obj cube.obj --query distance --poses poses.txt",
       {},
       "query cube.obj cube.obj --query distance --grid 100x100x100 --repeat 1000"},
      {"QueryTolerance",
       "query cube.obj cube.obj --query tolerance --tolerance 0.1 --poses poses.txt",
       {},
       "query cube.obj cube.obj --query tolerance --tolerance 0.1 --grid 100x100x100 --repeat "
       "1000"},
      {"QueryMotions",
       "query cube.obj cube.obj --motions motions.txt",
       {},
       "query cube.obj cube.obj --motions motions.txt --repeat 1000000"},
      {"QueryDeform",
       "query cube.obj cube.obj --poses poses.txt --deform cube.obj cube.obj",
       {},
       "query cube.obj cube.obj --poses poses.txt --deform cube.obj --repeat 1000000"},
      {"CacheBuild", "cache build arm.urdf", {}, "cache build vast.urdf"},
      {"Course", "course plane cube.obj planes.txt", {}, "course plane cube.obj -"},
      {"QuerySavePoses",
       "query cube.obj cube.obj --grid 10x10x10 --save-poses out/grid.txt",
       {"grid.txt"},
       "query cube.obj cube.obj --grid 10x10x10 --save-poses out/grid.txt --repeat 1000000",
       "out/grid.txt",
       true},
      {"NewRobot", "new robot arm.urdf", {}, "new robot vast.urdf --samples 1000000000"},
      {"NewRobotOutput",
       "new robot arm.urdf --force --output out/robot.yaml",
       {"robot.yaml"},
       "new robot vast.urdf --samples 1000000000 --output out/robot.yaml"},
      {"NewProblemOutput",
       "new problem robot.yaml --force --output out/problem.yaml",
       {"problem.yaml"},
       "new problem vast.urdf --output out/problem.yaml"},
  };
  return all;
}

UseTest::UseTest() {
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);  // orphans of the program become children of this process
  cache_ = folder_ / "cache";
  ::setenv("CORRIDOR_CACHE", cache_.c_str(), 1);  // for `start`
  fs::create_directory(folder_ / "out");
  fs::create_directory(folder_ / "tmp");
  write("robot.yaml",
        "format: corridor-robot-1\nname: cube\nrigid: SE2\nshapes: [{box: [0.2, 0.2, 0.2]}]\n");
  write("hall.yaml", hall(true));
  write("closed.yaml", hall(false));
  write("path.yaml", solution(0));
  write("states.txt", "-2 0 0\n2 0 0\n");
  write(
      "cube.obj",
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf 1 3 2\nf 1 4 3\n"
      "f 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 3 4 8\nf 3 8 7\nf 2 3 7\nf 2 7 6\nf 1 5 8\nf 1 8 4\n");
  const std::string turn = "1 0 0 0 1 0 0 0 1 ";
  write("planes.txt", "0 0 1 2\n");
  write("poses.txt", turn + "0.5 0 0\n" + turn + "2 0 0.1\n");
  write("motions.txt", turn + "3 0 0.5 " + turn + "0.5 0 0.5\n");
  const auto urdf = [](const std::string& mesh) {
    return "<robot name='arm'><link name='a'/><link name='b'><collision><geometry><mesh "
           "filename='" +
           mesh +
           "'/></geometry></collision></link><joint name='pan' type='continuous'><parent link='a'/>"
           "<child link='b'/><axis xyz='0 0 1'/></joint></robot>";
  };
  write("arm.urdf", urdf("cube.obj"));
  write("vast.urdf", urdf("vast.obj"));
  write("vast.yaml",
        "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  land: {mesh: vast.obj, unit: m, "
        "at: [0, 0, -3]}\nstart: {at: [-2, 0]}\ngoal: {at: [2, 0]}\nbounds: {at: [[-4, -4], [4, "
        "4]]}\n");
  write("chromium", kBrowser);
  fs::permissions(folder_ / "chromium", fs::perms::owner_all);
}

UseTest::~UseTest() {
  if (input_ >= 0) ::close(input_);
}

pid_t UseTest::start(const std::string& arguments, const Setup& setup) {
  return startBy({}, arguments, setup);
}

pid_t UseTest::startBy(const std::vector<std::string>& wrapper, const std::string& arguments,
                       const Setup& setup) {
  if (arguments.find("long.yaml") != arguments.npos) write("long.yaml", solution(100'000));
  if (arguments.find("vast") != arguments.npos && !fs::exists(folder_ / "vast.obj"))
    write("vast.obj", landscape(500));
  std::vector<std::string> words = wrapper;
  words.emplace_back(CORRIDOR_PROGRAM);
  std::istringstream in(arguments);
  for (std::string word; in >> word;) words.push_back(word);
  int pipe[2];
  if (::pipe2(pipe, O_CLOEXEC) != 0) return -1;
  if (input_ >= 0) ::close(input_);
  input_ = pipe[1];
  const pid_t id = ::fork();
  if (id == 0) {
    ::setpgid(0, 0);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) ::signal(signal, SIG_DFL);
    const auto redirect = [](int to, const char* file) {
      const int from = ::open(file, O_WRONLY | O_CREAT | O_TRUNC, 0600);
      if (from < 0 || ::dup2(from, to) < 0) ::_exit(99);
      ::close(from);
    };
    if (::chdir(folder_.c_str()) != 0) ::_exit(99);
    ::dup2(pipe[0], STDIN_FILENO);
    redirect(STDOUT_FILENO, "out.txt");
    redirect(STDERR_FILENO, "err.txt");
    ::setenv("TMPDIR", (folder_ / "tmp").c_str(), 1);
    ::setenv("PATH", (folder_.string() + ":/usr/bin:/bin:/usr/sbin:/sbin").c_str(), 1);
    if (setup) setup();
    std::vector<char*> all;
    for (std::string& word : words) all.push_back(word.data());
    all.push_back(nullptr);
    ::execvp(all[0], all.data());
    ::_exit(99);
  }
  ::setpgid(id,
            id);  // both processes call this, so the group exists before either of them continues
  ::close(pipe[0]);
  return id;
}

UseTest::End UseTest::wait(pid_t id) {
  End end;
  int status = 0;
  ::waitpid(id, &status, 0);
  end.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  end.err = read("err.txt");
  // Processes that were killed along with the program may take a moment to end.
  pid_t other = 0;
  for (int i = 0; i < 300 * kSlowdown; ++i) {
    while ((other = ::waitpid(-1, nullptr, WNOHANG)) > 0) {
    }
    if (other < 0) return end;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  end.noChildLeft = false;
  std::ifstream left("/proc/self/task/" + std::to_string(::getpid()) + "/children");
  for (pid_t one = 0; left >> one;) ::kill(one, SIGKILL);
  return end;
}

std::vector<std::string> UseTest::written() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "out"))
    if (!entry.is_directory()) names.push_back(fs::relative(entry.path(), folder_ / "out"));
  return names;
}

void UseTest::learnWhole(const Use& use) {
  const End whole = end(use.arguments);
  ASSERT_EQ(whole.status, 0) << whole.err;
  for (const std::string& file : use.files) {
    ASSERT_TRUE(fs::exists(folder_ / "out" / file)) << file;
    whole_[file] = read("out/" + file);
  }
  fs::remove_all(folder_ / "out");
  cache_ = folder_ / "cache";
  ::setenv("CORRIDOR_CACHE", cache_.c_str(), 1);  // for `start`
  fs::create_directory(folder_ / "out");
}

void UseTest::expectWholeOrNothing(const Use& use) const {
  const bool folder = use.arguments.starts_with("benchmark");  // its files contain varying times
  for (const std::string& file : written()) {
    EXPECT_EQ(file.find(".tmp"), file.npos) << file;
    if (folder) continue;
    const auto whole = whole_.find(file);
    EXPECT_TRUE(whole != whole_.end() && whole->second == read("out/" + file)) << file;
  }
  for (const auto& entry : fs::directory_iterator(folder_ / "tmp"))
    ADD_FAILURE() << "left: " << entry.path();
}

std::vector<std::string> UseTest::mounting(const std::string& script) {
  const auto works = [](const std::string& how) {
    return std::system(("unshare " + how + " true >/dev/null 2>&1").c_str()) == 0;
  };
  static const std::string how = works("-Urm") ? "-Urm" : works("-m") ? "-m" : "";
  if (how.empty()) return {};
  return {"unshare", how, "sh", "-c", script};
}

}  // namespace corridor::test
