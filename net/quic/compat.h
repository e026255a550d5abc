// What ngtcp2 0.12 and ngtcp2 1.x call differently. Nothing else asks for the library's version.
#pragma once

#include <ngtcp2/ngtcp2.h>
#include <ngtcp2/ngtcp2_crypto.h>
#include <ngtcp2/ngtcp2_crypto_gnutls.h>

#include <algorithm>
#include <cstdint>
#include <string>

namespace slosh::quic {

/// How a connection ended, as the library has it.
struct CloseFrame {
  bool application = false;
  std::uint64_t code = 0;
  std::string text;
};

/// What the library knows of a path's quality. Times in s, rates in bytes a s; 0 = unknown.
struct PathFigures {
  double smoothed_rtt = 0.0;
  double rtt_variance = 0.0;
  double min_rtt = 0.0;
  double latest_rtt = 0.0;
  std::uint64_t window = 0;
  std::uint64_t in_flight = 0;
  double delivery_rate = 0.0;  // measured by DeliveredRate, not by the library
  double pacing_rate = 0.0;
};

/// Before 0.14 ngtcp2 arms no probe timeout for packets that hold nothing but datagrams (its issue 697): when
/// the acknowledgements of a full window are lost, nothing moves again.
#if NGTCP2_VERSION_NUM >= 0x000e00
constexpr bool kDatagramsAreProbed = true;
#else
constexpr bool kDatagramsAreProbed = false;
#endif

#if NGTCP2_VERSION_NUM >= 0x010000

using CloseError = ngtcp2_ccerr;
constexpr ngtcp2_cc_algo kCongestionControl = NGTCP2_CC_ALGO_BBR;  // 1.x has version 2 under this name

inline void set_application_error(CloseError& error, std::uint64_t code, const std::string& text) {
  ngtcp2_ccerr_default(&error);
  ngtcp2_ccerr_set_application_error(&error, code, reinterpret_cast<const std::uint8_t*>(text.data()),
                                     text.size());
}
inline void set_library_error(CloseError& error, int code) {
  ngtcp2_ccerr_default(&error);
  ngtcp2_ccerr_set_liberr(&error, code, nullptr, 0);
}
inline void set_transport_error(CloseError& error, std::uint64_t code, const std::string& text) {
  ngtcp2_ccerr_default(&error);
  ngtcp2_ccerr_set_transport_error(&error, code, reinterpret_cast<const std::uint8_t*>(text.data()),
                                   text.size());
}
inline void set_tls_alert(CloseError& error, std::uint8_t alert) {
  ngtcp2_ccerr_default(&error);
  ngtcp2_ccerr_set_tls_alert(&error, alert, nullptr, 0);
}
inline CloseFrame received_close(ngtcp2_conn* conn) {
  const ngtcp2_ccerr* error = ngtcp2_conn_get_ccerr(conn);
  return {error->type == NGTCP2_CCERR_TYPE_APPLICATION, error->error_code,
          std::string(reinterpret_cast<const char*>(error->reason), error->reasonlen)};
}
inline void set_token(ngtcp2_settings& settings, const std::uint8_t* token, std::size_t size) {
  settings.token = token;
  settings.tokenlen = size;
  settings.token_type = NGTCP2_TOKEN_TYPE_RETRY;
}
inline void set_original_dcid(ngtcp2_transport_params& params, const ngtcp2_cid& cid) {
  params.original_dcid = cid;
  params.original_dcid_present = 1;
}
inline void token_of(const ngtcp2_pkt_hd& header, const std::uint8_t*& token, std::size_t& size) {
  token = header.token;
  size = header.tokenlen;
}
inline PathFigures path_figures(ngtcp2_conn* conn) {
  ngtcp2_conn_info info;
  ngtcp2_conn_get_conn_info(conn, &info);
  PathFigures figures;
  figures.smoothed_rtt = 1e-9 * static_cast<double>(info.smoothed_rtt);
  figures.rtt_variance = 1e-9 * static_cast<double>(info.rttvar);
  figures.min_rtt = info.min_rtt == UINT64_MAX ? 0.0 : 1e-9 * static_cast<double>(info.min_rtt);
  figures.latest_rtt = 1e-9 * static_cast<double>(info.latest_rtt);
  figures.window = info.cwnd;
  figures.in_flight = info.bytes_in_flight;
  return figures;
}

/// Tells the library what a client says of itself, before the library's own glue does, which then changes
/// nothing: but for packets, of which none longer than `longest` is wanted. Not 0 on a failure.
inline int take_client_parameters(ngtcp2_conn* conn, const std::uint8_t* data, std::size_t size,
                                  std::uint64_t longest) {
  ngtcp2_transport_params params;
  if (const int code = ngtcp2_transport_params_decode(&params, data, size); code != 0) return code;
  params.max_udp_payload_size = std::min<std::uint64_t>(params.max_udp_payload_size, longest);
  std::uint8_t out[1024];
  const ngtcp2_ssize written = ngtcp2_transport_params_encode(out, sizeof(out), &params);
  if (written < 0) return static_cast<int>(written);
  return ngtcp2_conn_decode_and_set_remote_transport_params(conn, out, static_cast<std::size_t>(written));
}

// Callbacks whose arguments changed: SLOSH_PATH_VALIDATION(name) opens one with `path` and `result`.
#define SLOSH_PATH_VALIDATION(name)                                                  \
  int name(ngtcp2_conn*, std::uint32_t, const ngtcp2_path* path, const ngtcp2_path*, \
           ngtcp2_path_validation_result result, void* user)

#else

using CloseError = ngtcp2_connection_close_error;
constexpr ngtcp2_cc_algo kCongestionControl = NGTCP2_CC_ALGO_BBR2;

inline void set_application_error(CloseError& error, std::uint64_t code, const std::string& text) {
  ngtcp2_connection_close_error_default(&error);
  ngtcp2_connection_close_error_set_application_error(
      &error, code, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}
inline void set_library_error(CloseError& error, int code) {
  ngtcp2_connection_close_error_default(&error);
  ngtcp2_connection_close_error_set_transport_error_liberr(&error, code, nullptr, 0);
}
inline void set_transport_error(CloseError& error, std::uint64_t code, const std::string& text) {
  ngtcp2_connection_close_error_default(&error);
  ngtcp2_connection_close_error_set_transport_error(
      &error, code, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}
inline void set_tls_alert(CloseError& error, std::uint8_t alert) {
  ngtcp2_connection_close_error_default(&error);
  ngtcp2_connection_close_error_set_transport_error_tls_alert(&error, alert, nullptr, 0);
}
inline CloseFrame received_close(ngtcp2_conn* conn) {
  ngtcp2_connection_close_error error;
  ngtcp2_conn_get_connection_close_error(conn, &error);
  return {error.type == NGTCP2_CONNECTION_CLOSE_ERROR_CODE_TYPE_APPLICATION, error.error_code,
          std::string(reinterpret_cast<const char*>(error.reason), error.reasonlen)};
}
inline void set_token(ngtcp2_settings& settings, const std::uint8_t* token, std::size_t size) {
  settings.token.base = const_cast<std::uint8_t*>(token);  // the library copies it
  settings.token.len = size;
}
inline void set_original_dcid(ngtcp2_transport_params& params, const ngtcp2_cid& cid) {
  params.original_dcid = cid;
}
inline void token_of(const ngtcp2_pkt_hd& header, const std::uint8_t*& token, std::size_t& size) {
  token = header.token.base;
  size = header.token.len;
}
inline PathFigures path_figures(ngtcp2_conn* conn) {
  ngtcp2_conn_stat stat;
  ngtcp2_conn_get_conn_stat(conn, &stat);
  PathFigures figures;
  figures.smoothed_rtt = 1e-9 * static_cast<double>(stat.smoothed_rtt);
  figures.rtt_variance = 1e-9 * static_cast<double>(stat.rttvar);
  figures.min_rtt = stat.min_rtt == UINT64_MAX ? 0.0 : 1e-9 * static_cast<double>(stat.min_rtt);
  figures.latest_rtt = 1e-9 * static_cast<double>(stat.latest_rtt);
  figures.window = stat.cwnd;
  figures.in_flight = stat.bytes_in_flight;
  figures.pacing_rate = stat.pacing_rate * 1e9;  // the library counts in bytes a ns
  return figures;
}

inline int take_client_parameters(ngtcp2_conn* conn, const std::uint8_t* data, std::size_t size,
                                  std::uint64_t longest) {
  constexpr ngtcp2_transport_params_type kHello = NGTCP2_TRANSPORT_PARAMS_TYPE_CLIENT_HELLO;
  ngtcp2_transport_params params;
  if (const int code = ngtcp2_decode_transport_params(&params, kHello, data, size); code != 0) return code;
  params.max_udp_payload_size = std::min<std::uint64_t>(params.max_udp_payload_size, longest);
  std::uint8_t out[1024];
  const ngtcp2_ssize written = ngtcp2_encode_transport_params(out, sizeof(out), kHello, &params);
  if (written < 0) return static_cast<int>(written);
  return ngtcp2_conn_decode_remote_transport_params(conn, out, static_cast<std::size_t>(written));
}

#define SLOSH_PATH_VALIDATION(name)                                                                    \
  int name(ngtcp2_conn*, std::uint32_t, const ngtcp2_path* path, ngtcp2_path_validation_result result, \
           void* user)

#endif

}  // namespace slosh::quic
