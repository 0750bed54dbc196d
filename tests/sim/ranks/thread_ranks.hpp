#pragma once

#include <condition_variable>
#include <cstring>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include "detp/sim/ranks/ranks.hpp"

/// Ranks that are threads of one process.
namespace detp::sim {

/// Letters between the threads.
class Post {
 public:
  void put(std::pair<int, int> from_to, std::vector<std::byte> letter) {
    const std::lock_guard lock(mutex_);
    letters_[from_to].push_back(std::move(letter));
    came_.notify_all();
  }
  std::vector<std::byte> take(std::pair<int, int> from_to) {
    std::unique_lock lock(mutex_);
    came_.wait(lock, [&] { return !letters_[from_to].empty(); });
    std::vector<std::byte> letter = std::move(letters_[from_to].front());
    letters_[from_to].pop_front();
    return letter;
  }

  std::stop_source alerted;

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  std::map<std::pair<int, int>, std::deque<std::vector<std::byte>>> letters_;
};

class ThreadRank final : public Ranks {
 public:
  ThreadRank(Post& post, int rank, int count) : post_(post), rank_(rank), count_(count) {}
  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int count() const override { return count_; }
  void alert() override { post_.alerted.request_stop(); }
  [[nodiscard]] std::stop_token alerted() const { return post_.alerted.get_token(); }
  void send(std::span<const std::byte> bytes, int to) override { post_.put({rank_, to}, {bytes.begin(), bytes.end()}); }
  void receive(std::span<std::byte> bytes, int from) override {
    const std::vector<std::byte> letter = post_.take({from, rank_});
    if (letter.size() != bytes.size()) throw std::logic_error("a letter of another size");
    std::memcpy(bytes.data(), letter.data(), bytes.size());
  }

 private:
  Post& post_;
  int rank_;
  int count_;
};

/// Calls work(ranks) on so many ranks, and returns what each threw.
template <class Work>
[[nodiscard]] std::vector<std::exception_ptr> on_ranks(int count, const Work& work) {
  Post post;
  std::vector<std::exception_ptr> thrown(static_cast<std::size_t>(count));
  std::vector<std::jthread> threads;
  for (int rank = 0; rank < count; ++rank)
    threads.emplace_back([&, rank] {
      ThreadRank ranks(post, rank, count);
      try {
        work(ranks);
      } catch (...) {
        thrown[static_cast<std::size_t>(rank)] = std::current_exception();
      }
    });
  threads.clear();  // waits
  return thrown;
}

}  // namespace detp::sim
