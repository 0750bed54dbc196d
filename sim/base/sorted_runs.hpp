#pragma once

#include <algorithm>
#include <cstdint>
#include <queue>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "spill_file.hpp"

namespace detp::sim {

/// Sorted runs of records, which need not fit in memory (SpillFile). A reader merges them. Records are trivially copyable and have operator<.
template <class Record>
class SortedRuns {
  static_assert(std::is_trivially_copyable_v<Record>);

 public:
  [[nodiscard]] std::uint64_t size() const { return file_.size() / sizeof(Record); }
  /// Records that are appended next belong to another run.
  void begin_run() {
    if (starts_.empty() || starts_.back() != size()) starts_.push_back(size());
  }
  /// Records that follow those of the run in order. Throws as SpillFile.
  void append(std::span<const Record> next) { file_.append(std::as_bytes(next)); }

  /// Reads all records in order. The runs must not change meanwhile. Throws as SpillFile.
  class Reader {
   public:
    explicit Reader(const SortedRuns& runs)
        : runs_(runs),
          at_once_(std::clamp<std::size_t>(most_bytes / sizeof(Record) / std::max<std::size_t>(1, runs.starts_.size()),
                                           16, std::size_t{1} << 10)) {
      for (std::size_t i = 0; i < runs.starts_.size(); ++i) {
        const std::uint64_t end = i + 1 < runs.starts_.size() ? runs.starts_[i + 1] : runs.size();
        cursors_.push_back({runs.starts_[i], end, {}, 0});
        take_from(i);
      }
    }

    /// False after the last record.
    [[nodiscard]] bool next(Record& record) {
      if (first_.empty()) return false;
      const auto [least, run] = first_.top();
      first_.pop();
      record = least;
      take_from(run);
      return true;
    }

   private:
    static constexpr std::size_t most_bytes = std::size_t{1} << 22;  // of all runs, unless there are very many

    struct Cursor {
      std::uint64_t next;
      std::uint64_t end;
      std::vector<Record> block;
      std::size_t in_block;
    };
    struct First {
      Record record;
      std::size_t run;
      /// For a queue whose top is the least.
      bool operator<(const First& other) const { return other.record < record; }
    };

    void take_from(std::size_t run) {
      Cursor& cursor = cursors_[run];
      if (cursor.in_block == cursor.block.size()) {
        cursor.block.resize(static_cast<std::size_t>(std::min<std::uint64_t>(at_once_, cursor.end - cursor.next)));
        runs_.file_.read(cursor.next * sizeof(Record), std::as_writable_bytes(std::span(cursor.block)));
        cursor.next += cursor.block.size();
        cursor.in_block = 0;
      }
      if (!cursor.block.empty()) first_.push({cursor.block[cursor.in_block++], run});
    }

    const SortedRuns& runs_;
    std::size_t at_once_;  ///< records of a run that are read
    std::vector<Cursor> cursors_;
    std::priority_queue<First> first_;
  };

 private:
  SpillFile file_;
  std::vector<std::uint64_t> starts_;
};

}  // namespace detp::sim
