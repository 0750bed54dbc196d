#include "embree_discs.hpp"

#include <stdexcept>
#include <string>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/embree.hpp"
#include "detp/sim/base/parallel.hpp"
#include "embree_rays.hpp"

namespace detp::validate {
namespace {

RTCBuildQuality to_embree(EmbreeQuality quality) {
  if (quality == EmbreeQuality::low) return RTC_BUILD_QUALITY_LOW;
  return quality == EmbreeQuality::medium ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_HIGH;
}

/// The setting of the device; nothing for an empty name.
std::string setting_of(const std::string& instruction_set) {
  if (instruction_set.empty()) return {};
  if (instruction_set == "AVX3") return ",isa=avx512";
  if (instruction_set == "AVX2") return ",isa=avx2";
  if (instruction_set == "SSE4") return ",isa=sse4.2";
  throw std::invalid_argument("Embree has no counterpart of the instruction set " + detp::quoted(instruction_set) +
                              "; there are AVX3, AVX2, SSE4");
}

float* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t floats, std::size_t items) {
  return static_cast<float*>(rtcSetNewGeometryBuffer(geometry, type, 0, format, floats * sizeof(float), items));
}

}  // namespace

void require_no_embree_error(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  if (error != RTC_ERROR_NONE)
    throw std::runtime_error("Embree failed with error " + std::to_string(static_cast<int>(error)));
}

EmbreeOwned<RTCDevice> make_embree_device(int threads, const std::string& instruction_set) {
  const std::string settings = "threads=" + std::to_string(threads) + ",start_threads=1" + setting_of(instruction_set);
  EmbreeOwned<RTCDevice> device(rtcNewDevice(settings.c_str()));
  require_no_embree_error(device.get());
  return device;
}

EmbreeOwned<RTCScene> build_embree_discs(RTCDevice device, std::span<const sim::Disc> discs, EmbreeQuality quality,
                                         const std::stop_token& stop) {
  EmbreeOwned<RTCScene> scene(rtcNewScene(device));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
  rtcSetSceneBuildQuality(scene.get(), to_embree(quality));
  const EmbreeOwned<RTCGeometry> geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT));
  rtcSetGeometryBuildQuality(geometry.get(), to_embree(quality));
  float* vertex = new_buffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 4, discs.size());
  float* normal = new_buffer(geometry.get(), RTC_BUFFER_TYPE_NORMAL, RTC_FORMAT_FLOAT3, 3, discs.size());
  require_no_embree_error(device);
  sim::parallel_for(sim::ParallelRange(0, discs.size(), 4096), [&](const sim::ParallelRange& part) {
    for (std::size_t i = part.begin(); i < part.end(); ++i) {
      const sim::Disc& disc = discs[i];
      store_four(vertex + 4 * i, static_cast<float>(disc.centre.x), static_cast<float>(disc.centre.y),
                 static_cast<float>(disc.centre.z), static_cast<float>(disc.radius));
      for (int axis = 0; axis < 3; ++axis) normal[3 * i + axis] = static_cast<float>(disc.normal[axis]);
    }
  });
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene.get(), geometry.get());
  sim::embree::commit(device, scene.get(), stop, "building Embree's tree");
  return scene;
}

}  // namespace detp::validate
