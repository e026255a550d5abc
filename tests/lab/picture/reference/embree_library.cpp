#include "tests/lab/picture/reference/embree_library.h"

#include <dlfcn.h>

namespace slosh::reference {
namespace {

/// Sets `function`; false where the library has none of that name.
template <typename Function>
bool take(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  return function != nullptr;
}

EmbreeLibrary open(bool& whole) {
  EmbreeLibrary e;
  void* library = dlopen(embree_library_name(), RTLD_NOW | RTLD_LOCAL);
  whole = library && take(library, "rtcNewDevice", e.new_device) &&
          take(library, "rtcReleaseDevice", e.release_device) && take(library, "rtcNewScene", e.new_scene) &&
          take(library, "rtcReleaseScene", e.release_scene) &&
          take(library, "rtcSetSceneFlags", e.set_scene_flags) &&
          take(library, "rtcCommitScene", e.commit_scene) &&
          take(library, "rtcNewGeometry", e.new_geometry) &&
          take(library, "rtcSetNewGeometryBuffer", e.set_new_geometry_buffer) &&
          take(library, "rtcCommitGeometry", e.commit_geometry) &&
          take(library, "rtcAttachGeometryByID", e.attach_geometry_by_id) &&
          take(library, "rtcReleaseGeometry", e.release_geometry) &&
          take(library, "rtcIntersect1", e.intersect_1);
  return e;
}

}  // namespace

const char* embree_library_name() {
  return RTC_VERSION_MAJOR >= 4 ? "libembree4.so.4" : "libembree3.so.3";
}

const EmbreeLibrary* embree_library() {
  static bool whole = false;
  static const EmbreeLibrary library = open(whole);
  return whole ? &library : nullptr;
}

}  // namespace slosh::reference
