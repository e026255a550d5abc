#include <stdexcept>

#include "net/quic/identity_impl.h"
#include "net/random.h"

namespace slosh {
namespace {

void check(int code, const char* what) {
  if (code < 0) throw std::runtime_error(std::string(what) + ": " + gnutls_strerror(code));
}

/// Signs a certificate for `impl.key`. Nobody reads its dates or names: the key alone is who somebody is.
void certify(Identity::Impl& impl) {
  check(gnutls_x509_crt_init(&impl.certificate), "certificate");
  gnutls_x509_crt_t certificate = impl.certificate;
  std::uint8_t serial[16];
  fill_random(serial);
  serial[0] &= 0x7f;  // a serial number is positive
  serial[0] |= 0x01;
  check(gnutls_x509_crt_set_version(certificate, 3), "certificate version");
  check(gnutls_x509_crt_set_serial(certificate, serial, sizeof(serial)), "certificate serial");
  check(gnutls_x509_crt_set_dn_by_oid(certificate, GNUTLS_OID_X520_COMMON_NAME, 0, "slosh", 5),
        "certificate name");
  constexpr time_t kFrom = 946684800;      // 2000
  constexpr time_t kUntil = 253402300799;  // 9999, RFC 5280's "no end"
  check(gnutls_x509_crt_set_activation_time(certificate, kFrom), "certificate date");
  check(gnutls_x509_crt_set_expiration_time(certificate, kUntil), "certificate date");
  check(gnutls_x509_crt_set_key(certificate, impl.key), "certificate key");
  check(gnutls_x509_crt_sign2(certificate, certificate, impl.key, GNUTLS_DIG_SHA512, 0),
        "certificate signature");
  const auto fingerprint = quic::fingerprint_of(certificate);
  if (!fingerprint) throw std::runtime_error("certificate: no fingerprint");
  impl.fingerprint = *fingerprint;
}

}  // namespace

Identity::Impl::~Impl() {
  if (certificate) gnutls_x509_crt_deinit(certificate);
  if (key) gnutls_x509_privkey_deinit(key);
}

namespace quic {

std::optional<KeyFingerprint> fingerprint_of(gnutls_x509_crt_t certificate) {
  if (gnutls_x509_crt_get_pk_algorithm(certificate, nullptr) != GNUTLS_PK_EDDSA_ED25519) return std::nullopt;
  KeyFingerprint fingerprint;
  std::size_t size = fingerprint.size();
  if (gnutls_x509_crt_get_key_id(certificate, GNUTLS_KEYID_USE_SHA256, fingerprint.data(), &size) < 0 ||
      size != fingerprint.size())
    return std::nullopt;
  return fingerprint;
}

}  // namespace quic

Identity Identity::generate() {
  auto impl = std::make_shared<Impl>();
  check(gnutls_x509_privkey_init(&impl->key), "private key");
  check(gnutls_x509_privkey_generate(impl->key, GNUTLS_PK_EDDSA_ED25519, 0, 0), "private key");
  certify(*impl);
  Identity identity;
  identity.impl_ = std::move(impl);
  return identity;
}

Result<Identity> Identity::from_private_key(std::span<const std::uint8_t> bytes) {
  const auto error = [](const char* what) {
    return Error{"private key", what, "Remove the key file: a new key is made, and others see a new person"};
  };
  auto impl = std::make_shared<Impl>();
  if (gnutls_x509_privkey_init(&impl->key) < 0) return error("no memory for it");
  const gnutls_datum_t data{const_cast<std::uint8_t*>(bytes.data()), static_cast<unsigned>(bytes.size())};
  if (gnutls_x509_privkey_import_pkcs8(impl->key, &data, GNUTLS_X509_FMT_DER, nullptr, GNUTLS_PKCS_PLAIN) < 0)
    return error("it is not a PKCS #8 key");
  if (gnutls_x509_privkey_get_pk_algorithm(impl->key) != GNUTLS_PK_EDDSA_ED25519)
    return error("it is not an Ed25519 key");
  try {
    certify(*impl);
  } catch (const std::runtime_error&) {
    return error("no certificate can be made from it");
  }
  Identity identity;
  identity.impl_ = std::move(impl);
  return identity;
}

std::vector<std::uint8_t> Identity::private_key() const {
  gnutls_datum_t out{nullptr, 0};
  check(gnutls_x509_privkey_export2_pkcs8(impl_->key, GNUTLS_X509_FMT_DER, nullptr, GNUTLS_PKCS_PLAIN, &out),
        "private key");
  std::vector<std::uint8_t> bytes(out.data, out.data + out.size);
  gnutls_memset(out.data, 0, out.size);
  gnutls_free(out.data);
  return bytes;
}

const KeyFingerprint& Identity::fingerprint() const {
  return impl_->fingerprint;
}

}  // namespace slosh
