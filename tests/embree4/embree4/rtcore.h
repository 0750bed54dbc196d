#pragma once

// Declarations of Embree 4 that the project uses, written from its manual pages, so that the project's sources can be compiled for
// Embree 4 where it is not installed. They can't be linked.

#include <cstddef>

struct RTCDeviceTy;
struct RTCSceneTy;
struct RTCGeometryTy;
struct RTCRayN;
struct RTCHitN;
struct RTCRayHitN;
using RTCDevice = RTCDeviceTy*;
using RTCScene = RTCSceneTy*;
using RTCGeometry = RTCGeometryTy*;

enum RTCError {
  RTC_ERROR_NONE,
  RTC_ERROR_UNKNOWN,
  RTC_ERROR_INVALID_ARGUMENT,
  RTC_ERROR_INVALID_OPERATION,
  RTC_ERROR_OUT_OF_MEMORY,
  RTC_ERROR_UNSUPPORTED_CPU,
  RTC_ERROR_CANCELLED
};
enum RTCBuildQuality { RTC_BUILD_QUALITY_LOW, RTC_BUILD_QUALITY_MEDIUM, RTC_BUILD_QUALITY_HIGH };
enum RTCSceneFlags {
  RTC_SCENE_FLAG_NONE = 0,
  RTC_SCENE_FLAG_ROBUST = 4,
  RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS = 8
};
enum RTCRayQueryFlags {
  RTC_RAY_QUERY_FLAG_NONE = 0,
  RTC_RAY_QUERY_FLAG_INCOHERENT = 0,
  RTC_RAY_QUERY_FLAG_COHERENT = 1 << 16,
  RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER = 1 << 1
};
enum RTCGeometryType { RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT, RTC_GEOMETRY_TYPE_USER };
enum RTCBufferType { RTC_BUFFER_TYPE_VERTEX, RTC_BUFFER_TYPE_NORMAL };
enum RTCFormat { RTC_FORMAT_FLOAT3, RTC_FORMAT_FLOAT4 };
constexpr unsigned RTC_INVALID_GEOMETRY_ID = static_cast<unsigned>(-1);

struct RTCBounds {
  float lower_x, lower_y, lower_z, align0;
  float upper_x, upper_y, upper_z, align1;
};
struct alignas(16) RTCRay {
  float org_x, org_y, org_z, tnear;
  float dir_x, dir_y, dir_z, time;
  float tfar;
  unsigned mask, id, flags;
};
struct alignas(16) RTCHit {
  float Ng_x, Ng_y, Ng_z, u, v;
  unsigned primID, geomID, instID[1];
};
struct RTCRayHit {
  RTCRay ray;
  RTCHit hit;
};

template <std::size_t width>
struct alignas(4 * width) RTCRayPacket {
  float org_x[width], org_y[width], org_z[width], tnear[width];
  float dir_x[width], dir_y[width], dir_z[width], time[width];
  float tfar[width];
  unsigned mask[width], id[width], flags[width];
};
template <std::size_t width>
struct alignas(4 * width) RTCHitPacket {
  float Ng_x[width], Ng_y[width], Ng_z[width], u[width], v[width];
  unsigned primID[width], geomID[width], instID[1][width];
};
template <std::size_t width>
struct RTCRayHitPacket {
  RTCRayPacket<width> ray;
  RTCHitPacket<width> hit;
};
using RTCRay8 = RTCRayPacket<8>;
using RTCRay16 = RTCRayPacket<16>;
using RTCRayHit8 = RTCRayHitPacket<8>;
using RTCRayHit16 = RTCRayHitPacket<16>;

struct RTCRayQueryContext {
  unsigned instID[1];
};
struct RTCBoundsFunctionArguments {
  void* geometryUserPtr;
  unsigned primID, timeStep;
  RTCBounds* bounds_o;
};
struct RTCIntersectFunctionNArguments;
struct RTCOccludedFunctionNArguments {
  int* valid;
  void* geometryUserPtr;
  unsigned primID;
  RTCRayQueryContext* context;
  RTCRayN* ray;
  unsigned N, geomID;
};
struct RTCFilterFunctionNArguments {
  int* valid;
  void* geometryUserPtr;
  RTCRayQueryContext* context;
  RTCRayN* ray;
  RTCHitN* hit;
  unsigned N;
};
using RTCBoundsFunction = void (*)(const RTCBoundsFunctionArguments*);
using RTCIntersectFunctionN = void (*)(const RTCIntersectFunctionNArguments*);
using RTCOccludedFunctionN = void (*)(const RTCOccludedFunctionNArguments*);
using RTCFilterFunctionN = void (*)(const RTCFilterFunctionNArguments*);
using RTCProgressMonitorFunction = bool (*)(void*, double);

struct RTCIntersectArguments {
  RTCRayQueryFlags flags;
  unsigned feature_mask;
  RTCRayQueryContext* context;
  RTCFilterFunctionN filter;
  RTCIntersectFunctionN intersect;
};
struct RTCOccludedArguments {
  RTCRayQueryFlags flags;
  unsigned feature_mask;
  RTCRayQueryContext* context;
  RTCFilterFunctionN filter;
  RTCOccludedFunctionN occluded;
};

float& RTCRayN_tfar(RTCRayN* ray, unsigned N, unsigned i);
unsigned& RTCRayN_id(RTCRayN* ray, unsigned N, unsigned i);
unsigned& RTCHitN_primID(RTCHitN* hit, unsigned N, unsigned i);

extern "C" {
RTCDevice rtcNewDevice(const char* config);
void rtcReleaseDevice(RTCDevice device);
RTCError rtcGetDeviceError(RTCDevice device);
RTCScene rtcNewScene(RTCDevice device);
void rtcReleaseScene(RTCScene scene);
void rtcSetSceneFlags(RTCScene scene, RTCSceneFlags flags);
void rtcSetSceneBuildQuality(RTCScene scene, RTCBuildQuality quality);
void rtcSetSceneProgressMonitorFunction(RTCScene scene, RTCProgressMonitorFunction progress, void* ptr);
void rtcCommitScene(RTCScene scene);
void rtcGetSceneBounds(RTCScene scene, RTCBounds* bounds_o);
RTCGeometry rtcNewGeometry(RTCDevice device, RTCGeometryType type);
void rtcReleaseGeometry(RTCGeometry geometry);
void rtcSetGeometryBuildQuality(RTCGeometry geometry, RTCBuildQuality quality);
void rtcSetGeometryUserPrimitiveCount(RTCGeometry geometry, unsigned count);
void rtcSetGeometryUserData(RTCGeometry geometry, void* ptr);
void rtcSetGeometryBoundsFunction(RTCGeometry geometry, RTCBoundsFunction bounds, void* userPtr);
void rtcSetGeometryOccludedFunction(RTCGeometry geometry, RTCOccludedFunctionN occluded);
void* rtcSetNewGeometryBuffer(RTCGeometry geometry, RTCBufferType type, unsigned slot, RTCFormat format,
                              std::size_t stride, std::size_t count);
void rtcCommitGeometry(RTCGeometry geometry);
unsigned rtcAttachGeometry(RTCScene scene, RTCGeometry geometry);
void rtcInitRayQueryContext(RTCRayQueryContext* context);
void rtcInitIntersectArguments(RTCIntersectArguments* args);
void rtcInitOccludedArguments(RTCOccludedArguments* args);
void rtcIntersect1(RTCScene scene, RTCRayHit* rayhit, RTCIntersectArguments* args = nullptr);
void rtcIntersect8(const int* valid, RTCScene scene, RTCRayHit8* rayhit, RTCIntersectArguments* args = nullptr);
void rtcIntersect16(const int* valid, RTCScene scene, RTCRayHit16* rayhit, RTCIntersectArguments* args = nullptr);
void rtcOccluded1(RTCScene scene, RTCRay* ray, RTCOccludedArguments* args = nullptr);
void rtcOccluded8(const int* valid, RTCScene scene, RTCRay8* ray, RTCOccludedArguments* args = nullptr);
void rtcOccluded16(const int* valid, RTCScene scene, RTCRay16* ray, RTCOccludedArguments* args = nullptr);
}
