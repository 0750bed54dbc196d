#pragma once

#include <mpi.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

namespace detp::cli {

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

}  // namespace detp::cli
