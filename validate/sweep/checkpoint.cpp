#include "checkpoint.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "detp/sim/files/file_error.hpp"
#include "detp/sim/files/input_file.hpp"
#include "detp/sim/files/output_file.hpp"

namespace detp::validate {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view schema = "detp.sweep-checkpoint";
constexpr std::size_t most_bytes = std::size_t{1} << 28;  // a whole sweep takes less than a hundredth of this

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

Checkpoint::Checkpoint(std::filesystem::path path, std::uint64_t seed, std::uint64_t fingerprint)
    : path_(std::move(path)), seed_(seed), fingerprint_(fingerprint) {}

void Checkpoint::read(std::stop_token stop) {
  std::error_code unknown;  // other errors appear when the file is read
  if (!std::filesystem::exists(path_, unknown) && !unknown) return;
  try {
    const Json json = Json::parse(sim::read_file(path_.string(), most_bytes, std::move(stop)));
    if (json.at("schema").at("name") != schema || json.at("schema").at("version") != 1)
      throw sim::FileError(path_.string(), "is not a checkpoint of this version of detp");
    if (json.at("seed") != seed_)
      throw sim::FileError(path_.string(),
                           fmt::format("was made with seed {}, not {}", json.at("seed").get<std::uint64_t>(), seed_));
    if (json.at("fingerprint") != fingerprint_)
      throw sim::FileError(path_.string(), "was made with other formulas or workloads; start again without it");
    for (const auto& [name, rows] : json.at("points").items())
      for (const Json& row : rows) points_[name].push_back(deviation_of(row));
  } catch (const nlohmann::json::exception& error) {
    throw sim::FileError(path_.string(), fmt::format("is not a checkpoint: {}", shortened(error.what(), 150)));
  }
}

void Checkpoint::add(const std::string& point, const std::vector<Deviation>& deviations) {
  points_[point] = deviations;
  Json json{{"schema", {{"name", schema}, {"version", 1}}}, {"seed", seed_}, {"fingerprint", fingerprint_}};
  for (const auto& [name, rows] : points_) {
    Json& place = json["points"][name] = Json::array();
    for (const Deviation& row : rows) place.push_back(to_json(row));
  }
  sim::OutputFile file(path_.string());
  file.write(json.dump() + "\n");
  file.commit();
}

}  // namespace detp::validate
