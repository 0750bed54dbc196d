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

/// Another rank is silent: it may have died.
class RankSilent final : public RankFailed {
 public:
  explicit RankSilent(int rank) : RankFailed(rank, "does not answer; it may have died") {}
};

/// Every rank tells whether it failed, and hears of the others. Returns on all ranks if none failed. Else throws on all: what failed where
/// it did, on the other ranks RankFailed of the first that failed, or Stopped if none failed but some were stopped.
void agree(Ranks& ranks, const std::exception_ptr& failed);

/// Whether it is Stopped.
[[nodiscard]] bool is_stop(const std::exception_ptr& thrown);

/// Calls work(), which must not talk with other ranks, on this rank; then agrees.
template <class Work>
void do_on_all(Ranks& ranks, const Work& work) {
  std::exception_ptr failed;
  try {
    work();
  } catch (...) {
    failed = std::current_exception();
    if (!is_stop(failed)) ranks.alert();
  }
  agree(ranks, failed);
}

/// Calls make() on rank 0 alone, then agrees. Returns its text on all ranks.
template <class Make>
std::string from_first(Ranks& ranks, const Make& make) {
  std::string text;
  do_on_all(ranks, [&] {
    if (ranks.rank() == 0) text = make();
  });
  if (ranks.rank() == 0) {
    for (int to = 1; to < ranks.count(); ++to) send_text(ranks, text, to);
    return text;
  }
  return receive_text(ranks, 0);
}

}  // namespace detp::sim
