#include "net/quic/close_words.h"

#include <cerrno>
#include <cstdio>

#include "net/quic/tls.h"
#include "net/text/clean.h"

namespace slosh::quic {
namespace {

std::string in_seconds(double seconds) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g s", seconds);
  return text;
}

}  // namespace

std::string timed_out_words(double seconds) {
  return "timed out: nothing heard for " + in_seconds(seconds);
}

std::string no_answer_words(const Address& address, double seconds, int send_error, bool received) {
  if (received)
    return address.text() + " answers, but no connection came about within " + in_seconds(seconds);
  std::string words = "no answer from " + address.text() + " within " + in_seconds(seconds);
  if (send_error == ECONNREFUSED) words += ": nothing listens there";
  if (send_error == ENETUNREACH || send_error == EHOSTUNREACH) words += ": there is no way to it";
  if (send_error == EPERM || send_error == EACCES) words += ": a firewall here does not let us";
  return words;
}

std::string library_words(int code) {
  switch (code) {
    case NGTCP2_ERR_RECV_VERSION_NEGOTIATION:
    case NGTCP2_ERR_VERSION_NEGOTIATION_FAILURE:
      return "the other side speaks another version of QUIC";
    case NGTCP2_ERR_NO_VIABLE_PATH:
      return "the new address does not answer";
    default:
      return std::string("the other side broke the rules of QUIC (") + ngtcp2_strerror(code) + ")";
  }
}

std::string transport_words(const CloseFrame& frame, bool to_server) {
  const std::string who = to_server ? "the peer" : "the host";
  if (frame.code >= NGTCP2_CRYPTO_ERROR && frame.code < NGTCP2_CRYPTO_ERROR + 256)
    return who + " refused: " + alert_words(static_cast<std::uint8_t>(frame.code - NGTCP2_CRYPTO_ERROR));
  if (frame.code == NGTCP2_CONNECTION_REFUSED)
    return frame.text.empty() ? who + " refused: it is full" : printable(frame.text);
  if (frame.code == NGTCP2_NO_ERROR) return who + " closed the connection";
  return who + " closed the connection: error " + std::to_string(frame.code) +
         (frame.text.empty() ? "" : " (" + printable(frame.text) + ")");
}

std::string printable(const std::string& text) {
  return clean_text(text, kMaxTextBytes);
}

}  // namespace slosh::quic
