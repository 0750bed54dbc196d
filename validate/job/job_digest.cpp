#include "job_digest.hpp"

namespace detp::validate {

void add(std::span<const sim::Disc> discs, Digest& digest) {
  for (const sim::Disc& disc : discs) {
    digest.add(disc.centre);
    digest.add(disc.normal);
    digest.add(disc.radius);
  }
}

void add(std::span<const sim::Ray> rays, Digest& digest) {
  for (const sim::Ray& ray : rays) {
    digest.add(ray.origin);
    digest.add(ray.direction);
    digest.add(ray.length);
    digest.add(ray.power);
  }
}

std::string digest_of(const Job& job) {
  Digest digest;
  digest.add(job.seed);
  digest.add(job.independent_photons());
  add(job.discs, digest);
  add(job.rays, digest);
  for (const std::uint64_t photon : job.photons) digest.add(photon);
  return digest.text();
}

}  // namespace detp::validate
