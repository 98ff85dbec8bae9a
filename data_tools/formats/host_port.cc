// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/host_port.h"

#include <algorithm>
#include <stdexcept>

#include "geometry/base/check.h"

namespace bodyloom {

HostPort ParseHostPort(const std::string& text, int least_port) {
  const auto refuse = [&] {
    throw std::invalid_argument(
        Concatenate(text, ": expected a host and a port from ", least_port, " to 65535, as 127.0.0.1:8080"));
  };
  HostPort address;
  const size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0) refuse();
  address.host = text.substr(0, colon);
  const std::string port = text.substr(colon + 1);
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (port.empty() || port.size() > 5 || !std::all_of(port.begin(), port.end(), is_digit)) refuse();
  address.port = std::stoi(port);
  if (address.port < least_port || address.port > 65535) refuse();
  if (address.host.front() == '[') {
    if (address.host.size() < 3 || address.host.back() != ']') refuse();
    address.host = address.host.substr(1, address.host.size() - 2);
  } else if (address.host.find(':') != std::string::npos) {
    refuse();  // an IPv6 address without brackets, whose end is not known
  }
  return address;
}

std::string ToText(const HostPort& address) {
  const bool has_colon = address.host.find(':') != std::string::npos;
  return (has_colon ? "[" + address.host + "]" : address.host) + ":" + std::to_string(address.port);
}

}  // namespace bodyloom
