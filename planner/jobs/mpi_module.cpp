// A shared library that is opened under `mpirun` (ranks.h). It uses only code of Corridor that is
// in headers, because it does not link Corridor's libraries.
#include <list>
#include <utility>
#include <vector>

#include <boost/mpi/communicator.hpp>
#include <boost/mpi/environment.hpp>

#include "planner/jobs/ranks.h"

namespace {

namespace mpi = boost::mpi;

constexpr int kTag = 0;

class MpiRanks final : public corridor::Ranks {
 public:
  // Other threads of this process, if there are any, don't call MPI.
  MpiRanks() : environment_(mpi::threading::funneled, false) {}
  ~MpiRanks() override {
    for (Sending& one : sending_) one.request.wait();
  }

  int rank() const override { return world_.rank(); }
  int size() const override { return world_.size(); }
  void send(int to, std::string text) override {
    // The text is sent as bytes, because Boost sends an array of bytes as one MPI message.
    Sending& one = sending_.emplace_back();
    one.text = std::move(text);
    one.request = world_.isend(to, kTag, one.text.data(), static_cast<int>(one.text.size()));
    clear();
  }
  std::optional<corridor::RankMessage> receive() override {
    clear();
    auto status = world_.iprobe(mpi::any_source, kTag);
    // A call of iprobe first searches Open MPI's queue, and only then fetches new messages into
    // this queue. So only a second call finds a message that has just arrived. With a single call,
    // each message would be found only after one more pause of the caller.
    if (!status) status = world_.iprobe(mpi::any_source, kTag);
    if (!status) return std::nullopt;
    corridor::RankMessage message{status->source(), std::string(bytesOf(*status), '\0')};
    world_.recv(message.from, kTag, message.text.data(), static_cast<int>(message.text.size()));
    return message;
  }

 private:
  struct Sending {
    std::string text;
    mpi::request request;
  };

  static std::size_t bytesOf(const mpi::status& status) {
    return static_cast<std::size_t>(status.count<char>().value_or(0));
  }
  /// Removes the texts that MPI has finished sending.
  void clear() {
    std::erase_if(sending_, [](Sending& one) { return one.request.test().has_value(); });
  }

  mpi::environment environment_;
  mpi::communicator world_;
  std::list<Sending> sending_;  // a text must stay until MPI has sent it
};

}  // namespace

corridor::Ranks* corridor::corridorRanks() {
  return std::make_unique<MpiRanks>().release();
}
