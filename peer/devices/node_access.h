// Whether this user may open a device's node.
#pragma once

#include <string>

#include "sim/math/result.h"

namespace slosh {

/// `wanted`: R_OK, or R_OK | W_OK. Errors: the node is not there, or node_denied().
Result<bool> check_node_access(const std::string& path, int wanted);
/// It is there and this user may not: what the udev rule mends.
bool node_denied(const std::string& path, int wanted);

}  // namespace slosh
