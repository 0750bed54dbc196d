#pragma once

#include <exception>
#include <stdexcept>
#include <string>

#include "ranks.hpp"

/// What fails on one rank fails on all.
namespace detp::sim {

/// Another rank failed; the message is its own.
class RankFailed : public std::runtime_error {
 public:
  RankFailed(int rank, const std::string& message)
      : std::runtime_error("rank " + std::to_string(rank) + ": " + message) {}
};

/// Every rank tells whether it failed, and hears of the others. Returns on all ranks if none failed. Else throws on all: `failed`
/// where it is set, on the other ranks RankFailed of the first that failed, or Stopped if none failed but some were stopped.
void agree(Ranks& ranks, const std::exception_ptr& failed);

/// Calls work(), which must not talk with other ranks, on this rank; then agrees.
template <class Work>
void do_on_all(Ranks& ranks, const Work& work) {
  std::exception_ptr failed;
  try {
    work();
  } catch (...) {
    failed = std::current_exception();
  }
  agree(ranks, failed);
}

}  // namespace detp::sim
