#pragma once

#include <sys/mman.h>
#include <sys/resource.h>

#include <cstddef>

namespace detp::support {

/// Limits the address space of this process, and of processes that it starts, while the object exists.
class AddressLimit {
 public:
  explicit AddressLimit(double bytes) : bytes_(static_cast<std::size_t>(bytes)) {
    getrlimit(RLIMIT_AS, &before_);
    const rlimit limit{bytes_, before_.rlim_max};
    setrlimit(RLIMIT_AS, &limit);
  }
  ~AddressLimit() { setrlimit(RLIMIT_AS, &before_); }
  AddressLimit(const AddressLimit&) = delete;
  AddressLimit& operator=(const AddressLimit&) = delete;

  /// False where the system does not heed it, as under an emulator.
  [[nodiscard]] bool holds() const {
    void* const more = mmap(nullptr, bytes_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (more != MAP_FAILED) munmap(more, bytes_);
    return more == MAP_FAILED;
  }

 private:
  std::size_t bytes_;
  rlimit before_{};
};

}  // namespace detp::support
