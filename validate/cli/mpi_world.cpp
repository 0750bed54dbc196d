#include <mpi.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include "detp/sim/base/threads.hpp"
#include "detp/sim/ranks/mpi_ranks.hpp"
#include "program.hpp"

namespace detp::cli {
namespace {

/// Tells all processes at once that one of them was stopped or failed: its own thread listens while the others are at work.
/// Needs MPI_THREAD_MULTIPLE.
class MpiBell {
 public:
  /// On all processes together. Tells the others of a request of `stop`. `heard` is called once, on another thread, if another rings.
  MpiBell(std::stop_token stop, std::function<void()> heard) : stop_(std::move(stop)), heard_(std::move(heard)) {
    MPI_Comm_dup(MPI_COMM_WORLD, &communicator_);
    MPI_Comm_set_errhandler(communicator_, MPI_ERRORS_RETURN);
    thread_ = std::jthread([this](const std::stop_token& end) { watch(end); });
  }

  void ring() { rung_ = true; }

 private:
  void watch(const std::stop_token& end) {
    constexpr auto pause = std::chrono::milliseconds(20);
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    bool known = false;  // to all
    while (!never.wait_for(lock, end, pause, [&] { return end.stop_requested(); })) {
      if (!known && (rung_ || stop_.stop_requested())) {
        known = true;
        tell_all();
      }
      if (!was_told() || std::exchange(known, true)) continue;
      heard_();
    }
  }

  void tell_all() const {
    int rank = 0;
    int count = 0;
    MPI_Comm_rank(communicator_, &rank);
    MPI_Comm_size(communicator_, &count);
    for (int to = 0; to < count; ++to) {
      if (to == rank) continue;
      MPI_Request request;
      if (MPI_Isend(nullptr, 0, MPI_BYTE, to, 0, communicator_, &request) == MPI_SUCCESS) MPI_Request_free(&request);
    }
  }

  [[nodiscard]] bool was_told() const {
    int found = 0;
    MPI_Status status;
    if (MPI_Iprobe(MPI_ANY_SOURCE, 0, communicator_, &found, &status) != MPI_SUCCESS || found == 0) return false;
    MPI_Recv(nullptr, 0, MPI_BYTE, status.MPI_SOURCE, 0, communicator_, MPI_STATUS_IGNORE);
    return true;
  }

  std::stop_token stop_;
  std::function<void()> heard_;
  std::atomic<bool> rung_ = false;
  MPI_Comm communicator_ = MPI_COMM_NULL;
  std::jthread thread_;
};

class MpiWorld final : public World {
 public:
  MpiWorld(const std::stop_token& by_signal, const std::function<void()>& stop)
      : may_ring_(initialize()), ranks_(MPI_COMM_WORLD, by_signal, [this] { ring(); }) {
    if (may_ring_) bell_.emplace(by_signal, stop);
    MPI_Comm machine;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    MPI_Comm_size(machine, &on_this_machine_);
    MPI_Comm_free(&machine);
  }

  [[nodiscard]] sim::Ranks& ranks() override { return ranks_; }

  [[nodiscard]] int cores() const override {
    const int all = static_cast<int>(std::thread::hardware_concurrency());
    return std::clamp(all / on_this_machine_, 1, sim::thread_count(0));
  }

  void end(const std::string& message, int code) override {
    if (!ranks_.end(message)) MPI_Abort(MPI_COMM_WORLD, code);
    bell_.reset();
    MPI_Finalize();
  }

 private:
  /// Returns whether several threads may call MPI.
  static bool initialize() {
    use_no_network_on_one_machine();
    int provided = 0;
    if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_MULTIPLE, &provided) != MPI_SUCCESS)
      throw std::runtime_error("MPI cannot be initialized");
    return provided == MPI_THREAD_MULTIPLE;
  }

  void ring() {
    if (bell_) bell_->ring();
  }

  /// Open MPI looks at network cards that match messages (its component cm) for 0.2 s. Between the processes of one
  /// machine it can do without them. What the user has set stays.
  static void use_no_network_on_one_machine() {
    const char* const all = std::getenv("OMPI_COMM_WORLD_SIZE");
    const char* const here = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
    if (all != nullptr && here != nullptr && std::string_view(all) == here) setenv("OMPI_MCA_pml", "^cm", 0);
  }

  bool may_ring_;
  sim::MpiRanks ranks_;
  std::optional<MpiBell> bell_;
  int on_this_machine_ = 1;
};

}  // namespace

std::unique_ptr<World> join_mpi(const std::stop_token& by_signal, const std::function<void()>& stop) {
  if (launched_processes() == 1) return nullptr;
  return std::make_unique<MpiWorld>(by_signal, stop);
}

}  // namespace detp::cli
