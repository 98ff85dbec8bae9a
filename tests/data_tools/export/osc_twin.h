// SPDX-License-Identifier: Apache-2.0
/// A reader of Open Sound Control that shares no code with liblo, and a plain socket that receives it.
/// Source: opensoundcontrol.org, OSC 1.0 specification.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace bodyloom {

struct OscMessage {
  std::string path, types;
  std::vector<std::string> strings;
  std::vector<double> numbers;  ///< of i and f
};

/// Adds the messages of a packet; false when it is none.
inline bool ReadOsc(std::string_view packet, std::vector<OscMessage>* messages) {
  const auto number = [](std::string_view bytes) {
    uint32_t value = 0;
    for (const char c : bytes.substr(0, 4)) value = value << 8 | uint8_t(c);
    return value;
  };
  if (packet.size() % 4 != 0) return false;
  if (packet.starts_with(std::string_view("#bundle\0", 8))) {
    for (size_t at = 16; at < packet.size();) {
      const size_t size = number(packet.substr(at));
      if (at + 4 + size > packet.size() || !ReadOsc(packet.substr(at + 4, size), messages)) return false;
      at += 4 + size;
    }
    return packet.size() >= 16;
  }
  size_t at = 0;
  const auto text = [&] {
    const size_t end = packet.find('\0', at);
    if (end == std::string_view::npos) return std::string("?");
    std::string found(packet.substr(at, end - at));
    at = end / 4 * 4 + 4;
    return found;
  };
  OscMessage message;
  message.path = text();
  message.types = text();
  if (!message.path.starts_with('/') || !message.types.starts_with(',')) return false;
  for (const char type : message.types.substr(1)) {
    if (type == 's') {
      message.strings.push_back(text());
      continue;
    }
    if (at + 4 > packet.size()) return false;
    const uint32_t bits = number(packet.substr(at));
    at += 4;
    if (type != 'i' && type != 'f') return false;
    message.numbers.push_back(type == 'i' ? double(int32_t(bits)) : double(std::bit_cast<float>(bits)));
  }
  messages->push_back(std::move(message));
  return at == packet.size();
}

/// A socket at a free port of 127.0.0.1.
class UdpReceiver {
 public:
  UdpReceiver() : socket_(socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    port_ = ntohs(address.sin_port);
  }
  ~UdpReceiver() { close(socket_); }
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  [[nodiscard]] std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
  /// Messages of all packets that have come, and sizes of these.
  std::vector<OscMessage> Receive(std::vector<size_t>* sizes = nullptr) const {
    std::vector<OscMessage> messages;
    std::string packet(65536, '\0');
    for (;;) {
      pollfd ready = {socket_, POLLIN, 0};
      if (poll(&ready, 1, 0) <= 0) return messages;
      const ssize_t size = recv(socket_, packet.data(), packet.size(), 0);
      EXPECT_TRUE(size > 0 && ReadOsc(std::string_view(packet).substr(0, size_t(size)), &messages)) << size;
      if (sizes != nullptr) sizes->push_back(size_t(size));
    }
  }

 private:
  int socket_, port_ = 0;
};

}  // namespace bodyloom
