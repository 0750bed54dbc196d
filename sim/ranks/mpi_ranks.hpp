#pragma once

#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <string>

#include "ranks.hpp"

/// The processes of an MPI communicator. Only programs that use MPI include this file; detp does not link it.
namespace detp::sim {

class MpiRanks final : public Ranks {
 public:
  /// The communicator must outlive the object; use one for it alone (MPI_Comm_dup).
  explicit MpiRanks(MPI_Comm communicator) : communicator_(communicator) {
    check(MPI_Comm_set_errhandler(communicator_, MPI_ERRORS_RETURN));
    check(MPI_Comm_rank(communicator_, &rank_));
    check(MPI_Comm_size(communicator_, &count_));
  }

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int count() const override { return count_; }

  void send(std::span<const std::byte> bytes, int to) override {
    for (; !bytes.empty(); bytes = bytes.subspan(size_of_next(bytes.size())))
      check(MPI_Send(bytes.data(), static_cast<int>(size_of_next(bytes.size())), MPI_BYTE, to, tag, communicator_));
  }

  void receive(std::span<std::byte> bytes, int from) override {
    for (; !bytes.empty(); bytes = bytes.subspan(size_of_next(bytes.size())))
      check(MPI_Recv(bytes.data(), static_cast<int>(size_of_next(bytes.size())), MPI_BYTE, from, tag, communicator_,
                     MPI_STATUS_IGNORE));
  }

 private:
  static constexpr int tag = 0;

  /// MPI counts in int.
  static std::size_t size_of_next(std::size_t bytes) { return std::min(bytes, std::size_t{1} << 30); }

  static void check(int code) {
    if (code == MPI_SUCCESS) return;
    char text[MPI_MAX_ERROR_STRING];
    int length = 0;
    MPI_Error_string(code, text, &length);
    throw std::runtime_error("MPI: " + std::string(text, static_cast<std::size_t>(length)));
  }

  MPI_Comm communicator_;
  int rank_ = 0;
  int count_ = 1;
};

}  // namespace detp::sim
