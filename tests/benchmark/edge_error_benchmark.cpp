/// Measures run time against error, edge by edge: `edge_error_benchmark [--problem FILE]… [--edges
/// N] [--rounds N] [--seed N] [--cpu N] [--out FOLDER]`.
///
/// Runs every edge method with several values of its accuracy parameter (its knob), and Debian's
/// FCL as a competitor. The true verdict of each edge is known without sampling. There are edges
/// that graze by construction, closed forms with the time of first contact, and random edges of
/// problems, for which the independent verifier decides.
///
/// FCL's methods:
/// * its static test at samples ("FCL discrete");
/// * its continuousCollide, if all bodies are rigid meshes: by samples ("FCL naive") and by
///   advancement ("FCL continuous", whose answers are wrong: fcl_motion.h);
/// * the advancement that FCL contains but never calls ("FCL advancement").
///
/// Prints CSV on stdout, one line per set, method and knob: µs of processor time per edge, contacts
/// missed, free edges called contact, undecided edges, free edges lost (called contact, or
/// undecided), and the error of the time of first contact. With --out, also writes plots for each
/// set. They have only the methods that tested all edges of the set within a minute.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <iostream>
#include <limits>
#include <map>
#include <optional>

#include "collision/core/quantiles.h"
#include "planner/benchmark/fcl_scene.h"
#include "tests/benchmark/arguments.h"
#include "tests/benchmark/edge_cases.h"
#include "tests/benchmark/fcl_motion.h"
#include "tests/benchmark/plot.h"

namespace corridor::bench {
namespace {

struct Answer {
  MotionVerdict verdict = MotionVerdict::free;
  double firstContact = -1;  ///< time t in [0, 1]; −1 if no contact was found
};

/// A method with a value of its knob: a function that returns the answer for an edge.
using Method = std::function<Answer(const EdgeCase&)>;

/// Returns a method that proves edges. It requests the time of first contact, as does a planner
/// that continues from the last valid state.
Method proving(EdgeMethod method, double tolerance) {
  const auto context = std::make_shared<QueryContext>();
  return [=](const EdgeCase& edge) {
    MotionOptions options;
    options.tolerance = tolerance * edge.size;
    options.earliest = true;
    options.timeTolerance = 1e-9;
    const MotionResult r = edge.scene->certify(edge.motion(), options, *context, method);
    return Answer{r.verdict, r.time};
  };
}

/// Returns a method that samples by OMPL's rule: it tests `steps` + 1 evenly spaced poses, one
/// after another from the start, up to the first contact.
template <class Touches>
Method sampling(int steps, Touches touches) {
  const auto poses = std::make_shared<std::vector<Transform>>();
  return [=](const EdgeCase& edge) {
    for (int i = 0; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      edge.poses(t, *poses);
      if (touches(edge, *poses)) return Answer{MotionVerdict::contact, t};
    }
    return Answer{};
  };
}

Method discrete(int steps) {
  const auto context = std::make_shared<QueryContext>();
  return sampling(steps, [=](const EdgeCase& edge, const std::vector<Transform>& X_WF) {
    return edge.scene->interference(X_WF, *context).has_value();
  });
}

#ifdef CORRIDOR_WITH_FCL
/// FCL's models of scenes. Building these models is never part of a measured time.
class FclScenes {
 public:
  void add(const EdgeCase& edge, const std::shared_ptr<FclScene>& scene) {
    scenes_[edge.scene] = scene;
  }
  FclScene& of(const EdgeCase& edge) const { return *scenes_.at(edge.scene); }
  bool knows(const EdgeCase& edge) const { return scenes_.count(edge.scene) > 0; }

 private:
  std::map<const Scene*, std::shared_ptr<FclScene>> scenes_;
};

Method fclDiscrete(const FclScenes& scenes, int steps) {
  return sampling(steps, [&scenes](const EdgeCase& edge, const std::vector<Transform>& X_WF) {
    return scenes.of(edge).touches(X_WF);
  });
}

/// FCL's models for whole motions. They are used for all edges of a set, or for none.
class FclMoving {
 public:
  explicit FclMoving(const EdgeSet& set) {
    for (const EdgeCase& edge : set.cases) {
      auto& motions = motions_[edge.scene];
      if (!motions) motions = FclMotions::of(*edge.scene);
      // 1e-9 of the size is far more than the rounding of poses, and as small as the smallest
      // tolerance with which the methods run.
      all_ = all_ && motions && motions->moveAs(edge.poses, 1e-9 * edge.size);
    }
  }
  /// Returns whether, in all edges, all bodies are meshes and move as FCL's motions do.
  bool all() const { return all_; }

  /// Returns the method that sets up FCL's motions, and passes models and motions to `first`, which
  /// computes the time of first contact. Setting up the motions counts as run time.
  template <class First>
  Method method(First first) const {
    return [this, first, from = std::make_shared<std::vector<Transform>>(),
            to = std::make_shared<std::vector<Transform>>()](const EdgeCase& edge) {
      edge.poses(0, *from);
      edge.poses(1, *to);
      const FclMotions& models = *motions_.at(edge.scene);
      const std::optional<double> t = first(models, models.motions(*from, *to));
      return t ? Answer{MotionVerdict::contact, *t} : Answer{};
    };
  }

 private:
  std::map<const Scene*, std::shared_ptr<const FclMotions>> motions_;
  bool all_ = true;
};

template <class Volume>
Method fclContinuous(const FclMoving& moving, fcl::CCDSolverType solver, std::size_t iterations) {
  // FCL uses the lesser of num_max_iterations and 1 / toc_err, if it uses them at all.
  const fcl::ContinuousCollisionRequestd request(iterations, 1 / static_cast<double>(iterations),
                                                 fcl::CCDM_LINEAR, fcl::GST_LIBCCD, solver);
  return moving.method([request](const FclMotions& models, const std::vector<FclMotion>& motions) {
    return models.continuousCollide<Volume>(motions, request);
  });
}

Method fclAdvancement(const FclMoving& moving, double leastStep) {
  return moving.method(
      [leastStep](const FclMotions& models, const std::vector<FclMotion>& motions) {
        return models.advance(motions, leastStep);
      });
}
#endif

struct Tally {
  int edges = 0, contacts = 0, missed = 0, falseAlarms = 0, undecided = 0, lost = 0;
  double us = 0;
  std::vector<double> timeErrors;
};

/// Returns this thread's processor time, µs: other programs on a busy machine don't count.
double processorTime() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

/// Measures a method on all edges: for each edge, the median time of the rounds, and the answer of
/// the last round. Stops after a minute; the tally then covers only the edges tested by then.
Tally run(const EdgeSet& set, const Method& method, int rounds) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  Tally tally;
  for (const EdgeCase& edge : set.cases) {
    std::vector<double> times;
    Answer answer;
    for (int i = 0; i < rounds; ++i) {
      if (i > 0 && Clock::now() - start > std::chrono::minutes(1)) break;
      const double begin = processorTime();
      answer = method(edge);
      times.push_back(processorTime() - begin);
    }
    tally.us += medianOf(times);
    ++tally.edges;
    tally.contacts += edge.contact;
    tally.undecided += answer.verdict == MotionVerdict::undecided;
    tally.missed += edge.contact && answer.verdict == MotionVerdict::free;
    tally.falseAlarms += !edge.contact && answer.verdict == MotionVerdict::contact;
    tally.lost += !edge.contact && answer.verdict != MotionVerdict::free;
    if (edge.firstContact >= 0 && answer.verdict == MotionVerdict::contact)
      tally.timeErrors.push_back(std::abs(answer.firstContact - edge.firstContact));
    if (Clock::now() - start > std::chrono::minutes(1)) break;
  }
  tally.us /= tally.edges;
  return tally;
}

/// The results of one set, for every method at every knob: CSV lines and the plots.
class Report {
 public:
  Report(const EdgeSet& set, int rounds)
      : set_(set),
        rounds_(rounds),
        wrong_{"edge_error_" + underscored(set.name),
               set.name + ": contacts missed and free edges lost (0 is drawn as 1 of " +
                   std::to_string(2 * set.cases.size()) + ")",
               "µs per edge",
               "share of the edges",
               true,
               true},
        late_{"edge_first_contact_" + underscored(set.name),
              set.name + ": error of the time of first contact",
              "µs per edge",
              "median, as a share of the edge",
              true,
              true} {}

  void line(const std::string& method, double knob, const Method& ask) {
    Tally t = run(set_, ask, rounds_);
    std::sort(t.timeErrors.begin(), t.timeErrors.end());
    const bool timed = !t.timeErrors.empty();
    std::cout << set_.name << ',' << method << ',' << knob << ',' << t.edges << ',' << t.contacts
              << ',' << t.us << ',' << t.missed << ',' << t.falseAlarms << ',' << t.undecided << ','
              << t.lost << ',';
    if (timed) std::cout << t.timeErrors[t.timeErrors.size() / 2] << ',' << t.timeErrors.back();
    std::cout << (timed ? "\n" : ",\n") << std::flush;
    if (t.edges < static_cast<int>(set_.cases.size())) return;  // incomplete: not comparable
    const auto add = [&](std::vector<PlotSeries>& all, double error) {
      if (all.empty() || all.back().name != method) all.push_back({.name = method, .points = {}});
      all.back().points.push_back({t.us, error});
    };
    const int wrong = t.missed + t.lost;
    add(wrongOnes_, wrong > 0 ? static_cast<double>(wrong) / t.edges
                              : 0.5 / static_cast<double>(set_.cases.size()));
    if (timed) add(lateOnes_, t.timeErrors[t.timeErrors.size() / 2]);
  }
  void write(const std::filesystem::path& folder) {
    for (const PlotSeries& s : wrongOnes_) addLine(wrong_, s.name, s.points);
    writePlot(wrong_, folder);
    for (const PlotSeries& s : lateOnes_) addLine(late_, s.name, s.points);
    if (!lateOnes_.empty()) writePlot(late_, folder);
  }

 private:
  static std::string underscored(std::string name) {
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
  }

  const EdgeSet& set_;
  int rounds_;
  Plot wrong_, late_;
  std::vector<PlotSeries> wrongOnes_, lateOnes_;
};

void compare(const EdgeSet& set, int rounds, const std::string& folder) {
  if (set.cases.empty()) throw std::runtime_error(set.name + ": no edge has a known truth");
  std::cerr << set.name << ": " << set.cases.size() << " edges, " << set.dropped
            << " left out because the verifier could not decide them\n";
  Report report(set, rounds);
  for (std::size_t m = 0; m < provingMethodNames().size(); ++m)
    for (const double tolerance : {1e-2, 1e-3, 1e-5, 1e-7, 1e-9})
      report.line(edgeMethodNames()[m], tolerance, proving(static_cast<EdgeMethod>(m), tolerance));
  const std::vector<int> steps = {10, 32, 100, 316, 1'000, 10'000, 100'000};
  for (const int n : steps) report.line("discrete", 1.0 / n, discrete(n));
#ifdef CORRIDOR_WITH_FCL
  FclScenes scenes;
  for (const EdgeCase& edge : set.cases)
    if (!scenes.knows(edge))
      scenes.add(edge, edge.fcl ? edge.fcl() : std::make_shared<FclScene>(*edge.scene));
  for (const int n : steps) report.line("FCL discrete", 1.0 / n, fclDiscrete(scenes, n));
  const FclMoving moving(set);
  if (moving.all()) {
    using Obbrss = fcl::OBBRSS<double>;
    using Rss = fcl::RSS<double>;
    // The answers are the same as those of "FCL discrete", but they take longer.
    for (const int n : {10, 100, 1'000, 10'000})
      report.line("FCL naive", 1.0 / n,
                  fclContinuous<Obbrss>(moving, fcl::CCDC_NAIVE, static_cast<std::size_t>(n + 1)));
    const auto solver = fcl::CCDC_CONSERVATIVE_ADVANCEMENT;
    for (const std::size_t n : {100u, 10'000u, 1'000'000u})
      report.line("FCL continuous OBBRSS", 1.0 / static_cast<double>(n),
                  fclContinuous<Obbrss>(moving, solver, n));
    for (const std::size_t n : {100u, 10'000u, 1'000'000u})
      report.line("FCL continuous RSS", 1.0 / static_cast<double>(n),
                  fclContinuous<Rss>(moving, solver, n));
    for (const double step : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6})
      report.line("FCL advancement", step, fclAdvancement(moving, step));
  }
#endif
  if (!folder.empty()) report.write(folder);
}

void runAll(const Arguments& arguments) {
  pin(arguments);
  const int count = static_cast<int>(arguments.number("--edges", 200));
  const auto seed = static_cast<std::uint64_t>(arguments.number("--seed", 1));
  const std::string folder = arguments.text("--out");
  const int rounds = arguments.rounds(3);
  std::mt19937_64 random(seed);
  std::cout << "set,method,knob,edges,contacts,us,missed,false_alarms,undecided,lost,"
               "time_error_median,time_error_max\n";
  compare(closedForms(count, random), rounds, folder);
  compare(grazingEdges(count, random), rounds, folder);
  for (const std::string& file : arguments.texts("--problem"))
    compare(sceneEdges(file, count, seed), rounds, folder);
}

}  // namespace
}  // namespace corridor::bench

int main(int argc, char** argv) {
  return corridor::bench::runWith(argc, argv,
                                  {"--problem", "--edges", "--rounds", "--seed", "--cpu", "--out"},
                                  corridor::bench::runAll);
}
