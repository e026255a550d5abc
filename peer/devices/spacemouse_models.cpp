#include "peer/devices/spacemouse_models.h"

#include <algorithm>
#include <iterator>

namespace slosh {
namespace {

// By number; 256f:c650, c651, c654–c658, c664, c665, c668 and c62c are keypads, mice and keyboards: not here.
constexpr SpaceMouseModel kModels[] = {{0x046d, 0xc603, "SpaceMouse Plus XT USB"},
                                       {0x046d, 0xc605, "CadMan"},
                                       {0x046d, 0xc606, "SpaceMouse Classic"},
                                       {0x046d, 0xc621, "SpaceBall 5000"},
                                       {0x046d, 0xc623, "SpaceTraveler"},
                                       {0x046d, 0xc625, "SpacePilot"},
                                       {0x046d, 0xc626, "SpaceNavigator"},
                                       {0x046d, 0xc627, "SpaceExplorer"},
                                       {0x046d, 0xc628, "SpaceNavigator for Notebooks"},
                                       {0x046d, 0xc629, "SpacePilot Pro"},
                                       {0x046d, 0xc62b, "SpaceMouse Pro"},
                                       {0x046d, 0xc640, "NuLOOQ"},
                                       {0x256f, 0xc62e, "SpaceMouse Wireless (cable)"},
                                       {0x256f, 0xc62f, "SpaceMouse Wireless (receiver)"},
                                       {0x256f, 0xc631, "SpaceMouse Pro Wireless (cable)"},
                                       {0x256f, 0xc632, "SpaceMouse Pro Wireless (receiver)"},
                                       {0x256f, 0xc633, "SpaceMouse Enterprise"},
                                       {0x256f, 0xc635, "SpaceMouse Compact"},
                                       {0x256f, 0xc636, "SpaceMouse Module"},
                                       {0x256f, 0xc638, "SpaceMouse Pro Wireless BT (cable)"},
                                       {0x256f, 0xc63a, "SpaceMouse Wireless BT (cable)"},
                                       {0x256f, 0xc652, "Universal Receiver"}};

}  // namespace

const SpaceMouseModel* spacemouse_model(std::uint16_t vendor, std::uint16_t product) {
  const auto* const at = std::find_if(std::begin(kModels), std::end(kModels), [&](const SpaceMouseModel& m) {
    return m.vendor == vendor && m.product == product;
  });
  return at == std::end(kModels) ? nullptr : at;
}

}  // namespace slosh
