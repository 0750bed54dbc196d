#pragma once

#include <sys/resource.h>

namespace detp::support {

/// Limits the address space of this process, and of processes that it starts, while the object exists.
class AddressLimit {
 public:
  explicit AddressLimit(double bytes) {
    getrlimit(RLIMIT_AS, &before_);
    const rlimit limit{static_cast<rlim_t>(bytes), before_.rlim_max};
    setrlimit(RLIMIT_AS, &limit);
  }
  ~AddressLimit() { setrlimit(RLIMIT_AS, &before_); }
  AddressLimit(const AddressLimit&) = delete;
  AddressLimit& operator=(const AddressLimit&) = delete;

 private:
  rlimit before_{};
};

}  // namespace detp::support
