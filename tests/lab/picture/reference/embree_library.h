// Embree, opened by name where a reference picture is drawn: what is installed needs it for nothing else, so
// it does not depend on it. Its headers must be there where slosh is built (SLOSH_EMBREE).
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace slosh::reference {

/// The functions of Embree's that are called, by Embree's own names without their rtc.
struct EmbreeLibrary {
  decltype(&::rtcNewDevice) new_device = nullptr;
  decltype(&::rtcReleaseDevice) release_device = nullptr;
  decltype(&::rtcNewScene) new_scene = nullptr;
  decltype(&::rtcReleaseScene) release_scene = nullptr;
  decltype(&::rtcSetSceneFlags) set_scene_flags = nullptr;
  decltype(&::rtcCommitScene) commit_scene = nullptr;
  decltype(&::rtcNewGeometry) new_geometry = nullptr;
  decltype(&::rtcSetNewGeometryBuffer) set_new_geometry_buffer = nullptr;
  decltype(&::rtcCommitGeometry) commit_geometry = nullptr;
  decltype(&::rtcAttachGeometryByID) attach_geometry_by_id = nullptr;
  decltype(&::rtcReleaseGeometry) release_geometry = nullptr;
  decltype(&::rtcIntersect1) intersect_1 = nullptr;
};

/// libembree3.so.3 or libembree4.so.4, whichever the headers are of; nullptr where it is not installed or
/// lacks a function. Looked for once; it stays open. From any thread.
const EmbreeLibrary* embree_library();

/// Its file's name.
const char* embree_library_name();

}  // namespace slosh::reference
