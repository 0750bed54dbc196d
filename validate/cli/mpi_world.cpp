#include "mpi_world.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "detp/sim/base/threads.hpp"
#include "detp/sim/ranks/mpi_ranks.hpp"
#include "mpi_bell.hpp"

namespace detp::cli {
namespace {

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
