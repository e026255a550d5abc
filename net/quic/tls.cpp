#include "net/quic/tls.h"

#include <stdexcept>

#include "net/quic/udp_socket.h"
#include "net/wire/messages.h"

namespace slosh::quic {
namespace {

TlsPeer& peer_of(gnutls_session_t session) {
  auto* reference = static_cast<ngtcp2_crypto_conn_ref*>(gnutls_session_get_ptr(session));
  constexpr std::size_t kOffset = offsetof(TlsPeer, reference);
  return *reinterpret_cast<TlsPeer*>(reinterpret_cast<char*>(reference) - kOffset);
}

/// GnuTLS has checked by now, or checks next, that the other side holds the certificate's key. Which key
/// it must be is for us to say; names, dates and issuers mean nothing here.
int verify(gnutls_session_t session) {
  TlsPeer& peer = peer_of(session);
  unsigned count = 0;
  const gnutls_datum_t* chain = gnutls_certificate_get_peers(session, &count);
  if (!chain || count == 0) {
    peer.refusal = "the other side sent no certificate";
    return GNUTLS_E_CERTIFICATE_ERROR;
  }
  gnutls_x509_crt_t certificate = nullptr;
  if (gnutls_x509_crt_init(&certificate) < 0) return GNUTLS_E_CERTIFICATE_ERROR;
  std::optional<KeyFingerprint> found;
  if (gnutls_x509_crt_import(certificate, &chain[0], GNUTLS_X509_FMT_DER) >= 0)
    found = fingerprint_of(certificate);
  gnutls_x509_crt_deinit(certificate);
  if (!found) {
    peer.refusal = "the other side's certificate holds no Ed25519 key";
    return GNUTLS_E_CERTIFICATE_ERROR;
  }
  if (peer.expected && *peer.expected != *found) {
    peer.refusal = "the host's key is not the one in the link";
    return GNUTLS_E_CERTIFICATE_ERROR;
  }
  peer.found = found;
  return 0;
}

/// Before the library hears what a client says of itself: it shall look for no longer packets than ours, so
/// that a host's window may be as wide as a peer's (Connection::settings). What does not decode is left to
/// the library, which refuses it.
int shorten_packets(gnutls_session_t session, const gnutls_datum_t* hello) {
  TlsPeer& peer = peer_of(session);
  ngtcp2_conn* const conn = peer.reference.get_conn(&peer.reference);
  const auto take = [](void* conn_pointer, unsigned type, const unsigned char* data, unsigned size) {
    constexpr unsigned kTransportParameters = 0x39;  // RFC 9001, 8.2
    if (type == kTransportParameters)
      (void)take_client_parameters(static_cast<ngtcp2_conn*>(conn_pointer), data, size, kMaxPacket);
    return 0;
  };
  (void)gnutls_ext_raw_parse(conn, take, hello, GNUTLS_EXT_RAW_FLAG_TLS_CLIENT_HELLO);
  return 0;
}

/// ngtcp2 asserts when a ClientHello without QUIC's transport parameters is answered: it goes no further.
int check_client_hello(gnutls_session_t session, unsigned, unsigned when, unsigned,
                       const gnutls_datum_t* hello) {
  if (when == GNUTLS_HOOK_PRE) return shorten_packets(session, hello);
  TlsPeer& peer = peer_of(session);
  if (ngtcp2_conn_get_remote_transport_params(peer.reference.get_conn(&peer.reference))) return 0;
  peer.refusal = "the other side sent no QUIC transport parameters";
  return GNUTLS_E_MISSING_EXTENSION;
}

void check_tls(int code, const char* what) {
  if (code < 0) throw std::runtime_error(std::string("TLS ") + what + ": " + gnutls_strerror(code));
}

}  // namespace

TlsContext::TlsContext(const Identity& identity, TlsOddity oddity)
    : alpn_(oddity.alpn.empty() ? wire::kAlpn : oddity.alpn), identity_(identity) {
  check_tls(gnutls_certificate_allocate_credentials(&credentials_), "credentials");
  if (!oddity.no_certificate) {
    gnutls_x509_crt_t certificate = identity_.impl().certificate;
    check_tls(gnutls_certificate_set_x509_key(credentials_, &certificate, 1, identity_.impl().key), "key");
  }
  gnutls_certificate_set_verify_function(credentials_, verify);
  check_tls(gnutls_priority_init(
                &priority_,
                "NORMAL:-VERS-ALL:+VERS-TLS1.3:%DISABLE_TLS13_COMPAT_MODE:-CIPHER-ALL:+AES-128-GCM:"
                "+AES-256-GCM:+CHACHA20-POLY1305:-GROUP-ALL:+GROUP-X25519:+GROUP-SECP256R1:"
                "-SIGN-ALL:+SIGN-EDDSA-ED25519",
                nullptr),
            "settings");
}

TlsContext::~TlsContext() {
  if (priority_) gnutls_priority_deinit(priority_);
  if (credentials_) gnutls_certificate_free_credentials(credentials_);
}

gnutls_session_t TlsContext::open(bool server, TlsPeer& peer) const {
  gnutls_session_t session = nullptr;
  const unsigned flags = server ? GNUTLS_SERVER | GNUTLS_NO_AUTO_SEND_TICKET | GNUTLS_NO_END_OF_EARLY_DATA
                                : GNUTLS_CLIENT | GNUTLS_NO_END_OF_EARLY_DATA | GNUTLS_FORCE_CLIENT_CERT;
  if (gnutls_init(&session, flags) < 0) return nullptr;
  gnutls_datum_t alpn{reinterpret_cast<unsigned char*>(const_cast<char*>(alpn_.data())),
                      static_cast<unsigned>(alpn_.size())};
  const bool set = gnutls_priority_set(session, priority_) >= 0 &&
                   gnutls_credentials_set(session, GNUTLS_CRD_CERTIFICATE, credentials_) >= 0 &&
                   gnutls_alpn_set_protocols(session, &alpn, 1, GNUTLS_ALPN_MANDATORY) >= 0 &&
                   (server ? ngtcp2_crypto_gnutls_configure_server_session(session)
                           : ngtcp2_crypto_gnutls_configure_client_session(session)) == 0;
  if (!set) {
    gnutls_deinit(session);
    return nullptr;
  }
  if (server) {
    gnutls_certificate_server_set_request(session, GNUTLS_CERT_REQUIRE);
    gnutls_handshake_set_hook_function(session, GNUTLS_HANDSHAKE_CLIENT_HELLO, GNUTLS_HOOK_BOTH,
                                       check_client_hello);
  }
  gnutls_session_set_ptr(session, &peer.reference);
  return session;
}

bool TlsContext::protocol_agreed(gnutls_session_t session) const {
  gnutls_datum_t chosen{};
  return gnutls_alpn_get_selected_protocol(session, &chosen) >= 0 &&
         std::string_view(reinterpret_cast<const char*>(chosen.data), chosen.size) == alpn_;
}

std::string alert_words(std::uint8_t alert) {
  switch (alert) {
    case 116:
      return "it wants a certificate and got none";
    case 120:
      return "it speaks another version of slosh";
    case 109:
      return "it was not told the parameters of QUIC";
    case 42:
    case 43:
    case 46:
    case 48:
    case 49:
      return "it does not accept the key";
    case 70:
    case 71:
    case 40:
      return "no common way of encrypting";
    default: {
      const char* name = gnutls_alert_get_name(static_cast<gnutls_alert_description_t>(alert));
      return std::string("encryption failed: ") + (name ? name : "unknown alert") + " (" +
             std::to_string(alert) + ")";
    }
  }
}

}  // namespace slosh::quic
