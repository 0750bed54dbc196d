#include "checkpoint.hpp"

#include <utility>

namespace detp::validate {
namespace {

using Json = CheckpointFile::Json;

Json to_json(const Deviation& row) {
  return Json::array({row.dimension, row.samples, row.disc_share, row.technique, row.parameters, row.quantity,
                      row.sphere, name(row.form), row.predicted, row.observed.mean, row.observed.standard_error});
}

Deviation deviation_of(const Json& json) {
  Deviation row{.dimension = json.at(0),
                .samples = json.at(1),
                .disc_share = json.at(2),
                .technique = json.at(3),
                .parameters = json.at(4),
                .quantity = json.at(5),
                .sphere = json.at(6),
                .form = json.at(7) == name(Form::published) ? Form::published : Form::corrected,
                .predicted = json.at(8),
                .observed = {.mean = json.at(9), .standard_error = json.at(10)}};
  return row;
}

}  // namespace

Checkpoint::Checkpoint(std::filesystem::path path, std::uint64_t seed, const std::string& formulas)
    : file_(std::move(path), "validate --effort thorough",
            {{"seed", seed}, {"digest of formulas and workloads", formulas}}) {}

void Checkpoint::read(std::stop_token stop) {
  const auto state = file_.read(std::move(stop));
  if (!state) return;
  try {
    for (const auto& [name, rows] : state->items())
      for (const Json& row : rows) points_[name].push_back(deviation_of(row));
  } catch (const nlohmann::json::exception& error) {
    throw file_.damaged(error.what());
  }
}

void Checkpoint::add(const std::string& point, const std::vector<Deviation>& deviations) {
  points_[point] = deviations;
  Json state = Json::object();
  for (const auto& [name, rows] : points_) {
    Json& place = state[name] = Json::array();
    for (const Deviation& row : rows) place.push_back(to_json(row));
  }
  file_.write(state);
}

}  // namespace detp::validate
