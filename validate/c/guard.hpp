#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <exception>
#include <mutex>
#include <new>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>

#include "detp.h"
#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/phase.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/files/file_error.hpp"

/// What every function of the C interface does.
namespace detp::c {

/// Writes the message, cut to its room.
inline detp_status failed(detp_status status, const char* message, detp_error* error) {
  if (error != nullptr) {
    std::strncpy(error->text, message, sizeof(error->text) - 1);
    error->text[sizeof(error->text) - 1] = 0;
  }
  return status;
}

/// Calls the work, which returns a status or nothing, and turns what it throws into a status and a message.
template <class Work>
detp_status guarded(detp_error* error, const Work& work) noexcept {
  try {
    work();
    return DETP_OK;
  } catch (const sim::Stopped& stopped) {
    return failed(DETP_STOPPED, stopped.what(), error);
  } catch (const sim::FileError& file) {
    return failed(DETP_FILE, file.what(), error);
  } catch (const std::invalid_argument& invalid) {
    return failed(DETP_INVALID, invalid.what(), error);
  } catch (const std::length_error& length) {
    return failed(DETP_NO_MEMORY, length.what(), error);
  } catch (const std::overflow_error& length) {
    return failed(DETP_NO_MEMORY, length.what(), error);
  } catch (const sim::OutOfMemory& memory) {
    return failed(DETP_NO_MEMORY, memory.what(), error);
  } catch (const std::bad_alloc&) {
    return failed(DETP_NO_MEMORY, "out of memory", error);
  } catch (const std::exception& other) {
    return failed(DETP_INTERNAL, other.what(), error);
  } catch (...) {
    return failed(DETP_INTERNAL, "an unknown exception", error);
  }
}

/// Throws std::invalid_argument if the pointer is null.
template <class T>
T& given(T* pointer, const char* name) {
  if (pointer == nullptr) throw std::invalid_argument(std::string(name) + " is null");
  return *pointer;
}

/// The caller's struct as this library knows it. A newer caller's struct may be longer; what this library does not know must be 0. Throws
/// std::invalid_argument if it is null, if its size is less than that of the struct's first version, or for a value that is not known.
template <class T>
T known(const T* pointer, const char* name) {
  const std::size_t size = given(pointer, name).size;
  if (sizeof(T) > size || size > (1U << 16))
    throw std::invalid_argument(std::string(name) + ": size must be that of the struct, " + std::to_string(sizeof(T)) +
                                " bytes or more (got " + std::to_string(size) + ")");
  const auto* bytes = reinterpret_cast<const unsigned char*>(pointer);
  if (std::any_of(bytes + sizeof(T), bytes + size, [](unsigned char byte) { return byte != 0; }))
    throw std::invalid_argument(std::string(name) + ": has a value that this version of detp does not know");
  return *pointer;
}

/// Writes to the caller's struct; its size stays.
template <class T>
void write_back(T* theirs, T ours) {
  ours.size = theirs->size;
  *theirs = ours;
}

/// The caller's progress function: its answer "stop" becomes a stop request. It is called when there is progress, and also ten
/// times a second, so that it can stop the work at any time; one call at a time.
class Watch {
 public:
  /// `what` is done until show() says something else.
  Watch(detp_progress progress, void* user, std::string what)
      : progress_(progress), user_(user), what_(std::move(what)) {
    if (progress_ != nullptr) clock_ = std::jthread([this](const std::stop_token& end) { tick(end); });
  }

  [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

  void show(const std::string& what, double share) {
    if (progress_ == nullptr) return;
    const std::lock_guard lock(mutex_);
    what_ = what;
    share_ = share;
    call();
  }

  /// Empty without a function.
  [[nodiscard]] sim::ReportPhase report() {
    if (progress_ == nullptr) return {};
    return [this](const sim::Phase& phase) { show(phase.what, phase.from); };
  }

 private:
  void call() {
    if (progress_(user_, what_.c_str(), share_) != 0) stop_.request_stop();
  }

  void tick(const std::stop_token& end) {
    std::unique_lock lock(mutex_);
    while (!end_.wait_for(lock, end, std::chrono::milliseconds(100), [] { return false; }) && !end.stop_requested())
      call();
  }

  detp_progress progress_;
  void* user_;
  std::string what_;
  double share_ = 0;
  std::mutex mutex_;
  std::condition_variable_any end_;
  std::stop_source stop_;
  std::jthread clock_;
};

}  // namespace detp::c
