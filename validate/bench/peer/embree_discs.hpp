#pragma once

#include <embree3/rtcore.h>

#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <type_traits>

#include "detp/sim/geometry/geometry.hpp"
#include "embree_mode.hpp"

namespace detp::validate {

struct ReleaseEmbree {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
template <class Handle>
using EmbreeOwned = std::unique_ptr<std::remove_pointer_t<Handle>, ReleaseEmbree>;

/// If an Embree call of this thread has failed, throws std::bad_alloc if Embree was out of memory, else
/// std::runtime_error with Embree's error number.
void require_no_embree_error(RTCDevice device);

/// A device that builds with `threads` threads. The threads have been started when the function returns. It uses the counterpart of one of
/// our instruction sets (AVX3: AVX-512; AVX2; SSE4: SSE4.2), or all that the machine has if this is empty. Throws
/// std::invalid_argument for one without a counterpart.
[[nodiscard]] EmbreeOwned<RTCDevice> make_embree_device(int threads, const std::string& instruction_set = {});

/// A committed scene of oriented discs in single precision. Primitive i is disc i. Queries call the context's filter.
/// Throws sim::Stopped if a stop was requested, and as require_no_embree_error does.
[[nodiscard]] EmbreeOwned<RTCScene> build_embree_discs(RTCDevice device, std::span<const sim::Disc> discs,
                                                       EmbreeQuality quality, const std::stop_token& stop = {});

}  // namespace detp::validate
