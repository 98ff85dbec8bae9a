// SPDX-License-Identifier: Apache-2.0
#include "pipelines/live/live_server.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "tests/pipelines/live/live_states.h"

namespace bodyloom::live_server_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using Json = nlohmann::json;

/// A plain connection to a port of 127.0.0.1.
class Client {
 public:
  explicit Client(int port, const char* address = "127.0.0.1") : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in to = {};
    to.sin_family = AF_INET;
    to.sin_port = htons(uint16_t(port));
    inet_pton(AF_INET, address, &to.sin_addr);
    const int small = 4096;
    setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
    connected_ = connect(socket_, reinterpret_cast<sockaddr*>(&to), sizeof to) == 0;
  }
  ~Client() { close(socket_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  [[nodiscard]] bool connected() const { return connected_; }
  void Send(const std::string& text) const { send(socket_, text.data(), text.size(), MSG_NOSIGNAL); }
  void Get(const std::string& target, const std::string& host = "localhost") const {
    Send("GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\nConnection: close\r\n\r\n");
  }
  /// Reads until `text` has come, the server hangs up, or a minute has passed; returns all so far.
  std::string ReadUntil(const std::string& text) {
    while (received_.find(text) == std::string::npos) {
      pollfd ready = {socket_, POLLIN, 0};
      char bytes[4096];
      if (poll(&ready, 1, 60'000) <= 0) break;
      const ssize_t count = recv(socket_, bytes, sizeof bytes, 0);
      if (count <= 0) break;
      received_.append(bytes, size_t(count));
    }
    return received_;
  }
  std::string ReadAll() { return ReadUntil("\n\nnever"); }

 private:
  int socket_;
  bool connected_ = false;
  std::string received_;
};

std::string Answer(const LiveServer& server, const std::string& target, const std::string& host = "localhost") {
  Client client(server.port());
  client.Get(target, host);
  return client.ReadAll();
}

void Publish(LiveServer* server, int64_t index, bool lost = false) {
  const LiveState state = ToyState(index, lost);
  server->Publish(state, LiveJson(state));
}

void WaitForViewers(const LiveServer& server, int count) {
  for (int i = 0; i < 60'000 && server.num_viewers() != count; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(server.num_viewers(), count);
}

TEST(LiveServer, ServesItsPageAndItsBody) {
  LiveServer server("127.0.0.1:0", "my <camera>");
  EXPECT_EQ(server.url(), "http://127.0.0.1:" + std::to_string(server.port()) + "/");
  const std::string page = Answer(server, "/");
  EXPECT_THAT(page, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(page, HasSubstr("my &lt;camera&gt;"));
  EXPECT_THAT(page, HasSubstr("\"live\":true"));
  EXPECT_THAT(Answer(server, "/body.glb"), StartsWith("HTTP/1.1 503"));
  Publish(&server, 1);
  const std::string body = Answer(server, "/body.glb");
  EXPECT_THAT(body, StartsWith("HTTP/1.1 200"));
  const size_t glb = body.find("\r\n\r\n") + 4;
  EXPECT_EQ(body.substr(glb), LiveBodyGlb(ToyBody(), Eigen::VectorXd::Zero(6)));
}

TEST(LiveServer, ServesNothingElse) {
  LiveServer server("127.0.0.1:0", "page");
  for (const char* target :
       {"/index.html", "/../../../../etc/passwd", "/..%2f..%2f..%2fetc%2fpasswd", "/etc/passwd", "//etc/passwd",
        "/body.glb/", "/bodyxglb", "/events/..", "/%00", "http://localhost/etc/passwd"}) {
    const std::string answer = Answer(server, target);
    EXPECT_THAT(answer, Not(HasSubstr("root:"))) << target;
    EXPECT_THAT(answer, testing::ContainsRegex("^HTTP/1.1 (404|400)")) << target;
  }
  for (const char* method : {"POST", "PUT", "DELETE", "PATCH", "OPTIONS"}) {
    Client client(server.port());
    client.Send(std::string(method) +
                " / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
    EXPECT_THAT(client.ReadAll(), Not(StartsWith("HTTP/1.1 200"))) << method;
  }
}

TEST(LiveServer, IsOnlyReachedByTheNameOfThisMachine) {
  LiveServer server("127.0.0.1:0", "page");
  const std::string port = ":" + std::to_string(server.port());
  for (const std::string host : {"localhost", "127.0.0.1", "[::1]"}) {
    EXPECT_THAT(Answer(server, "/", host + port), StartsWith("HTTP/1.1 200")) << host;
  }
  for (const std::string host : {"evil.example", "localhost.evil.example", "", "[", "[]"}) {
    EXPECT_THAT(Answer(server, "/", host + port), StartsWith("HTTP/1.1 403")) << host;
  }
  // Bound to 127.0.0.1 it is not at the machine's other addresses, of which 127.0.0.2 is one.
  EXPECT_FALSE(Client(server.port(), "127.0.0.2").connected());
}

/// The state of the last event in a stream of them, and the number of events.
std::pair<Json, int> LastEvent(const std::string& stream) {
  Json last;
  int count = 0;
  for (size_t at = stream.find("data: "); at != std::string::npos; at = stream.find("data: ", at + 1)) {
    const size_t end = stream.find("\n\n", at);
    if (end == std::string::npos) break;
    // Chunks of the transfer begin with their size, which lies before "data".
    last = Json::parse(stream.substr(at + 6, end - at - 6));
    ++count;
  }
  return {last, count};
}

TEST(LiveServer, TwoClientsGetTheStates) {
  LiveServer server("127.0.0.1:0", "page");
  Client one(server.port()), two(server.port());
  one.Get("/events");
  two.Get("/events");
  WaitForViewers(server, 2);
  for (int i = 0; i < 3; ++i) {
    Publish(&server, i);
    const std::string mark = "\"frame\":" + std::to_string(i) + ",";
    for (Client* client : {&one, &two}) {
      const std::string stream = client->ReadUntil(mark);
      EXPECT_THAT(stream, HasSubstr("Content-Type: text/event-stream"));
      EXPECT_THAT(stream, HasSubstr(mark));
    }
  }
  Publish(&server, 3, true);
  const auto [event, count] = LastEvent(one.ReadUntil("\"frame\":3,") + one.ReadUntil("}}\n\n"));
  EXPECT_GE(count, 3);
  EXPECT_EQ(event["shape"], 1);
}

TEST(LiveServer, AClientThatVanishesLeavesItsPlace) {
  LiveServer server("127.0.0.1:0", "page");
  {
    Client client(server.port());
    client.Get("/events");
    Publish(&server, 0);
    client.ReadUntil("data: ");
    WaitForViewers(server, 1);
  }
  for (int i = 1; i < 3000 && server.num_viewers() > 0; ++i) {
    Publish(&server, i);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(server.num_viewers(), 0);
}

TEST(LiveServer, ASlowClientHoldsUpNobody) {
  LiveServer server("127.0.0.1:0", "page");
  Client slow(server.port()), quick(server.port());
  slow.Get("/events");  // and never reads
  quick.Get("/events");
  WaitForViewers(server, 2);
  // Far more than its socket takes.
  constexpr int kStates = 2000;
  const LiveState state = ToyState(0);
  const std::string json = LiveJson(state);
  for (int i = 0; i < kStates; ++i) {
    LiveState next = state;
    next.frame.index = i;
    const std::string text = "{\"frame\":" + std::to_string(i) + "," + json.substr(json.find("\"seconds\""));
    server.Publish(next, text);  // returns at once
  }
  // The quick one has the newest at once, though none of those between.
  const std::string mark = "\"frame\":" + std::to_string(kStates - 1) + ",";
  EXPECT_THAT(quick.ReadUntil(mark), HasSubstr(mark));
}

TEST(LiveServer, MoreViewersThanItHasPlacesForAreSentAway) {
  LiveServer server("127.0.0.1:0", "page");
  std::vector<std::unique_ptr<Client>> viewers;
  for (int i = 0; i < LiveServer::kMostViewers; ++i) {
    viewers.push_back(std::make_unique<Client>(server.port()));
    viewers.back()->Get("/events");
  }
  WaitForViewers(server, LiveServer::kMostViewers);
  EXPECT_THAT(Answer(server, "/events"), StartsWith("HTTP/1.1 503"));
  EXPECT_THAT(Answer(server, "/"), StartsWith("HTTP/1.1 200"));
}

TEST(LiveServer, GarbageAtThePortChangesNothing) {
  LiveServer server("127.0.0.1:0", "page");
  const std::string zeros(100'000, '\0'), letters(100'000, 'A');
  for (const std::string& garbage :
       {std::string("\x16\x03\x01\x02\0\x01\0\x01\xfc\x03\x03", 11), zeros, letters,
        "GET " + letters + " HTTP/1.1\r\n\r\n", std::string("GET / HTTP/9.9\r\n\r\n"),
        "GET / HTTP/1.1\r\nHost: localhost\r\nX: " + letters + "\r\n\r\n",
        std::string("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999\r\n\r\nx"),
        std::string("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: -1\r\n\r\nx"),
        std::string("GET / HTTP/1.1\r\nHost: localhost\r\nRange: bytes=9999999999-,-5\r\n\r\n"),
        std::string("\r\n\r\n\r\n")}) {
    Client client(server.port());
    client.Send(garbage);
  }
  EXPECT_THAT(Answer(server, "/"), StartsWith("HTTP/1.1 200"));
}

TEST(LiveServer, EndsWithClientsConnected) {
  auto server = std::make_unique<LiveServer>("127.0.0.1:0", "page");
  Client viewer(server->port()), idle(server->port());
  viewer.Get("/events");
  WaitForViewers(*server, 1);
  server.reset();
  viewer.ReadAll();  // until it has hung up
}

TEST(LiveServer, RefusesAWrongAddressAndATakenPort) {
  EXPECT_THROW(LiveServer("here", "page"), std::invalid_argument);
  const LiveServer server("127.0.0.1:0", "page");
  const std::string taken = "127.0.0.1:" + std::to_string(server.port());
  EXPECT_THAT([&] { LiveServer(taken, "page"); },
              testing::ThrowsMessage<std::runtime_error>(StartsWith(taken + ": cannot listen there")));
  EXPECT_THAT([&] { LiveServer("192.0.2.1:0", "page"); },
              testing::ThrowsMessage<std::runtime_error>(StartsWith("192.0.2.1:0: cannot listen there")));
}

}  // namespace
}  // namespace bodyloom::live_server_test
