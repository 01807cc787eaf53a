#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <openssl/ssl.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cctype>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace citymesh {

/// A client that sends exactly the bytes it is told to.
class Connection {
 public:
  struct Answer {
    int status = 0;
    std::map<std::string, std::string> headers{};  ///< names in lower case
    std::string body{};
  };

  /// With a context it speaks TLS; see greeted().
  explicit Connection(std::uint16_t port, SSL_CTX* tls = nullptr, const char* host = "127.0.0.1")
      : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    const timeval limit{20, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    inet_pton(AF_INET, host, &address.sin_addr);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    if (tls == nullptr) return;
    secure_ = SSL_new(tls);
    SSL_set_fd(secure_, socket_);
    greeted_ = SSL_connect(secure_) == 1;
  }
  ~Connection() {
    SSL_free(secure_);
    ::close(socket_);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  bool greeted() const { return greeted_; }
  SSL* secure() { return secure_; }

  /// False when the server has closed the connection.
  bool send(std::string_view bytes) {
    while (!bytes.empty()) {
      const auto sent = secure_ != nullptr
                            ? SSL_write(secure_, bytes.data(), static_cast<int>(bytes.size()))
                            : ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }
  /// Says nothing more and reads nothing more.
  void leave() {
    if (secure_ != nullptr) SSL_shutdown(secure_);
    ::close(socket_);
    socket_ = -1;
  }
  void half_close() { ::shutdown(socket_, SHUT_WR); }

  /// The next answer; none when the connection ends before it is complete.
  std::optional<Answer> read(bool head = false) {
    Answer answer;
    std::size_t end = 0;
    while ((end = buffer_.find("\r\n\r\n")) == std::string::npos)
      if (!receive()) return std::nullopt;
    const auto header = buffer_.substr(0, end + 2);
    buffer_.erase(0, end + 4);
    answer.status = std::stoi(header.substr(9, 3));
    for (auto begin = header.find("\r\n") + 2; begin < header.size();) {
      const auto line_end = header.find("\r\n", begin);
      const auto colon = header.find(": ", begin);
      std::string name = header.substr(begin, colon - begin);
      for (auto& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      answer.headers[name] = header.substr(colon + 2, line_end - colon - 2);
      begin = line_end + 2;
    }
    if (head || !answer.headers.contains("content-length")) return answer;
    const auto length = std::stoull(answer.headers["content-length"]);
    while (buffer_.size() < length)
      if (!receive()) return std::nullopt;
    answer.body = buffer_.substr(0, length);
    buffer_.erase(0, length);
    return answer;
  }

  /// Everything up to the end of the connection.
  std::string read_to_end() {
    while (receive()) continue;
    return std::exchange(buffer_, {});
  }

  /// Everything up to the text; all there is when the connection ends before.
  std::string read_until(std::string_view text) {
    std::size_t at = 0;
    while ((at = buffer_.find(text)) == std::string::npos)
      if (!receive()) return std::exchange(buffer_, {});
    auto read = buffer_.substr(0, at + text.size());
    buffer_.erase(0, read.size());
    return read;
  }

  /// Whether the server closes the connection without a further byte.
  bool is_closed() { return buffer_.empty() && !receive(); }

 private:
  bool receive() {
    char bytes[65536];
    const auto received = secure_ != nullptr ? SSL_read(secure_, bytes, sizeof bytes)
                                             : ::recv(socket_, bytes, sizeof bytes, 0);
    if (received <= 0) return false;
    buffer_.append(bytes, static_cast<std::size_t>(received));
    return true;
  }

  int socket_;
  SSL* secure_ = nullptr;
  bool greeted_ = false;
  std::string buffer_;
};

}  // namespace citymesh
