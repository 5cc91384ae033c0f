#pragma once

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>

#include "planner/benchmark/benchmark_run.h"
#include "planner/jobs/child_process.h"
#include "planner/solve/planner_factory.h"

/// Measures the time that a run would take if verdicts cost nothing. The run is made twice, in two
/// processes, with the same random numbers. The first run records every answer of Corridor's
/// checkers, and the second run gets the recorded answers. Both runs therefore visit the same
/// states. The search time of the second run is that of the planner and the simplifier alone, plus
/// the time for comparing the queries with the recorded ones.
namespace corridor::bench {

/// The queries of a run to the checkers, and the answers to them, in order, as bytes. Only one
/// thread may use the object.
class Transcript {
 public:
  enum class Ask : char { state, clearance, motion, lastValid };

  /// Records a query, or compares it with the next recorded query.
  /// @throws std::runtime_error if the two queries differ in kind, or in any bit of a state.
  void question(Ask ask, const ompl::base::SpaceInformation& si, const ompl::base::State* s1,
                const ompl::base::State* s2 = nullptr) {
    ++questions_;
    scratch_.assign(1, static_cast<char>(ask));
    for (const ompl::base::State* s : {s1, s2}) {
      if (!s) continue;
      const std::size_t old = scratch_.size();
      scratch_.resize(old + si.getStateSpace()->getSerializationLength());
      si.getStateSpace()->serialize(scratch_.data() + old, s);
    }
    if (recording_) {
      bytes_.insert(bytes_.end(), scratch_.begin(), scratch_.end());
    } else if (bytes_.size() - at_ < scratch_.size() ||
               std::memcmp(bytes_.data() + at_, scratch_.data(), scratch_.size()) != 0) {
      throw std::runtime_error("replay: question " + std::to_string(questions_) +
                               " differs from the recorded one");
    } else {
      at_ += scratch_.size();
    }
  }
  /// Records and returns the answer that `compute` gives, or returns the recorded answer.
  template <class Value, class Compute>
  Value answer(const Compute& compute) {
    Value value;
    if (recording_) {
      value = compute();
      const auto* bytes = reinterpret_cast<const char*>(&value);
      bytes_.insert(bytes_.end(), bytes, bytes + sizeof value);
    } else {
      std::memcpy(&value, take(sizeof value), sizeof value);
    }
    return value;
  }
  /// Handles an answer that is a state: records its present value, or overwrites it with the
  /// recorded one.
  void answer(const ompl::base::SpaceInformation& si, ompl::base::State* state) {
    const std::size_t size = si.getStateSpace()->getSerializationLength();
    if (recording_) {
      bytes_.resize(bytes_.size() + size);
      si.getStateSpace()->serialize(bytes_.data() + bytes_.size() - size, state);
    } else {
      si.getStateSpace()->deserialize(state, take(size));
    }
  }

  std::uint64_t questions() const { return questions_; }
  /// Whether the replay used the whole record.
  bool done() const { return recording_ || at_ == bytes_.size(); }

  /// @throws std::runtime_error if the file can't be written.
  void write(std::FILE* file) const {
    if (std::fwrite(bytes_.data(), 1, bytes_.size(), file) != bytes_.size() ||
        std::fflush(file) != 0)
      throw std::runtime_error("replay: the record can't be written");
  }
  /// Returns a transcript to be replayed.
  static Transcript read(std::FILE* file) {
    Transcript transcript;
    transcript.recording_ = false;
    std::rewind(file);
    char part[65536];
    while (const std::size_t n = std::fread(part, 1, sizeof part, file))
      transcript.bytes_.insert(transcript.bytes_.end(), part, part + n);
    return transcript;
  }

 private:
  const char* take(std::size_t size) {
    if (bytes_.size() - at_ < size) throw std::runtime_error("replay: the record ends early");
    at_ += size;
    return bytes_.data() + at_ - size;
  }

  bool recording_ = true;
  std::vector<char> bytes_, scratch_;
  std::size_t at_ = 0;
  std::uint64_t questions_ = 0;
};

class TranscriptStates final : public ompl::base::StateValidityChecker {
 public:
  /// Records the answers of the checker of `si`, or returns the recorded answers instead.
  /// @pre `transcript` outlives the object.
  TranscriptStates(const ompl::base::SpaceInformationPtr& si, Transcript& transcript)
      : StateValidityChecker(si), inner_(si->getStateValidityChecker()), transcript_(transcript) {
    specs_ = inner_->getSpecs();
  }
  bool isValid(const ompl::base::State* state) const override {
    transcript_.question(Transcript::Ask::state, *si_, state);
    return transcript_.answer<bool>([&] { return inner_->isValid(state); });
  }
  double clearance(const ompl::base::State* state) const override {
    transcript_.question(Transcript::Ask::clearance, *si_, state);
    return transcript_.answer<double>([&] { return inner_->clearance(state); });
  }

 private:
  ompl::base::StateValidityCheckerPtr inner_;
  Transcript& transcript_;
};

class TranscriptMotions final : public ompl::base::MotionValidator {
 public:
  /// Records the answers of the motion validator of `si`, or returns the recorded answers instead.
  /// @pre The motion validator of `si` doesn't use OMPL's validity checker.
  TranscriptMotions(const ompl::base::SpaceInformationPtr& si, Transcript& transcript)
      : MotionValidator(si), inner_(si->getMotionValidator()), transcript_(transcript) {}
  bool checkMotion(const ompl::base::State* s1, const ompl::base::State* s2) const override {
    transcript_.question(Transcript::Ask::motion, *si_, s1, s2);
    return transcript_.answer<bool>([&] { return inner_->checkMotion(s1, s2); });
  }
  bool checkMotion(const ompl::base::State* s1, const ompl::base::State* s2,
                   std::pair<ompl::base::State*, double>& lastValid) const override {
    transcript_.question(Transcript::Ask::lastValid, *si_, s1, s2);
    const bool valid =
        transcript_.answer<bool>([&] { return inner_->checkMotion(s1, s2, lastValid); });
    if (valid) return true;  // by contract, lastValid is untouched
    lastValid.second = transcript_.answer<double>([&] { return lastValid.second; });
    if (lastValid.first) transcript_.answer(*si_, lastValid.first);
    return false;
  }

 private:
  ompl::base::MotionValidatorPtr inner_;
  Transcript& transcript_;
};

/// Returns a competitor with certified edges, whose answers are recorded or replayed. @pre
/// `transcript` outlives the competitor.
inline BenchmarkCompetitor transcriptPeer(Transcript& transcript) {
  return {"replay",
          [&transcript](const auto& si, const Checker&) {
            return std::make_shared<TranscriptStates>(si, transcript);
          },
          [&transcript](const auto& si, const Checker&) {
            return std::make_shared<TranscriptMotions>(si, transcript);
          },
          "certified"};
}

/// Makes both runs and returns the second. Both runs do the set-up (which tests the start and the
/// goals) and the final certification in full; BenchmarkRun::searchProcessorTime excludes the
/// set-up and this certification. OMPL's own tests of the path are replayed, too, outside of all
/// measured times.
/// @throws std::runtime_error for a planner whose runs don't repeat, or if recording failed.
inline BenchmarkRun replayedRun(const Problem& planned, double memory, Path& path) {
  for (const PlannerInfo& info : knownPlanners())
    if (info.name == planned.settings.planner.name && !info.repeatable)
      throw std::runtime_error("replay: " + info.name + " doesn't repeat");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
  if (!file) throw std::runtime_error("replay: a temporary file can't be created");
  // The first run gets a process of its own, so that both runs begin with fresh generators of
  // random numbers.
  const auto record = [&](const auto& send) {
    Transcript transcript;
    Path ignored;
    const BenchmarkRun run = runUnderOmpl(planned, "", transcriptPeer(transcript), memory, ignored);
    if (!run.failure.empty()) throw std::runtime_error(run.failure);
    // If the time ran out, the run can't be replayed: the moment at which it runs out does not
    // repeat.
    if (!run.solved) throw std::runtime_error(run.why);
    transcript.write(file.get());
    send("done");
  };
  const ChildEnd recorded = inChild(record, {{2 * planned.settings.planner.time + 60}, 0});
  if (!recorded.failure.empty()) throw std::runtime_error("recording: " + recorded.failure);
  Transcript transcript = Transcript::read(file.get());
  BenchmarkRun run = runUnderOmpl(planned, "", transcriptPeer(transcript), memory, path);
  if (run.failure.empty() && !transcript.done()) {
    run.failure = "replay: " + std::to_string(transcript.questions()) +
                  " questions were asked, and more were recorded";
    run.result = "failed";
    run.solved = run.certified = false;
  }
  return run;
}

inline BenchmarkCompetitor replayPeer() {
  return {"replay", nullptr, nullptr, "certified", replayedRun};
}

}  // namespace corridor::bench
