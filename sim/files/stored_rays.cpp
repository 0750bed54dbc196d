#include "stored_rays.hpp"

#include <algorithm>
#include <utility>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/ranks/failures.hpp"
#include "detp/sim/ranks/parts.hpp"
#include "file_error.hpp"
#include "ray_file.hpp"

namespace detp::sim {
namespace {

constexpr std::uint64_t rays_in_chunk = 1 << 16;

/// What a chunk's rays tell; trivially copyable.
struct Chunk {
  Box origins;
  std::uint64_t first_photon = 0;  ///< as the file has it
  std::uint64_t last_photon = 0;
  std::uint64_t changes = 0;  ///< rays of another photon than the ray before them, in the chunk
  bool falls = false;         ///< a photon's number is below that of the ray before
};

void require_no_stop(const std::stop_token& stop, const std::string& path) {
  if (stop.stop_requested()) throw Stopped("stopped while reading " + shown_path(path));
}

}  // namespace

std::unique_ptr<const StoredRays> StoredRays::open(const std::string& path, const std::stop_token& stop, Ranks* ranks,
                                                   const RayColumns& asked, std::vector<std::string>* unused) {
  std::vector<BandColumn> found;
  const ColumnChoice columns = ray_columns(asked, found);
  auto file = TableFile::open(path, columns);
  if (!file) return nullptr;
  if (unused != nullptr) *unused = columns.unused();
  if (file->rows() == 0) throw FileError(path, "has no ray; at least one is needed");
  std::unique_ptr<StoredRays> rays(new StoredRays(std::move(*file), std::move(found)));
  if (!rays->look_through(stop, ranks)) return nullptr;
  return rays;
}

bool StoredRays::look_through(const std::stop_token& stop, Ranks* ranks) {
  OneRank one;
  Ranks& all = ranks != nullptr ? *ranks : one;
  std::vector<Chunk> chunks((size() + rays_in_chunk - 1) / rays_in_chunk);
  const auto [begin, end] = part_of(chunks.size(), all);
  do_on_all(all, [&, first_chunk = begin, last_chunk = end] {
    sim::parallel_for(first_chunk, last_chunk, [&](std::size_t number) {
      require_no_stop(stop, file_.path());
      Chunk& chunk = chunks[number];
      const std::uint64_t first = number * rays_in_chunk;
      bool has_one = false;
      file_.read(first, std::min(size(), first + rays_in_chunk), [&](const TableRow& row) {
        const Ray ray = ray_in(row);
        static_cast<void>(landing_in(row, ray));
        for (std::size_t band = 1; band < bands(); ++band)
          static_cast<void>(power_in(row, ray_column::further + band - 1));
        chunk.origins.include(ray.origin);
        const std::uint64_t photon = photon_in(row);
        if (!std::exchange(has_one, true)) chunk.first_photon = chunk.last_photon = photon;
        if (photon < chunk.last_photon) chunk.falls = true;
        if (photon != chunk.last_photon) ++chunk.changes;
        chunk.last_photon = photon;
      });
    });
  });
  share_parts(all, std::span(chunks));
  std::uint64_t photon = 0;
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    const Chunk& chunk = chunks[i];
    if (chunk.falls || (i > 0 && chunk.first_photon < chunks[i - 1].last_photon)) return false;
    if (i > 0 && chunk.first_photon != chunks[i - 1].last_photon) ++photon;
    before_.push_back(photon);
    photon += chunk.changes;
    origins_.include(chunk.origins.low);
    origins_.include(chunk.origins.high);
  }
  photons_ = numbered() ? photon + 1 : size();
  return true;
}

bool StoredRays::numbered() const { return file_.given(ray_column::photon); }

template <class Visit>
void StoredRays::for_each_photon(std::uint64_t first, std::uint64_t last, const Visit& visit) const {
  const std::uint64_t chunk = first / rays_in_chunk;
  std::uint64_t ray = chunk * rays_in_chunk;
  std::uint64_t number = before_[chunk];
  std::uint64_t photon = 0;
  bool has_one = false;
  file_.read(ray, last, [&](const TableRow& row) {
    const std::uint64_t next = photon_in(row);
    if (std::exchange(has_one, true) && next != photon) ++number;
    photon = next;
    if (ray >= first) visit(ray, number);
    ++ray;
  });
}

std::uint64_t StoredRays::photon_of(std::uint64_t ray) const {
  std::uint64_t found = 0;
  for_each_photon(ray, ray + 1, [&](std::uint64_t, std::uint64_t number) { found = number; });
  return found;
}

std::uint64_t StoredRays::first_ray_of(std::uint64_t photon) const {
  if (!numbered()) return std::min(size(), photon);
  if (photon >= photons_) return size();
  // The last chunk that begins with an earlier photon has its first ray, or the chunk after it begins with it.
  const auto after = std::ranges::lower_bound(before_, photon);
  const auto chunk = static_cast<std::uint64_t>(after - before_.begin()) - (after == before_.begin() ? 0 : 1);
  const std::uint64_t last = std::min(size(), (chunk + 1) * rays_in_chunk);
  std::uint64_t found = last;
  for_each_photon(chunk * rays_in_chunk, last, [&](std::uint64_t ray, std::uint64_t number) {
    if (number >= photon) found = std::min(found, ray);
  });
  return found;
}

std::uint64_t StoredRays::block_end(std::uint64_t first, std::uint64_t most, const std::stop_token&) const {
  if (!numbered() || most >= size() - first) return std::min(size(), first + most);
  const std::uint64_t cut = photon_of(first + most);
  const std::uint64_t begin = first_ray_of(cut);
  return begin > first ? begin : first_ray_of(cut + 1);
}

template <class Visit>
void StoredRays::for_each_row(std::uint64_t first, std::size_t count, const std::stop_token& stop,
                              const Visit& visit) const {
  constexpr std::size_t at_once = 1 << 12;
  sim::parallel_for(std::size_t{0}, (count + at_once - 1) / at_once, [&](std::size_t part) {
    require_no_stop(stop, file_.path());
    std::size_t next = part * at_once;
    const std::size_t last = std::min(count, next + at_once);
    file_.read(first + next, first + last, [&](const TableRow& row) { visit(next++, row); });
  });
}

void StoredRays::read(std::uint64_t first, std::span<Ray> block, const std::stop_token& stop) const {
  for_each_row(first, block.size(), stop, [&](std::size_t i, const TableRow& row) { block[i] = ray_in(row); });
}

void StoredRays::read_all(std::uint64_t first, std::span<Ray> block, BesideRays& beside,
                          const std::stop_token& stop) const {
  std::vector<std::uint64_t>& photons = beside.photons;
  photons.clear();
  const std::size_t further = bands() - 1;
  beside.further.resize(block.size() * further);
  for_each_row(first, block.size(), stop, [&](std::size_t i, const TableRow& row) {
    block[i] = ray_in(row);
    for (std::size_t band = 0; band < further; ++band)
      beside.further[i * further + band] = power_in(row, ray_column::further + band);
  });
  if (!numbered() || block.empty()) return;
  photons.resize(block.size());
  for_each_photon(first, first + block.size(),
                  [&](std::uint64_t ray, std::uint64_t number) { photons[ray - first] = number; });
}

double StoredRays::farthest_from(const glm::dvec3& point) const { return farthest_in(origins_, point); }

}  // namespace detp::sim
