#include "planner/jobs/rank_executor.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <csignal>
#include <exception>
#include <stdexcept>
#include <thread>
#include <unistd.h>

#include "collision/core/error.h"

namespace corridor {
namespace {

using RankClock = std::chrono::steady_clock;
using std::chrono::microseconds;

constexpr microseconds kLeastPause{50}, kLongestPause{2000};
/// The longest time, in milliseconds, between two polls of a rank for messages while a task is
/// under way.
constexpr int kBusyPollMs = 5;
/// Milliseconds of one call of `wait` while the other ranks set up.
constexpr int kSetUpPollMs = 100;
/// The longest time, in seconds, that rank 0 waits for the other ranks at the end. Rank 0 waits so
/// long only if a rank has died, or is still setting up after an interrupt.
constexpr double kFarewell = 30;

// The first byte of each message from rank 0 to another rank:
constexpr char kSetUp = 'u';  ///< followed by the text of the set-up
constexpr char kTask = 't';   ///< followed by the task's number
constexpr char kStop = 's', kEnd = 'e';
// The first byte of each message to rank 0:
/// Followed by the task's number, the count of its messages, its failure, and its last message.
constexpr char kDone = 'd';
constexpr char kKilled = 'k';  ///< followed by the task's number
constexpr char kReady = 'r';   ///< the rank is set up
constexpr char kSignal = 'i';  ///< followed by the signal's number
constexpr char kFault = 'f';   ///< followed by the fault's text
constexpr char kBye = 'b';     ///< the last message of a rank

/// Pauses of the calling thread, each twice as long as the one before up to kLongestPause, until
/// `reset`.
class Pause {
 public:
  void operator()() {
    std::this_thread::sleep_for(length_);  // a signal does not shorten it
    length_ = std::min(2 * length_, kLongestPause);
  }
  void reset() { length_ = kLeastPause; }

 private:
  microseconds length_ = kLeastPause;
};

[[noreturn]] void notUnderstood(const std::string& text) {
  throw std::logic_error("a message between ranks is not understood: " + text.substr(0, 80));
}

/// Reads a number at the position `at` of the text, and moves `at` behind the number.
std::uint64_t rankNumberAt(const std::string& text, std::size_t& at) {
  std::uint64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + at, end, number);
  if (read.ec != std::errc{}) notUnderstood(text);
  at = static_cast<std::size_t>(read.ptr - text.data());
  return number;
}
std::uint64_t rankNumberIn(const std::string& text) {
  std::size_t at = 1;
  return rankNumberAt(text, at);
}

/// Returns the message for the end of a task, "d17 2 FAILURE\nMESSAGE": task 17 sent 2 messages, of
/// which MESSAGE is the last. Line breaks of the failure become blanks.
std::string textOf(const TaskEnd& one) {
  const std::vector<std::string>& messages = one.end.messages;
  std::string failure = one.end.failure;
  std::replace(failure.begin(), failure.end(), '\n', ' ');
  return kDone + std::to_string(one.task) + " " + std::to_string(messages.size()) + " " + failure +
         "\n" + (messages.empty() ? "" : messages.back());
}
TaskEnd taskEnd(const std::string& text) {
  TaskEnd one;
  std::size_t at = 1;
  one.task = rankNumberAt(text, at);
  one.end.messages.resize(rankNumberAt(text, ++at));
  const auto line = text.find('\n', at);
  if (line == std::string::npos) notUnderstood(text);
  one.end.failure = text.substr(at + 1, line - at - 1);
  if (!one.end.messages.empty()) one.end.messages.back() = text.substr(line + 1);
  return one;
}

std::string hostOfRank() {
  char name[256] = "";
  ::gethostname(name, sizeof name - 1);
  return name;
}

}  // namespace

RankExecutor::RankExecutor(Ranks& ranks, std::size_t jobs)
    : ranks_(ranks), places_(jobs * static_cast<std::size_t>(ranks.size() - 1)) {
  for (std::size_t job = 0; job < jobs; ++job)
    for (int rank = 1; rank < ranks.size(); ++rank) free_.push_back(rank);
}

RankExecutor::~RankExecutor() {
  try {
    for (int rank = 1; rank < ranks_.size(); ++rank) sendTo(rank, {kEnd});
    // All messages of the other ranks must be received before MPI ends.
    int waiting = ranks_.size() - 1;
    Pause pause;
    const auto begun = RankClock::now();
    while (waiting > 0 &&
           std::chrono::duration<double>(RankClock::now() - begun).count() < kFarewell)
      if (const auto message = ranks_.receive())
        waiting -= message->text[0] == kBye;
      else
        pause();
  } catch (const std::exception&) {
    // A rank died, and `mpirun` is about to end this process.
  }
}

void RankExecutor::sendTo(int rank, std::string text) {
  ++messages_;
  ranks_.send(rank, std::move(text));
}

void RankExecutor::begin(const std::string& setUp, const std::atomic<bool>& interrupted) {
  for (int rank = 1; rank < ranks_.size(); ++rank) sendTo(rank, kSetUp + setUp);
  while (ready_ < ranks_.size() - 1 && !interrupted) wait(kSetUpPollMs);
}

bool RankExecutor::start(std::uint64_t task) {
  sendTo(free_.front(), kTask + std::to_string(task));
  free_.pop_front();
  ++underWay_;
  return true;
}

std::vector<TaskEnd> RankExecutor::wait(int milliseconds) {
  const auto until = RankClock::now() + std::chrono::milliseconds(milliseconds);
  std::vector<TaskEnd> ends;
  Pause pause;
  for (;;) {
    bool any = false;
    while (auto message = ranks_.receive()) take(std::move(*message), ends), any = true;
    // If tasks ended before a fault was reported, this call returns them, and the next call throws.
    if (fault_ && ends.empty()) throw InputError(*fault_);
    if (any || RankClock::now() >= until) return ends;
    pause();
  }
}

void RankExecutor::take(RankMessage message, std::vector<TaskEnd>& ends) {
  ++messages_;
  switch (message.text[0]) {
    case kDone:
      ends.push_back(taskEnd(message.text));
      [[fallthrough]];
    case kKilled:
      free_.push_back(message.from);
      --underWay_;
      return;
    case kReady:
      ++ready_;
      return;
    case kSignal:
      std::raise(static_cast<int>(rankNumberIn(message.text)));
      return;
    case kFault:
      if (!fault_)
        fault_ = Fault{"rank " + std::to_string(message.from), 0, message.text.substr(1)};
      return;
    default:
      notUnderstood(message.text);
  }
}

std::vector<std::uint64_t> RankExecutor::stop() {
  for (int rank = 1; rank < ranks_.size(); ++rank) sendTo(rank, {kStop});
  return {};
}

void serveRanks(Ranks& ranks, const RankSetUp& setUp, const std::function<int()>& signal) {
  std::unique_ptr<Executor> executor;
  std::deque<std::uint64_t> waiting;  // tasks for which the system has no process yet
  bool faulty = false, reported = false;
  Pause pause;
  const auto fail = [&](const std::string& why) {
    if (!faulty) ranks.send(0, kFault + hostOfRank() + ": " + why);
    faulty = true;
    waiting.clear();
  };
  const auto guarded = [&](const auto& step) {
    try {
      step();
    } catch (const std::exception& error) {
      fail(error.what());
    }
  };
  for (;;) {
    while (const auto message = ranks.receive()) {
      pause.reset();
      const std::string& text = message->text;
      if (text[0] == kEnd) {
        executor.reset();  // kills the tasks that are under way
        ranks.send(0, {kBye});
        return;
      }
      if (text[0] == kSetUp)
        guarded([&] {
          executor = setUp(text.substr(1));
          ranks.send(0, {kReady});
        });
      if (text[0] == kTask && executor) waiting.push_back(rankNumberIn(text));
      if (text[0] == kStop && executor) {
        std::vector<std::uint64_t> killed = executor->stop();
        killed.insert(killed.end(), waiting.begin(), waiting.end());
        waiting.clear();
        for (const std::uint64_t task : killed) ranks.send(0, kKilled + std::to_string(task));
      }
    }
    if (const int number = signal(); number != 0 && !reported) {
      ranks.send(0, kSignal + std::to_string(number));
      reported = true;
    }
    guarded([&] {
      while (!waiting.empty() && executor->start(waiting.front())) waiting.pop_front();
    });
    if (executor && executor->underWay() > 0) {
      for (const TaskEnd& one : executor->wait(kBusyPollMs))
        ranks.send(0, textOf(one)), pause.reset();
    } else {
      pause();
    }
  }
}

}  // namespace corridor
