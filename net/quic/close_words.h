// Why a connection ended, in words.
#pragma once

#include <string>

#include "net/quic/address.h"
#include "net/quic/compat.h"

namespace slosh::quic {

std::string timed_out_words(double seconds);
/// `received`: something came, but not enough for a connection. `send_error`: errno of sending, or 0.
std::string no_answer_words(const Address& address, double seconds, int send_error, bool received);
/// An error of ours, as the library has it.
std::string library_words(int code);
/// The other side's transport error. `to_server`: it is a client that closed.
std::string transport_words(const CloseFrame& frame, bool to_server);
/// What the other side wrote, fit to be shown (net/text/clean.h).
std::string printable(const std::string& text);

}  // namespace slosh::quic
