// Random bytes that nobody can guess.
#pragma once

#include <gnutls/crypto.h>
#include <gnutls/gnutls.h>

#include <cstdint>
#include <cstdlib>
#include <span>

namespace slosh::quic {

inline void fill_random(std::span<std::uint8_t> out) {
  // Without random numbers there are no keys: nothing sensible can follow.
  if (gnutls_rnd(GNUTLS_RND_RANDOM, out.data(), out.size()) < 0) std::abort();
}

}  // namespace slosh::quic
