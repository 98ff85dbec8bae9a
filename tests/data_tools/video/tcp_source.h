// SPDX-License-Identifier: Apache-2.0
/// A stream that breaks off: serves the same bytes to each client in turn, and hangs up.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <thread>
#include <utility>

namespace bodyloom {

/// A socket that listens at a free port of 127.0.0.1.
inline int ListenAtLoopback(int* port) {
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  EXPECT_EQ(bind(listener, reinterpret_cast<sockaddr*>(&address), size), 0);
  EXPECT_EQ(listen(listener, 4), 0);
  EXPECT_EQ(getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size), 0);
  *port = ntohs(address.sin_port);
  return listener;
}

class TcpSource {
 public:
  explicit TcpSource(std::string bytes) : bytes_(std::move(bytes)) {
    int port = 0;
    socket_ = ListenAtLoopback(&port);
    url_ = "tcp://127.0.0.1:" + std::to_string(port);
    thread_ = std::thread([this] {
      for (;;) {
        const int client = accept(socket_, nullptr, nullptr);
        if (client < 0) return;
        for (size_t at = 0; at < bytes_.size();) {
          const ssize_t sent = send(client, bytes_.data() + at, bytes_.size() - at, MSG_NOSIGNAL);
          if (sent <= 0) break;
          at += size_t(sent);
        }
        close(client);
      }
    });
  }
  ~TcpSource() {
    shutdown(socket_, SHUT_RDWR);
    thread_.join();
    close(socket_);
  }
  TcpSource(const TcpSource&) = delete;
  TcpSource& operator=(const TcpSource&) = delete;
  [[nodiscard]] const std::string& url() const { return url_; }

 private:
  std::string bytes_, url_;
  int socket_ = -1;
  std::thread thread_;
};

}  // namespace bodyloom
