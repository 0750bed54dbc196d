#pragma once

#include <detp.h>

#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

/// What a program that calls the C interface has.
namespace detp::support {

/// Discs and rays in a caller's structs of floats.
struct Data {
  struct Sample {
    float position[3], normal[3], other;
  };
  struct Segment {
    float origin[3], direction[3], length, power;
  };
  std::vector<Sample> samples;
  std::vector<Segment> segments;

  Data(std::size_t discs, std::size_t rays, std::uint64_t seed) : samples(discs), segments(rays) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<float> number(-1, 1);
    for (Sample& s : samples)
      s = {{number(random), number(random), number(random)}, {number(random), number(random), 1}, 0};
    for (Segment& s : segments)
      s = {{number(random), number(random), number(random)}, {number(random), number(random), -1}, 2, 0.5F};
  }

  [[nodiscard]] detp_discs discs(double radius) const {
    detp_discs all = DETP_INIT(detp_discs);
    all.count = samples.size();
    all.centres = {samples[0].position, nullptr, nullptr, sizeof(Sample), DETP_FLOAT};
    all.normals = {samples[0].normal, nullptr, nullptr, sizeof(Sample), DETP_FLOAT};
    all.radii.of_all = radius;
    return all;
  }

  [[nodiscard]] detp_rays rays() const {
    detp_rays all = DETP_INIT(detp_rays);
    all.count = segments.size();
    all.origins = {segments[0].origin, nullptr, nullptr, sizeof(Segment), DETP_FLOAT};
    all.directions = {segments[0].direction, nullptr, nullptr, sizeof(Segment), DETP_FLOAT};
    all.lengths = {&segments[0].length, sizeof(Segment), DETP_FLOAT, 0};
    all.powers = {&segments[0].power, sizeof(Segment), DETP_FLOAT, 0};
    return all;
  }
};

/// What a search found, in arrays of its own.
struct Arrays {
  std::vector<std::uint64_t> hits;
  std::vector<double> irradiance, standard_error, upper_bound;
  detp_found found = DETP_INIT(detp_found);

  explicit Arrays(std::size_t discs) : hits(discs), irradiance(discs), standard_error(discs), upper_bound(discs) {
    found.hits = hits.data();
    found.irradiance = irradiance.data();
    found.standard_error = standard_error.data();
    found.upper_bound = upper_bound.data();
  }
};

template <class T>
[[nodiscard]] bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

}  // namespace detp::support
