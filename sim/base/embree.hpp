#pragma once

#if DETP_EMBREE == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <memory>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <type_traits>

#include "memory.hpp"
#include "stopped.hpp"

/// Owning handles for Embree's objects, Embree's errors turned into exceptions, and what differs between Embree 3 and 4.
namespace detp::sim::embree {

#if DETP_EMBREE == 4

/// What callbacks get with each call: the first member of a caller's own data.
using Context = RTCRayQueryContext;
inline void init(Context& context) { rtcInitRayQueryContext(&context); }

inline constexpr RTCSceneFlags filter_of_query = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;

inline void occluded1(RTCScene scene, Context& context, RTCRay& ray) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  rtcOccluded1(scene, &ray, &arguments);
}

#else

using Context = RTCIntersectContext;
inline void init(Context& context) { rtcInitIntersectContext(&context); }

inline constexpr RTCSceneFlags filter_of_query = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;

inline void occluded1(RTCScene scene, Context& context, RTCRay& ray) { rtcOccluded1(scene, &context, &ray); }

#endif

/// What all queries of a thread share: each hit is passed to the filter, with the context.
class FilteredQueries {
 public:
#if DETP_EMBREE == 4
  FilteredQueries(Context& context, RTCFilterFunctionN filter, bool coherent) {
    rtcInitIntersectArguments(&intersect_);
    rtcInitOccludedArguments(&occluded_);
    const auto set = [&](auto& arguments) {
      arguments.context = &context;
      arguments.filter = filter;
      const unsigned flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER |
                             (coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT);
      arguments.flags = static_cast<RTCRayQueryFlags>(flags);
    };
    set(intersect_);
    set(occluded_);
  }

  void trace(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray, &occluded_); }
  void trace(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray, &intersect_); }
  void trace(RTCScene scene, const int* valid, RTCRay8& rays) { rtcOccluded8(valid, scene, &rays, &occluded_); }
  void trace(RTCScene scene, const int* valid, RTCRayHit8& rays) { rtcIntersect8(valid, scene, &rays, &intersect_); }
  void trace(RTCScene scene, const int* valid, RTCRay16& rays) { rtcOccluded16(valid, scene, &rays, &occluded_); }
  void trace(RTCScene scene, const int* valid, RTCRayHit16& rays) { rtcIntersect16(valid, scene, &rays, &intersect_); }

 private:
  RTCIntersectArguments intersect_;
  RTCOccludedArguments occluded_;
#else
  FilteredQueries(Context& context, RTCFilterFunctionN filter, bool coherent) : context_(&context) {
    context.filter = filter;
    if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  }

  void trace(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, context_, &ray); }
  void trace(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, context_, &ray); }
  void trace(RTCScene scene, const int* valid, RTCRay8& rays) { rtcOccluded8(valid, scene, context_, &rays); }
  void trace(RTCScene scene, const int* valid, RTCRayHit8& rays) { rtcIntersect8(valid, scene, context_, &rays); }
  void trace(RTCScene scene, const int* valid, RTCRay16& rays) { rtcOccluded16(valid, scene, context_, &rays); }
  void trace(RTCScene scene, const int* valid, RTCRayHit16& rays) { rtcIntersect16(valid, scene, context_, &rays); }

  void trace_stream(RTCScene scene, RTCRay* rays, unsigned count) {
    rtcOccluded1M(scene, context_, rays, count, sizeof(RTCRay));
  }
  void trace_stream(RTCScene scene, RTCRayHit* rays, unsigned count) {
    rtcIntersect1M(scene, context_, rays, count, sizeof(RTCRayHit));
  }
  void trace_stream(RTCScene scene, RTCRay8* packets, unsigned count) {
    rtcOccludedNM(scene, context_, reinterpret_cast<RTCRayN*>(packets), 8, count, sizeof(RTCRay8));
  }
  void trace_stream(RTCScene scene, RTCRayHit8* packets, unsigned count) {
    rtcIntersectNM(scene, context_, reinterpret_cast<RTCRayHitN*>(packets), 8, count, sizeof(RTCRayHit8));
  }

 private:
  Context* context_;
#endif
};

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};

/// Owned<RTCDevice>, Owned<RTCScene>, Owned<RTCGeometry>.
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

/// Throws if an operation on the device has failed since the last call, or if there is no device because rtcNewDevice
/// failed: Stopped ("stopped while " + doing), OutOfMemory, or std::runtime_error with Embree's error number.
inline void require_no_error(RTCDevice device, const char* doing = "working") {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_CANCELLED) throw Stopped(std::string("stopped while ") + doing);
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
  require_no_error(device, doing);
}

}  // namespace detp::sim::embree
