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
#include "planner/benchmark/child_process.h"
#include "planner/solve/planner_factory.h"

/// What a run would take if verdicts cost nothing: the run is made twice, in two processes, with
/// the same random numbers; the first records every answer of Corridor's checkers, the second gets
/// the recorded ones. So both do the same, to the last state, and what the second takes is the
/// planner's and the simplifier's own.
namespace corridor::bench {

/// What a run asked, and the answers, in order, as bytes. For one thread.
class Transcript {
 public:
  enum class Ask : char { state, clearance, motion, lastValid };

  /// Takes a question down, or compares it with the one in its place.
  /// @throws std::runtime_error where it is another one: kind, or a state in any bit.
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
                               " is not the one that was recorded");
    } else {
      at_ += scratch_.size();
    }
  }
  /// Takes an answer down as `compute` gives it; or the one recorded.
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
  /// The same of a state, as it stands there now; or written there.
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
  /// Everything recorded was asked.
  bool done() const { return recording_ || at_ == bytes_.size(); }

  /// @throws std::runtime_error where the file can't hold it.
  void write(std::FILE* file) const {
    if (std::fwrite(bytes_.data(), 1, bytes_.size(), file) != bytes_.size() ||
        std::fflush(file) != 0)
      throw std::runtime_error("replay: the record can't be written");
  }
  /// To be replayed.
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
  /// Records the answers of the checker that `si` has, or gives the recorded ones instead.
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
  /// As TranscriptStates. @pre it asks no validity checker of OMPL's itself.
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

/// Certified edges that are recorded, or replayed. @pre `transcript` outlives it.
inline BenchmarkPeer transcriptPeer(Transcript& transcript) {
  return {"replay",
          [&transcript](const auto& si, const Checker&) {
            return std::make_shared<TranscriptStates>(si, transcript);
          },
          [&transcript](const auto& si, const Checker&) {
            return std::make_shared<TranscriptMotions>(si, transcript);
          },
          "certified"};
}

/// The second of the two runs. Set-up (start and goals are tested) and the last certification are
/// done in full: BenchmarkRun::searchProcessorTime is without them. OMPL's own tests of the path,
/// outside of all times, are replayed, too.
/// @throws std::runtime_error for a planner that doesn't repeat, and where recording failed.
inline BenchmarkRun replayedRun(const Problem& planned, double memory, Path& path) {
  for (const PlannerInfo& info : knownPlanners())
    if (info.name == planned.planner.name && !info.repeats)
      throw std::runtime_error("replay: " + info.name + " doesn't repeat");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
  if (!file) throw std::runtime_error("replay: there can be no temporary file");
  // OMPL can be seeded once a process: this one is for the second run.
  const auto record = [&](const auto& send) {
    Transcript transcript;
    Path ignored;
    const BenchmarkRun run = runUnderOmpl(planned, transcriptPeer(transcript), memory, ignored);
    if (!run.failure.empty()) throw std::runtime_error(run.failure);
    // Maybe the time ran out, and when is nothing that repeats.
    if (!run.solved) throw std::runtime_error(run.why);
    transcript.write(file.get());
    send("done");
  };
  const ChildEnd recorded = inChild(record, {{2 * planned.planner.time + 60}, 0});
  if (!recorded.failure.empty()) throw std::runtime_error("recording: " + recorded.failure);
  Transcript transcript = Transcript::read(file.get());
  BenchmarkRun run = runUnderOmpl(planned, transcriptPeer(transcript), memory, path);
  if (run.failure.empty() && !transcript.done()) {
    run.failure = "replay: " + std::to_string(transcript.questions()) +
                  " questions were asked, and more were recorded";
    run.result = "failed";
    run.solved = run.certified = false;
  }
  return run;
}

inline BenchmarkPeer replayPeer() {
  return {"replay", nullptr, nullptr, "certified", replayedRun};
}

}  // namespace corridor::bench
