#pragma once

#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include "failures.hpp"

/// The processes of an MPI communicator. Only programs that use MPI include this file; detp does not link it.
namespace detp::sim {

/// Waits without taking a core's time. Not for several threads at once.
class MpiRanks final : public Ranks {
 public:
  /// The communicator must outlive the object; use one for it alone (MPI_Comm_dup). After a stop request, another rank that is silent
  /// for so many seconds is given up: RankSilent. `alert`: requests a stop on the other ranks, if the program has means to do so while they
  /// are at work.
  explicit MpiRanks(MPI_Comm communicator, std::stop_token stop = {}, std::function<void()> alert = {},
                    double patience = 0.5)
      : communicator_(communicator), stop_(std::move(stop)), alert_(std::move(alert)), patience_(patience) {
    check(MPI_Comm_set_errhandler(communicator_, MPI_ERRORS_RETURN));
    check(MPI_Comm_rank(communicator_, &rank_));
    check(MPI_Comm_size(communicator_, &count_));
  }

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int count() const override { return count_; }

  void alert() override {
    if (alert_) alert_();
  }

  void send(std::span<const std::byte> bytes, int to) override {
    for (; !bytes.empty(); bytes = bytes.subspan(size_of_next(bytes.size()))) {
      MPI_Request request;
      check(MPI_Isend(bytes.data(), static_cast<int>(size_of_next(bytes.size())), MPI_BYTE, to, data, communicator_,
                      &request));
      wait(request, to);
    }
  }

  void receive(std::span<std::byte> bytes, int from) override {
    for (; !bytes.empty(); bytes = bytes.subspan(size_of_next(bytes.size()))) {
      MPI_Request request;
      check(MPI_Irecv(bytes.data(), static_cast<int>(size_of_next(bytes.size())), MPI_BYTE, from, data, communicator_,
                      &request));
      wait(request, from);
    }
  }

  /// The last call on each rank. `message`: why this rank failed; empty if it did not. Another rank that is waiting throws RankFailed with
  /// the message. Returns true when all have called this; false on rank 0 if another is given up.
  [[nodiscard]] bool end(const std::string& message) {
    try {
      for (int other = 0; other < count_; ++other)
        if (is_partner(other)) send_last(message, other);
      for (int other = 0; other < count_; ++other)
        if (is_partner(other)) wait_until([&] { return ended(other); }, other, [] {});
      return true;
    } catch (const RankSilent&) {
      return rank_ != 0;  // rank 0 may still be writing
    }
  }

 private:
  static constexpr int data = 0;  // tags
  static constexpr int last = 1;  // of a rank's last message

  /// MPI counts in int; and a large message must not look like silence.
  static std::size_t size_of_next(std::size_t bytes) { return std::min(bytes, std::size_t{1} << 26); }

  static void check(int code) {
    if (code == MPI_SUCCESS) return;
    char text[MPI_MAX_ERROR_STRING];
    int length = 0;
    MPI_Error_string(code, text, &length);
    throw std::runtime_error("MPI: " + std::string(text, static_cast<std::size_t>(length)));
  }

  using Clock = std::chrono::steady_clock;

  /// Rank 0 talks with all, the others with rank 0 alone.
  [[nodiscard]] bool is_partner(int other) const { return other != rank_ && (rank_ == 0 || other == 0); }

  void send_last(const std::string& message, int to) {
    MPI_Request request;
    check(MPI_Isend(message.data(), static_cast<int>(size_of_next(message.size())), MPI_BYTE, to, last, communicator_,
                    &request));
    check(MPI_Request_free(&request));  // short; a rank that has died receives nothing
  }

  void wait(MPI_Request& request, int other) {
    const auto arrived = [&] {
      int done = 0;
      check(MPI_Test(&request, &done, MPI_STATUS_IGNORE));
      return done != 0;
    };
    const auto watch = [&] {
      for (int one = 0; one < count_; ++one) {
        if (!is_partner(one) || !ended(one) || (messages_[one]->empty() && one != other)) continue;
        if (arrived()) return;  // what it sent before
        throw RankFailed(one, messages_[one]->empty() ? "ended before the others" : *messages_[one]);
      }
    };
    try {
      wait_until(arrived, other, watch);
    } catch (...) {  // nothing may be written to the caller's bytes any more
      MPI_Cancel(&request);
      MPI_Request_free(&request);
      throw;
    }
  }

  /// Tests again and again, less and less often. `watch` is called between tests.
  template <class Done, class Watch>
  void wait_until(const Done& done, int other, const Watch& watch) {
    constexpr auto often = std::chrono::microseconds(200);
    constexpr auto longest = std::chrono::microseconds(1000);
    const double patience = rank_ == 0 ? patience_ : 1.5 * patience_;  // rank 0 knows who is silent
    const Clock::time_point begin = Clock::now();
    Clock::time_point stopped{};
    while (!done()) {
      const Clock::time_point now = Clock::now();
      watch();
      if (stop_.stop_requested() && stopped == Clock::time_point{}) stopped = now;
      if (stopped != Clock::time_point{} && std::chrono::duration<double>(now - stopped).count() > patience)
        throw RankSilent(other);
      if (now - begin < often)
        std::this_thread::yield();
      else
        std::this_thread::sleep_for(std::min<Clock::duration>((now - begin) / 16, longest));
    }
  }

  /// Whether the rank's last message has come.
  bool ended(int other) {
    std::optional<std::string>& message = messages_[other];
    if (message) return true;
    int found = 0;
    MPI_Status status;
    check(MPI_Iprobe(other, last, communicator_, &found, &status));
    if (found == 0) return false;
    int size = 0;
    check(MPI_Get_count(&status, MPI_BYTE, &size));
    message.emplace(static_cast<std::size_t>(size), ' ');
    check(MPI_Recv(message->data(), size, MPI_BYTE, other, last, communicator_, MPI_STATUS_IGNORE));
    return true;
  }

  MPI_Comm communicator_;
  std::stop_token stop_;
  std::function<void()> alert_;
  double patience_;
  std::map<int, std::optional<std::string>> messages_;  ///< the last of each rank
  int rank_ = 0;
  int count_ = 1;
};

}  // namespace detp::sim
