#pragma once

#include <array>
#include <csignal>

namespace corridor {

/// The signals by which users, terminals and batch systems end a program. They may reach every
/// process of a group. Child processes ignore them; the process that the user started decides what
/// they mean. Batch systems can send SIGUSR1, which `mpirun` hands on to all ranks without killing
/// them.
inline constexpr std::array kUserSignals{SIGINT, SIGTERM, SIGHUP, SIGUSR1};

}  // namespace corridor
