// TLS 1.3 with our own certificates: sessions for ngtcp2, and who is at the other end.
#pragma once

#include <gnutls/gnutls.h>

#include <memory>
#include <optional>
#include <string>

#include "net/quic/compat.h"
#include "net/quic/identity_impl.h"

namespace slosh::quic {

/// What the verification of the other side's certificate found. One a connection, at a fixed address.
struct TlsPeer {
  std::optional<KeyFingerprint> expected;  ///< pinned; none = anybody with an Ed25519 key
  std::optional<KeyFingerprint> found;
  std::string refusal;                 ///< words, when we refused
  ngtcp2_crypto_conn_ref reference{};  ///< what ngtcp2's GnuTLS glue finds the connection by
};

/// A departure from the rules, for tests of what the other side makes of it.
struct TlsOddity {
  bool no_certificate = false;
  std::string alpn;  ///< in place of wire::kAlpn
};

/// Credentials and settings, shared by all sessions of an endpoint.
class TlsContext {
 public:
  /// Throws std::runtime_error when the system's settings forbid what we need.
  explicit TlsContext(const Identity& identity, TlsOddity oddity = {});
  ~TlsContext();
  TlsContext(const TlsContext&) = delete;
  TlsContext& operator=(const TlsContext&) = delete;

  /// A session whose user pointer leads to `peer`; null when out of memory. The caller frees it.
  gnutls_session_t open(bool server, TlsPeer& peer) const;
  /// Whether the application protocol that was agreed on is ours.
  bool protocol_agreed(gnutls_session_t session) const;

 private:
  std::string alpn_;
  gnutls_certificate_credentials_t credentials_ = nullptr;
  gnutls_priority_t priority_ = nullptr;
  Identity identity_;
};

inline constexpr char kTlsMend[] =
    "Allow TLS 1.3 with Ed25519 and X25519 in the system's settings of GnuTLS (FIPS mode forbids them)";

/// A TLS alert in words that a person can act on.
std::string alert_words(std::uint8_t alert);

}  // namespace slosh::quic
