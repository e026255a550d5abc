// ngtcp2's callbacks into a Connection.
#pragma once

#include "net/quic/compat.h"

namespace slosh::quic {

ngtcp2_callbacks connection_callbacks();

}  // namespace slosh::quic
