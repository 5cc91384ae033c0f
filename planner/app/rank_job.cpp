#include "planner/app/rank_job.h"

#include <chrono>
#include <thread>

#include "planner/app/commands.h"
#include "planner/app/interrupt.h"

namespace corridor::app {

RankJob::RankJob(std::size_t jobs) : ranks_(joinRanks()) {
  if (ranks_ && ranks_->rank() == 0) executor_.emplace(*ranks_, jobs);
}

const std::atomic<bool>& RankJob::listen() const {
  return listenForInterrupts(ranks_ ? SecondInterrupt::isIgnored : SecondInterrupt::ends);
}

int RankJob::serve(const RankSetUp& setUp) {
  const std::atomic<bool>& interrupted = listen();
  serveRanks(*ranks_, setUp, [&] { return interrupted ? interruptedStatus() - 128 : 0; });
  return kDone;
}

void letRank0Report() {
  if (rankInEnvironment() > 0) std::this_thread::sleep_for(std::chrono::seconds(30));
}

}  // namespace corridor::app
