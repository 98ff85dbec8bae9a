// SPDX-License-Identifier: Apache-2.0
/// Network addresses as users write them: "127.0.0.1:8080", "localhost:8080", "[::1]:8080".
#pragma once

#include <string>

namespace bodyloom {

struct HostPort {
  std::string host;  ///< without brackets
  int port = 0;
};

/// Throws std::invalid_argument "text: …" unless it is a host, a colon and a port from `least_port` (0: any free one)
/// to 65535.
HostPort ParseHostPort(const std::string& text, int least_port);

/// The inverse: with brackets around an IPv6 address.
std::string ToText(const HostPort& address);

}  // namespace bodyloom
