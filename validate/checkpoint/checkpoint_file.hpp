#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <stop_token>
#include <string>

#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/files/file_error.hpp"

/// What long work has found so far, in a JSON file.
namespace detp::validate {

inline constexpr int checkpoint_version = 6;

class CheckpointFile {
 public:
  /// `work` names the kind of work, as "map". `key` is an object of numbers and words: all that decides what the work finds, as
  /// {"seed": 1}. Only a file with the same work and key can be continued.
  CheckpointFile(std::filesystem::path path, std::string work, nlohmann::json key);

  /// The state in the file; nothing if there is no file. Throws sim::FileError, with the reason, if it is not a checkpoint of this version,
  /// was altered, or was made by other work; sim::Stopped within 0.1 s of a stop request.
  [[nodiscard]] std::optional<nlohmann::json> read(std::stop_token stop = {}) const;

  /// Replaces the file as a whole, so that it is complete at any moment. Numbers must be finite: JSON has no others. Throws
  /// sim::FileError if the file cannot be written.
  void write(const nlohmann::json& state);

  /// Whether writing costs less than a hundredth of the time since the last writing. Always false in the first tenth of a second.
  [[nodiscard]] bool due() const;

  /// The error of a state in the file that cannot be understood: the caller throws it.
  [[nodiscard]] sim::FileError damaged(const std::string& why) const;

 private:
  std::filesystem::path path_;
  std::string work_;
  nlohmann::json key_;
  sim::Stopwatch since_last_;
  double write_seconds_ = 0;
};

/// Throws sim::FileError, before any work, if there is a file which is no checkpoint of this version: work that begins anew would
/// replace it. An empty file may be replaced.
void require_replaceable(const std::string& path);

}  // namespace detp::validate
