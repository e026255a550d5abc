#include "peer/devices/node_access.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace slosh {

Result<bool> check_node_access(const std::string& path, int wanted) {
  if (access(path.c_str(), wanted) == 0) return true;
  const int why = errno;
  const bool denied = why == EACCES || why == EPERM;
  return Error{path, denied ? "this user may not open it" : std::strerror(why),
               denied ? "Install the udev rule once (`./slosh devices --install-udev-rule`) and plug the "
                        "device in again"
                      : "Plug the device in again"};
}

bool node_denied(const std::string& path, int wanted) {
  return access(path.c_str(), wanted) != 0 && (errno == EACCES || errno == EPERM);
}

}  // namespace slosh
