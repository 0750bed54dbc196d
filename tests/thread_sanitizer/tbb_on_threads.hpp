#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

/// The part of oneTBB that the project uses, implemented with std::thread, for the preset `thread` only.
/// ThreadSanitizer understands how std::thread orders work. With oneTBB's own library, which is not instrumented, it
/// would report races that do not exist. Every loop starts threads of its own.
namespace tbb {
namespace detail {

inline std::atomic<int> limit = 4;        ///< set by global_control
inline thread_local int concurrency = 0;  ///< of the arena; 0: limited only by `limit`
inline thread_local int depth = 0;        ///< nesting depth of loops: inner loops run on one thread

inline int threads_here() { return std::min<int>(limit, concurrency > 0 ? concurrency : static_cast<int>(limit)); }

/// Calls work(i) for i = 0 … threads - 1, each on its own thread. Rethrows one of the exceptions thrown.
template <class Work>
void on_each(int threads, const Work& work) {
  std::exception_ptr thrown;
  std::mutex mutex;
  const auto guarded = [&](int i) {
    try {
      work(i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!thrown) thrown = std::current_exception();
    }
  };
  std::vector<std::thread> others;
  for (int i = 1; i < threads; ++i)
    others.emplace_back([&, i, inherited = concurrency, inner = depth + 1] {
      concurrency = inherited;
      depth = inner;
      guarded(i);
    });
  ++depth;
  guarded(0);
  --depth;
  for (std::thread& other : others) other.join();
  if (thrown) std::rethrow_exception(thrown);
}

/// Calls visit(i) for i = 0 … count - 1. Each thread takes the next i when it is free.
template <class Visit>
void share(std::size_t count, const Visit& visit) {
  constexpr int deepest = 2;
  const int threads = depth < deepest ? static_cast<int>(std::min<std::size_t>(count, threads_here())) : 1;
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> failed = false;
  on_each(std::max(1, threads), [&](int) {
    try {
      for (std::size_t i = next++; i < count && !failed; i = next++) visit(i);
    } catch (...) {
      failed = true;
      throw;
    }
  });
}

}  // namespace detail

template <class T>
class blocked_range {
 public:
  blocked_range(T begin, T end, std::size_t grain = 1) : begin_(begin), end_(end), grain_(grain) {}
  [[nodiscard]] T begin() const { return begin_; }
  [[nodiscard]] T end() const { return end_; }
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(end_ - begin_); }
  [[nodiscard]] bool empty() const { return !(begin_ < end_); }

  /// Number of pieces of the grain's size.
  [[nodiscard]] std::size_t pieces() const { return (size() + grain_ - 1) / grain_; }
  [[nodiscard]] blocked_range piece(std::size_t i) const {
    const T first = begin_ + static_cast<T>(i * grain_);
    return {first, first + static_cast<T>(std::min(grain_, static_cast<std::size_t>(end_ - first))), grain_};
  }

 private:
  T begin_, end_;
  std::size_t grain_;
};

template <class T, class Body>
void parallel_for(const blocked_range<T>& range, const Body& body) {
  detail::share(range.pieces(), [&](std::size_t i) { body(range.piece(i)); });
}

template <class First, class Last, class Body>
void parallel_for(First first, Last last, const Body& body) {
  const auto begin = static_cast<Last>(first);
  if (begin < last)
    detail::share(static_cast<std::size_t>(last - begin), [&](std::size_t i) { body(begin + static_cast<Last>(i)); });
}

template <class T, class Value, class Body, class Join>
Value parallel_reduce(const blocked_range<T>& range, const Value& identity, const Body& body, const Join& join) {
  std::vector<Value> parts(range.pieces(), identity);
  detail::share(parts.size(), [&](std::size_t i) { parts[i] = body(range.piece(i), identity); });
  Value all = identity;
  for (const Value& part : parts) all = join(all, part);
  return all;
}

template <class... Work>
void parallel_invoke(const Work&... work) {
  const std::vector<std::function<void()>> all{work...};
  detail::share(all.size(), [&](std::size_t i) { all[i](); });
}

template <class T>
class enumerable_thread_specific {
 public:
  enumerable_thread_specific() : make_([] { return T(); }) {}
  template <class Make>
  requires std::is_invocable_v<const Make&>
  explicit enumerable_thread_specific(const Make& make) : make_(make) {}
  explicit enumerable_thread_specific(const T& exemplar) requires std::is_copy_constructible_v<T>
      : make_([exemplar] { return exemplar; }) {}

  T& local() {
    const std::lock_guard lock(mutex_);
    const auto mine = std::find(owners_.begin(), owners_.end(), std::this_thread::get_id());
    if (mine != owners_.end()) return all_[static_cast<std::size_t>(mine - owners_.begin())];
    owners_.push_back(std::this_thread::get_id());
    return all_.emplace_back(make_());
  }
  [[nodiscard]] auto begin() { return all_.begin(); }
  [[nodiscard]] auto end() { return all_.end(); }
  [[nodiscard]] auto begin() const { return all_.begin(); }
  [[nodiscard]] auto end() const { return all_.end(); }
  [[nodiscard]] std::size_t size() const { return all_.size(); }

 private:
  std::function<T()> make_;
  std::mutex mutex_;
  std::vector<std::thread::id> owners_;
  std::deque<T> all_;
};

class global_control {
 public:
  enum parameter { max_allowed_parallelism };
  global_control(parameter, std::size_t most) : before_(detail::limit.exchange(static_cast<int>(most))) {}
  ~global_control() { detail::limit = before_; }
  global_control(const global_control&) = delete;
  global_control& operator=(const global_control&) = delete;
  static std::size_t active_value(parameter) { return static_cast<std::size_t>(detail::limit.load()); }

 private:
  int before_;
};

class task_arena {
 public:
  explicit task_arena(int threads) : threads_(threads) {}
  template <class Work>
  void execute(const Work& work) {
    const int before = std::exchange(detail::concurrency, threads_);
    try {
      work();
    } catch (...) {
      detail::concurrency = before;
      throw;
    }
    detail::concurrency = before;
  }

 private:
  int threads_;
};

namespace this_task_arena {
inline int max_concurrency() { return detail::threads_here(); }
template <class Work>
void isolate(const Work& work) {
  work();
}
}  // namespace this_task_arena

class flow_control {
 public:
  void stop() { stopped = true; }
  bool stopped = false;
};

enum class filter_mode { parallel, serial_in_order };

/// A pipeline with exactly three stages: cut, in order; search, on any thread; add up, in order.
template <class Cut, class Search, class Add>
struct Pipeline {
  Cut cut;
  Search search;
  Add add;
};

template <class In, class Out, class Stage>
struct Filter {
  Stage stage;
};

template <class In, class Out, class Stage>
Filter<In, Out, Stage> make_filter(filter_mode, const Stage& stage) {
  return {stage};
}

template <class A, class B, class S, class T>
auto operator&(const Filter<void, A, S>& cut, const Filter<A, B, T>& search) {
  return std::pair(cut, search);
}

template <class A, class B, class S, class T, class U>
auto operator&(const std::pair<Filter<void, A, S>, Filter<A, B, T>>& before, const Filter<B, void, U>& add) {
  return Pipeline<S, T, U>{before.first.stage, before.second.stage, add.stage};
}

/// Keeps as many items in flight as there are threads, at most `most`.
template <class Cut, class Search, class Add>
void parallel_pipeline(std::size_t most, const Pipeline<Cut, Search, Add>& stages) {
  std::mutex cutting;
  std::mutex adding;
  std::condition_variable turn;
  flow_control flow;
  std::size_t cut = 0;
  std::size_t added = 0;
  bool failed = false;
  const int threads = static_cast<int>(std::min<std::size_t>(most, detail::threads_here()));
  detail::on_each(std::max(1, threads), [&](int) {
    try {
      for (;;) {
        std::unique_lock cut_lock(cutting);
        if (flow.stopped) return;
        const auto item = stages.cut(flow);
        if (flow.stopped) return;
        const std::size_t number = cut++;
        cut_lock.unlock();
        const auto found = stages.search(item);
        std::unique_lock add_lock(adding);
        turn.wait(add_lock, [&] { return failed || added == number; });
        if (failed) return;
        stages.add(found);
        ++added;
        turn.notify_all();
      }
    } catch (...) {
      const std::scoped_lock both(cutting, adding);
      flow.stopped = failed = true;
      turn.notify_all();
      throw;
    }
  });
}

}  // namespace tbb

namespace oneapi {
namespace tbb = ::tbb;
}
