#include "render/xr/xr.h"

#include <openxr/openxr_reflection.h>

namespace slosh::xr {

std::string result_name(XrResult result) {
  switch (result) {
#define SLOSH_NAME(name, value) \
  case name:                    \
    return #name;
    XR_LIST_ENUM_XrResult(SLOSH_NAME)
#undef SLOSH_NAME
            default : return "result " +
                      std::to_string(static_cast<int>(result));
  }
}

Error failed(const char* call, XrResult result) {
  return {"headset", std::string(call) + " failed: " + result_name(result),
          "Is the runtime up (Monado: monado-service; SteamVR: its window), and the headset awake?"};
}

}  // namespace slosh::xr
