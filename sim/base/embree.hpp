#pragma once

#include <embree3/rtcore.h>

#include <memory>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <type_traits>

#include "memory.hpp"
#include "stopped.hpp"

/// Owning handles for Embree's objects, and Embree's errors turned into exceptions.
namespace detp::sim::embree {

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};

/// Owned<RTCDevice>, Owned<RTCScene>, Owned<RTCGeometry>.
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

/// Throws if an operation on the device has failed since the last call, or if there is no device because rtcNewDevice
/// failed: OutOfMemory, or std::runtime_error with Embree's error number.
inline void require_no_error(const Owned<RTCDevice>& device) {
  const RTCError error = rtcGetDeviceError(device.get());
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw OutOfMemory("Embree builds its tree");
  if (error != RTC_ERROR_NONE || device == nullptr)
    throw std::runtime_error("Embree failed with error " + std::to_string(static_cast<int>(error)));
}

/// Builds the scene's tree. Embree calls the callbacks for bounds in its own floating-point mode, which flushes subnormal
/// numbers to zero; their results must have margins that cover this. Throws Stopped ("stopped while " + doing) if a stop is requested during the build,
/// OutOfMemory or std::runtime_error if Embree fails.
inline void commit(RTCDevice device, RTCScene scene, const std::stop_token& stop, const char* doing) {
  const auto go_on = [](void* token, double) { return !static_cast<const std::stop_token*>(token)->stop_requested(); };
  rtcSetSceneProgressMonitorFunction(scene, go_on, const_cast<std::stop_token*>(&stop));
  rtcCommitScene(scene);
  rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_CANCELLED) throw Stopped(std::string("stopped while ") + doing);
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw OutOfMemory("Embree builds its tree");
  if (error != RTC_ERROR_NONE)
    throw std::runtime_error("Embree failed with error " + std::to_string(static_cast<int>(error)));
}

}  // namespace detp::sim::embree
