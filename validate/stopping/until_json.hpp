#pragma once

#include <nlohmann/json.hpp>

#include "detp/model/rank/registry.hpp"
#include "execute_until.hpp"

/// A run between two batches as JSON, for a CheckpointFile.
namespace detp::validate {

struct SavedRun {
  Candidate candidate;
  UntilState state;
  ExecutedUntil so_far;  ///< hits, counts and seconds; no result
};

[[nodiscard]] nlohmann::json json_of(const Candidate& candidate, const UntilState& state, const ExecutedUntil& so_far);

/// Throws nlohmann::json::exception or std::invalid_argument unless the JSON is that of json_of.
[[nodiscard]] SavedRun saved_run_of(const nlohmann::json& json);

/// To be sent to another process.
[[nodiscard]] std::string bytes_of(const FoundBatch& found);
[[nodiscard]] FoundBatch found_batch_of(const std::string& bytes);

}  // namespace detp::validate
