#include "ray_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/kept_memory.hpp"
#include "detp/sim/base/parallel.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "file_error.hpp"
#include "table_file.hpp"
#include "table_writer.hpp"

namespace detp::sim {
namespace {

constexpr std::string_view power_prefix = "power_";

/// Brings the rays of each photon together.
void sort_by_photon(RayFile& file) {
  Paths& paths = file.paths;
  std::unordered_map<std::uint64_t, std::uint64_t> numbers;  // in the order of first rays
  for (std::uint64_t& photon : paths.photons) photon = numbers.try_emplace(photon, numbers.size()).first->second;
  if (std::ranges::is_sorted(paths.photons)) return;
  file.order.resize(paths.rays.size());
  std::iota(file.order.begin(), file.order.end(), 0U);
  std::ranges::stable_sort(file.order, {}, [&](std::uint32_t ray) { return paths.photons[ray]; });
  const auto sort = [&](auto& column, std::size_t each = 1) {
    auto sorted = column;
    for (std::size_t i = 0; i < column.size(); ++i) sorted[i] = column[file.order[i / each] * each + i % each];
    column = std::move(sorted);
  };
  sort(paths.rays);
  sort(paths.landings);
  sort(paths.photons);
  if (paths.further_bands > 0) sort(paths.further, paths.further_bands);
}

/// Numbers the photons 0, 1, 2, … in the order of the rays.
void number_photons(RayFile& file) {
  std::vector<std::uint64_t>& photons = file.paths.photons;
  if (!std::ranges::is_sorted(photons)) return sort_by_photon(file);
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < photons.size(); ++i) {
    const bool is_new = i + 1 < photons.size() && photons[i + 1] != photons[i];
    photons[i] = number;
    number += is_new ? 1 : 0;
  }
}

/// Several threads read rows that have places of their own.
void read_rows(const TableFile& table, Paths& paths, const std::stop_token& stop) {
  const std::uint64_t count = table.rows();
  KeptMemory memory(table.path());
  const auto make_room = [&](auto& column) {
    memory.reserve(column, count);
    column.resize(count);
  };
  make_room(paths.rays);
  if (table.given(ray_column::photon)) make_room(paths.photons);
  if (table.given(ray_column::landing)) make_room(paths.landings);
  memory.reserve(paths.further, count * paths.further_bands);
  paths.further.resize(count * paths.further_bands);
  constexpr std::uint64_t at_once = std::uint64_t{1} << 14;
  const auto read = [&](std::uint64_t first, std::uint64_t last) {
    std::uint64_t i = first;
    table.read(
        first, last,
        [&](const TableRow& row) {
          const Ray ray = paths.rays[i] = ray_in(row);
          if (!paths.photons.empty()) paths.photons[i] = photon_in(row);
          if (!paths.landings.empty()) paths.landings[i] = landing_in(row, ray);
          for (std::size_t band = 0; band < paths.further_bands; ++band)
            paths.further[i * paths.further_bands + band] = power_in(row, ray_column::further + band);
          ++i;
        },
        stop);
  };
  try {
    sim::parallel_for(std::uint64_t{0}, (count + at_once - 1) / at_once,
                      [&](std::uint64_t part) { read(part * at_once, std::min(count, (part + 1) * at_once)); });
  } catch (const FileError&) {
    read(0, count);  // names the first bad row
    throw;
  }
}

}  // namespace

RayFile read_rays(const std::string& path, std::stop_token stop, const RayColumns& asked) {
  RayFile file;
  const ColumnChoice columns = ray_columns(asked, file.bands);
  const auto further_bands = [&] { return file.bands.empty() ? 0 : file.bands.size() - 1; };
  if (const auto table = TableFile::open(path, columns)) {
    file.paths.further_bands = further_bands();
    if (table->rows() == 0) throw FileError(path, "has no ray; at least one is needed");
    read_rows(*table, file.paths, stop);
    file.unused = columns.unused();
    number_photons(file);
    return file;
  }
  KeptMemory memory(path);
  read_table(
      path, columns,
      [&](const TableRow& row) {
        const Ray ray = ray_in(row);
        const std::size_t rows = row.expected_rows();
        memory.push(file.paths.rays, ray, rows);
        if (row.given(ray_column::photon)) memory.push(file.paths.photons, photon_in(row), rows);
        if (row.given(ray_column::landing)) memory.push(file.paths.landings, landing_in(row, ray), rows);
        for (std::size_t column = ray_column::further; column < row.columns().size(); ++column)
          memory.push(file.paths.further, power_in(row, column), rows * further_bands());
      },
      std::move(stop));
  if (file.paths.rays.empty()) throw FileError(path, "has no ray; at least one is needed");
  file.paths.further_bands = further_bands();
  file.unused = columns.unused();
  number_photons(file);
  return file;
}

void write_rays(const std::string& path, const PathRays& paths, const std::stop_token& stop,
                const std::vector<std::string>& bands) {
  std::vector<std::string> powers;
  for (const std::string& band : bands) powers.push_back(std::string(power_prefix) + band);
  if (powers.empty()) powers.emplace_back("power");
  std::vector<std::string_view> columns{"ox", "oy", "oz", "dx", "dy", "dz", "length"};
  columns.insert(columns.end(), powers.begin(), powers.end());
  if (!paths.photons.empty()) columns.emplace_back("photon");
  if (!paths.landings.empty()) columns.emplace_back("landing");
  TableWriter file(path, columns, paths.rays.size(), "rays", stop);
  std::vector<double> row;
  for (std::size_t i = 0; i < paths.rays.size(); ++i) {
    const auto& [o, d, length, power] = paths.rays[i];
    row.assign({o.x, o.y, o.z, d.x, d.y, d.z, length, power});
    for (const double further : paths.further.of(i)) row.push_back(further);
    if (!paths.photons.empty()) row.push_back(static_cast<double>(paths.photons[i]));
    if (!paths.landings.empty()) row.push_back(paths.landings[i]);
    file.write(row);
  }
  file.commit();
}

namespace {

constexpr double at_end = std::numeric_limits<double>::lowest();  ///< landing at the ray's end

std::vector<TableColumn> own_columns() {
  return {{"ox", {}, {}},
          {"oy", {}, {}},
          {"oz", {}, {}},
          {"dx", {}, {}},
          {"dy", {}, {}},
          {"dz", {}, {}},
          {"length", unbounded, unbounded},
          {"power", 1.0, {}},
          {"photon", 0.0, {}},
          {"landing", at_end, at_end}};
}

std::vector<BandColumn> bands_in(const std::vector<std::string>& headings) {
  std::vector<BandColumn> bands;
  for (const std::string& heading : headings)
    if (same_heading(heading.substr(0, power_prefix.size()), power_prefix))
      bands.push_back({heading.substr(power_prefix.size()), heading});
  if (!bands.empty() &&
      std::ranges::any_of(headings, [](const std::string& one) { return same_heading(one, "power"); }))
    throw std::invalid_argument(
        fmt::format("has power and {}: a file has one power or powers with names", bands.front().column));
  return bands;
}

void check(const std::vector<BandColumn>& bands) {
  if (bands.size() > most_bands)
    throw std::invalid_argument(fmt::format("{} bands are too many; the maximum is {}", bands.size(), most_bands));
  for (std::size_t i = 0; i < bands.size(); ++i) {
    const auto known = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '_';
    };
    const std::string& name = bands[i].name;
    if (name.empty() || name.size() > 64 || !std::ranges::all_of(name, known))
      throw std::invalid_argument(fmt::format(
          "a band's name has 1 to 64 letters, digits, dots, minuses and underscores (got {})", detp::quoted(name)));
    for (std::size_t j = 0; j < i; ++j)
      if (bands[j].name == name || bands[j].column == bands[i].column)
        throw std::invalid_argument(fmt::format("band {} and band {} have the same {}", j + 1, i + 1,
                                                bands[j].name == name ? "name" : "column"));
  }
}

}  // namespace

ColumnChoice ray_columns(const RayColumns& asked, std::vector<BandColumn>& found) {
  return ColumnChoice(std::function([bands = asked.bands, &found](const std::vector<std::string>& headings) {
           found = bands.empty() ? bands_in(headings) : bands;
           check(found);
           std::vector<TableColumn> columns = own_columns();
           if (!found.empty()) columns[ray_column::power] = {found.front().column, {}, {}};
           for (std::size_t band = 1; band < found.size(); ++band) columns.push_back({found[band].column, {}, {}});
           return columns;
         }))
      .named(asked.names);
}

bool is_ray_column(std::string_view name) {
  const std::vector<TableColumn> own = own_columns();
  return name.starts_with(power_prefix) || std::ranges::find(own, name, &TableColumn::name) != own.end();
}

std::vector<BandColumn> parse_bands(std::string_view text) {
  std::vector<BandColumn> bands;
  for (auto& [name, column] : parse_pairs(text, "bands must be NAME=COLUMN, as in r=red,g=green"))
    bands.push_back({std::move(name), std::move(column)});
  check(bands);
  return bands;
}

Ray ray_in(const TableRow& row) {
  const Ray ray{.origin = row.finite_vector(ray_column::ox),
                .direction = unit_or_zero(row.finite_vector(ray_column::dx)),
                .length = row[ray_column::length],
                .power = power_in(row, ray_column::power)};
  if (ray.direction == glm::dvec3{0.0}) row.fail("the direction is zero; it needs a length");
  if (!(ray.length > 0)) row.fail(fmt::format("length must be > 0, or inf for a line (got {})", ray.length));
  return ray;
}

double power_in(const TableRow& row, std::size_t column) {
  const double power = row.finite(column);
  if (power < 0) row.fail(fmt::format("{} must be >= 0 and finite (got {})", row.columns()[column].name, power));
  return power;
}

std::uint64_t photon_in(const TableRow& row) {
  constexpr double most = 0x1p53;
  const double number = row.finite(ray_column::photon);
  if (number < 0 || number > most || number != std::floor(number))
    row.fail(fmt::format("photon must be a whole number from 0 to 2^53 (got {})", number));
  return static_cast<std::uint64_t>(number);
}

double landing_in(const TableRow& row, const Ray& ray) {
  const double at = row[ray_column::landing];
  if (at == at_end) return ray.length;
  if (!(at >= 0)) row.fail(fmt::format("landing must be >= 0, or inf for none (got {})", at));
  return at;
}

}  // namespace detp::sim
