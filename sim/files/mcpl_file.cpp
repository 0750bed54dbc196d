#include "mcpl_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "file_error.hpp"
#include "input_file.hpp"
#include "number_bytes.hpp"

namespace detp::sim {
namespace {

/// Reads the numbers of a file one after the other.
class McplFile {
 public:
  McplFile(const std::string& path, std::stop_token stop) : file_(path, std::move(stop)) {
    constexpr std::size_t mark_size = 8;
    need(mark_size);
    const std::string mark(file_.buffered().substr(0, mark_size));
    if (!mark.starts_with("MCPL")) fail("is no MCPL file");
    if (mark.substr(4, 3) != "003") fail(fmt::format("is MCPL of version {}; version 003 is read", mark.substr(4, 3)));
    if (mark.back() != 'L' && mark.back() != 'B') fail("does not say in which order its bytes are");
    swapped_ = (mark.back() == 'L') != (std::endian::native == std::endian::little);
    file_.skip(mark_size);
    read_header();
  }

  [[nodiscard]] std::uint64_t particles() const { return particles_; }
  [[nodiscard]] bool has_flags() const { return flags_; }

  /// Of a particle, in the order of the columns.
  std::array<double, 12> next() {
    const NumberType real = single_ ? NumberType::float32 : NumberType::float64;
    need(particle_size_);
    if (polarised_) skip(3 * size_of(real));
    std::array<double, 7> numbers{};  // place, packed direction with energy, time
    for (double& one : numbers) one = number(real);
    const double weight = universal_weight_ ? *universal_weight_ : number(real);
    const double code = universal_code_ != 0 ? universal_code_ : number(NumberType::int32);
    const double flags = flags_ ? number(NumberType::uint32) : 0;
    const glm::dvec3 direction = unpacked({numbers[3], numbers[4], numbers[5]});
    const double energy = std::abs(numbers[5]);
    return {numbers[0], numbers[1],      numbers[2], direction.x, direction.y, direction.z,
            weight,     weight * energy, energy,     numbers[6],  code,        flags};
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw FileError(file_.path(), what); }
  void need(std::size_t bytes) {
    if (!file_.fetch(bytes)) fail("ends early");
  }
  void skip(std::size_t bytes) { file_.skip(bytes); }

  double number(NumberType type) {
    need(size_of(type));
    const double found = number_at(file_.buffered().data(), type, swapped_);
    skip(size_of(type));
    return found;
  }

  void skip_text() {
    auto length = static_cast<std::size_t>(number(NumberType::uint32));
    constexpr std::size_t at_once = 1 << 16;
    for (std::size_t part = 0; length > 0; length -= part) {
      part = std::min(length, at_once);
      need(part);
      skip(part);
    }
  }

  void read_header() {
    using enum NumberType;
    const double particles = number(uint64);
    constexpr double most = 0x1p53;
    if (particles > most) fail(fmt::format("says that it has {:.3g} particles", particles));
    particles_ = static_cast<std::uint64_t>(particles);
    const double comments = number(uint32);
    const double blobs = number(uint32);
    flags_ = number(uint32) != 0;
    polarised_ = number(uint32) != 0;
    single_ = number(uint32) != 0;
    universal_code_ = number(int32);
    particle_size_ = static_cast<std::size_t>(number(uint32));
    if (number(uint32) != 0) universal_weight_ = number(float64);
    const std::size_t reals = 7 + (polarised_ ? 3 : 0) + (universal_weight_ ? 0 : 1);
    const std::size_t expected =
        reals * (single_ ? 4 : 8) + (universal_code_ == 0 ? 4 : 0) + (flags_ ? std::size_t{4} : 0);
    if (particle_size_ != expected)
      fail(fmt::format("has particles of {} bytes; by its other numbers they have {}", particle_size_, expected));
    // The name of the program, comments; names of blobs, blobs.
    for (double i = 0; i < 1 + comments + 2 * blobs; ++i) skip_text();
  }

  /// The two smaller components (x before y before z), of which the z is stored as its inverse, and the sign of the third. So if one of both is
  /// above 1, it is 1 / z and stands in the place of what is left out (ibid., section 2.3).
  static glm::dvec3 unpacked(const glm::dvec3& packed) {
    const auto third = [&](double one, double other) {
      return std::copysign(std::sqrt(std::max(0.0, 1 - one * one - other * other)), packed.z);
    };
    if (std::abs(packed.x) > 1) return {third(packed.y, 1 / packed.x), packed.y, 1 / packed.x};
    if (std::abs(packed.y) > 1) return {packed.x, third(packed.x, 1 / packed.y), 1 / packed.y};
    return {packed.x, packed.y, third(packed.x, packed.y)};
  }

  InputFile file_;
  bool swapped_ = false;
  std::uint64_t particles_ = 0;
  bool flags_ = false;
  bool polarised_ = false;
  bool single_ = false;
  double universal_code_ = 0;  ///< 0: each particle has its own
  std::optional<double> universal_weight_;
  std::size_t particle_size_ = 0;
};

}  // namespace

std::size_t read_mcpl(const std::string& path, const ColumnChoice& choice, const TableSink& sink,
                      std::stop_token stop) {
  McplFile file(path, std::move(stop));
  std::vector<std::string> names{"ox", "oy", "oz", "dx", "dy", "dz", "power", "energy", "ekin", "time", "pdgcode"};
  if (file.has_flags()) names.emplace_back("userflags");
  names = choice.known(path, std::move(names));
  const std::vector<TableColumn> columns = choice(path, names);
  choice.sort_out(path, names, columns);
  TableRow row(path, columns);
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    places.push_back(static_cast<std::size_t>(std::ranges::find(names, columns[i].name) - names.begin()));
    if (places.back() < names.size()) continue;
    if (!columns[i].absent)
      throw FileError(path, fmt::format("has no column {}{}", columns[i].name, columns[i].remedy));
    row.set_absent(i);
  }
  for (std::uint64_t i = 0; i < file.particles(); ++i) {
    const std::array<double, 12> particle = file.next();
    for (std::size_t column = 0; column < places.size(); ++column)
      if (places[column] < names.size()) row.set(column, particle[places[column]]);
    row.place(i + 1, file.particles(), "particle");
    sink(row);
  }
  return file.particles();
}

}  // namespace detp::sim
