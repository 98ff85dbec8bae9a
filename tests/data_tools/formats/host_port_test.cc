// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/host_port.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace bodyloom::host_port_test {
namespace {

TEST(HostPort, ReadsNamesAndAddresses) {
  for (const auto& [text, host, port] : {std::tuple{"127.0.0.1:8080", "127.0.0.1", 8080},
                                         {"localhost:0", "localhost", 0},
                                         {"[::1]:65535", "::1", 65535}}) {
    const HostPort address = ParseHostPort(text, 0);
    EXPECT_EQ(address.host, host);
    EXPECT_EQ(address.port, port);
    EXPECT_EQ(ToText(address), text);
  }
}

TEST(HostPort, RefusesOtherForms) {
  for (const char* text : {"", ":", ":80", "host", "host:", "host:-1", "host:65536", "host:123456", "host:8x", "::1:80",
                           "[]:80", "[::1:80", "host:0"}) {
    EXPECT_THAT([&] { ParseHostPort(text, 1); },
                testing::ThrowsMessage<std::invalid_argument>(testing::StartsWith(std::string(text) + ": expected")));
  }
}

}  // namespace
}  // namespace bodyloom::host_port_test
