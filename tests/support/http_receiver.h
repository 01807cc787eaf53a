#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

namespace citymesh {

/// A web server on loopback that keeps every request and answers it as it is told to.
class HttpReceiver {
 public:
  HttpReceiver() : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ::bind(listener_, reinterpret_cast<const sockaddr*>(&address), size);
    ::listen(listener_, 16);
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~HttpReceiver() {
    ::shutdown(listener_, SHUT_RDWR);
    thread_.join();
    ::close(listener_);
  }
  HttpReceiver(const HttpReceiver&) = delete;
  HttpReceiver& operator=(const HttpReceiver&) = delete;

  std::uint16_t port() const { return port_; }
  std::string url(const std::string& path, const std::string& host = "127.0.0.1") const {
    return "http://" + host + ":" + std::to_string(port_) + path;
  }
  /// The next answers, in this order; 204 when there are none left. `head`: status and headers.
  void answer(std::string head, const std::string& body = {}) {
    const std::scoped_lock lock(mutex_);
    answers_.push_back("HTTP/1.1 " + std::move(head) + "\r\nContent-Length: " +
                       std::to_string(body.size()) + "\r\nConnection: close\r\n\r\n" + body);
  }
  /// What answers when there are none left: a whole answer, "HTTP/1.1 200 OK\r\n…".
  void answer_by(std::function<std::string(const std::string& request)> responder) {
    const std::scoped_lock lock(mutex_);
    responder_ = std::move(responder);
  }
  /// The next request as it came: header and body. Nothing when none comes in time.
  std::optional<std::string> next(std::chrono::milliseconds patience = std::chrono::seconds(30)) {
    std::unique_lock lock(mutex_);
    if (!arrived_.wait_for(lock, patience, [this] { return !requests_.empty(); }))
      return std::nullopt;
    auto request = std::move(requests_.front());
    requests_.pop_front();
    return request;
  }
  bool is_quiet() {
    const std::scoped_lock lock(mutex_);
    return requests_.empty();
  }
  static std::string body(const std::string& request) {
    return request.substr(request.find("\r\n\r\n") + 4);
  }
  static std::string header(const std::string& request, const std::string& name) {
    const auto begin = request.find("\r\n" + name + ": ");
    if (begin == std::string::npos || begin > request.find("\r\n\r\n")) return {};
    const auto value = begin + name.size() + 4;
    return request.substr(value, request.find("\r\n", value) - value);
  }

 private:
  void serve() {
    for (;;) {
      const int socket = ::accept(listener_, nullptr, nullptr);
      if (socket < 0) return;
      const timeval limit{20, 0};
      ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
      const auto request = receive(socket);
      std::string reply = "HTTP/1.1 204 No Content\r\nConnection: close\r\n\r\n";
      std::function<std::string(const std::string&)> responder;
      {
        const std::scoped_lock lock(mutex_);
        if (!answers_.empty()) {
          reply = std::move(answers_.front());
          answers_.pop_front();
        } else {
          responder = responder_;
        }
        requests_.push_back(request);
      }
      if (responder) reply = responder(request);
      (void)::send(socket, reply.data(), reply.size(), MSG_NOSIGNAL);
      ::close(socket);
      arrived_.notify_all();
    }
  }

  static std::string receive(int socket) {
    std::string request;
    for (;;) {
      if (const auto end = request.find("\r\n\r\n"); end != std::string::npos) {
        const auto length = header(request, "Content-Length");
        if (request.size() >= end + 4 + (length.empty() ? 0 : std::stoul(length))) return request;
      }
      char bytes[16384];
      const auto received = ::recv(socket, bytes, sizeof bytes, 0);
      if (received <= 0) return request;
      request.append(bytes, static_cast<std::size_t>(received));
    }
  }

  int listener_;
  std::uint16_t port_ = 0;
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<std::string> requests_;
  std::deque<std::string> answers_;
  std::function<std::string(const std::string&)> responder_;
  std::thread thread_;
};

}  // namespace citymesh
