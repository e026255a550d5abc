// What an Identity holds.
#pragma once

#include <gnutls/gnutls.h>
#include <gnutls/x509.h>

#include <optional>

#include "net/quic/endpoint.h"

namespace slosh {

struct Identity::Impl {
  gnutls_x509_privkey_t key = nullptr;
  gnutls_x509_crt_t certificate = nullptr;
  KeyFingerprint fingerprint{};

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl();
};

namespace quic {

/// The fingerprint of a certificate's key; none when it is not an Ed25519 key.
std::optional<KeyFingerprint> fingerprint_of(gnutls_x509_crt_t certificate);

}  // namespace quic
}  // namespace slosh
