#pragma once

#include <array>
#include <csignal>

namespace corridor {

/// The signals by which users, terminals and batch systems end a program. They may reach a whole
/// process group; the program that was called decides what they mean. SIGUSR1 counts in
/// `benchmark` and `solve` (planner/app/rank_job.h).
inline constexpr std::array kUserSignals{SIGINT, SIGTERM, SIGHUP, SIGUSR1};

}  // namespace corridor
