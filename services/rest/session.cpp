#include "services/rest/session.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <chrono>
#include <optional>
#include <type_traits>
#include <vector>

#include "services/rest/http_head.h"
#include "services/rest/message.h"
#include "services/rest/problem.h"

namespace citymesh {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::awaitable;
using asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kFirstReadBytes = 4 << 10;
constexpr std::uint64_t kChunkBytes = 256 << 10;
constexpr std::uint64_t kMaxDiscardedBytes = 8 << 20;
constexpr auto kDiscardTime = std::chrono::seconds(2);
constexpr auto kGoodbyeTime = std::chrono::seconds(2);
/// How often an answer looks for changes of its job that another process made.
constexpr auto kFollowPoll = std::chrono::seconds(1);

std::chrono::milliseconds milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1000.0));
}

std::string_view view(boost::string_view text) { return {text.data(), text.size()}; }

/// What a request that could not be read is answered with; nothing when the client is gone.
std::optional<Response> unreadable(const error_code& error, const RestOptions& options) {
  if (error == http::error::body_limit)
    return problem_response(
        problems::kBodyTooLarge,
        fmt::format("the request body is larger than {} bytes", options.max_body_bytes), {});
  if (error == http::error::header_limit || error == http::error::buffer_overflow)
    return problem_response(
        problems::kHeaderTooLarge,
        fmt::format("the request header is larger than {} bytes", options.max_header_bytes), {});
  if (error == http::error::end_of_stream || error == http::error::partial_message ||
      error.category() != make_error_code(http::error::bad_method).category())
    return std::nullopt;
  return problem_response(problem_kind(ErrorCode::InvalidArgument),
                          fmt::format("the request is not valid HTTP/1.1: {}", error.message()),
                          {});
}

/// A TCP connection with or without TLS as one stream.
class Channel {
 public:
  Channel(tcp::socket socket, std::shared_ptr<asio::ssl::context> tls) : context_(std::move(tls)) {
    if (context_)
      secure_.emplace(beast::tcp_stream(std::move(socket)), *context_);
    else
      plain_.emplace(std::move(socket));
  }

  using executor_type = beast::tcp_stream::executor_type;
  executor_type get_executor() { return transport().get_executor(); }
  beast::tcp_stream& transport() { return secure_ ? secure_->next_layer() : *plain_; }
  tcp::socket& socket() { return transport().socket(); }
  bool is_secure() const { return secure_.has_value(); }
  template <class Duration>
  void expires_after(Duration duration) {
    transport().expires_after(duration);
  }

  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return asio::async_initiate<Token, void(error_code, std::size_t)>(
        [this](auto handler, const Buffers& into) {
          if (secure_)
            secure_->async_read_some(into, std::move(handler));
          else
            plain_->async_read_some(into, std::move(handler));
        },
        token, buffers);
  }
  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return asio::async_initiate<Token, void(error_code, std::size_t)>(
        [this](auto handler, const Buffers& from) {
          if (secure_)
            secure_->async_write_some(from, std::move(handler));
          else
            plain_->async_write_some(from, std::move(handler));
        },
        token, buffers);
  }

  /// False when the client does not speak TLS as it should.
  awaitable<bool> say_hello() {
    error_code error;
    if (secure_)
      co_await secure_->async_handshake(asio::ssl::stream_base::server,
                                        asio::redirect_error(asio::use_awaitable, error));
    co_return !error;
  }
  /// Tells the client that nothing more comes.
  awaitable<void> say_goodbye() {
    error_code ignored;
    if (secure_) {
      expires_after(kGoodbyeTime);
      co_await secure_->async_shutdown(asio::redirect_error(asio::use_awaitable, ignored));
    }
    socket().shutdown(tcp::socket::shutdown_send, ignored);
  }

 private:
  std::shared_ptr<asio::ssl::context> context_;
  std::optional<beast::tcp_stream> plain_;
  std::optional<beast::ssl_stream<beast::tcp_stream>> secure_;
};

/// Wakes one answer when its job changes or its client leaves. Used on the session's strand only.
class Alarm : public std::enable_shared_from_this<Alarm> {
 public:
  explicit Alarm(tcp::socket& socket) : socket_(&socket), timer_(socket.get_executor()) {}

  /// A client that has closed its connection, or its sending half, does not want its answer.
  bool client_left() {
    pollfd descriptor{socket_->native_handle(), POLLRDHUP, 0};
    left_ = left_ || (::poll(&descriptor, 1, 0) > 0 && descriptor.revents != 0);
    return left_;
  }

  /// From any thread.
  void ring() {
    asio::post(timer_.get_executor(), [self = shared_from_this()] { self->wake(); });
  }

  void begin() {
    // Tells of the next request, sent ahead, too, and no second time: a client that leaves after
    // such a request is found when the alarm is waited for in vain.
    socket_->async_wait(tcp::socket::wait_read, [self = shared_from_this()](error_code error) {
      if (!error && self->socket_ != nullptr && self->client_left()) self->wake();
    });
  }
  void end() {
    error_code ignored;
    if (socket_->is_open()) socket_->cancel(ignored);
    socket_ = nullptr;
  }

  void reset() { rung_ = false; }
  /// Until the alarm rang after the last reset; at most to `until`.
  awaitable<void> wait(Clock::time_point until) {
    if (rung_ || left_) co_return;
    error_code ignored;
    timer_.expires_at(until);
    co_await timer_.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
  }

 private:
  void wake() {
    rung_ = true;
    timer_.cancel();
  }

  tcp::socket* socket_;
  asio::steady_timer timer_;
  bool rung_ = false;
  bool left_ = false;
};

tcp::socket adopted(asio::io_context& io, int descriptor) {
  tcp::socket socket(asio::make_strand(io));
  sockaddr_storage name{};
  socklen_t size = sizeof name;
  const bool ipv6 = ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&name), &size) == 0 &&
                    name.ss_family == AF_INET6;
  socket.assign(ipv6 ? tcp::v6() : tcp::v4(), descriptor);
  return socket;
}

std::string address_of(const tcp::socket& socket) {
  error_code gone;
  const auto other_end = socket.remote_endpoint(gone);
  return gone ? std::string{} : other_end.address().to_string();
}

}  // namespace

struct Session::Impl : std::enable_shared_from_this<Session::Impl> {
  Impl(const Shared& shared_in, tcp::socket socket, std::shared_ptr<asio::ssl::context> tls)
      : shared(shared_in), peer(address_of(socket)), channel(std::move(socket), std::move(tls)) {}

  awaitable<void> serve();
  awaitable<void> refuse(std::string why);
  awaitable<bool> answer_next(beast::flat_buffer& buffer);
  awaitable<std::shared_ptr<Response>> follow(const Follow& follow);
  awaitable<bool> write(const Response& response, bool head, bool keep_alive);
  awaitable<bool> flush(std::string& text);
  awaitable<void> discard_input();

  /// Runs blocking work on a handler thread; the coroutine goes on where it was.
  template <class Work>
  awaitable<std::invoke_result_t<Work>> blocking(Work work) {
    using Value = std::optional<std::invoke_result_t<Work>>;  // co_spawn wants a default
    auto run = [work = std::move(work)]() mutable -> awaitable<Value> { co_return work(); };
    auto value = co_await asio::co_spawn(shared.handlers.get_executor(), std::move(run),
                                         asio::use_awaitable);
    co_return *std::move(value);
  }

  const Shared& shared;
  const std::string peer;
  Channel channel;
  // Of the strand only.
  bool busy = false;      ///< between a request's header and the end of its response
  bool answered = false;  ///< a request has been read before
};

awaitable<void> Session::Impl::refuse(std::string why) {
  busy = true;
  channel.expires_after(milliseconds(shared.options.header_timeout_s));
  const bool greeted = co_await channel.say_hello();
  if (!greeted) co_return;
  const auto response = problem_response(problems::kTooManyConnections, why, {});
  const bool written = co_await write(response, false, false);
  if (written) co_await discard_input();
}

awaitable<void> Session::Impl::serve() {
  error_code ignored;
  channel.socket().set_option(tcp::no_delay(true), ignored);
  channel.expires_after(milliseconds(shared.options.header_timeout_s));
  const bool greeted = co_await channel.say_hello();
  if (!greeted) co_return;
  // What a client sends ahead (pipelining) stays in the buffer until its turn.
  beast::flat_buffer buffer(shared.options.max_header_bytes + kChunkBytes);
  bool keep_alive = true;
  while (keep_alive && !shared.stopping) keep_alive = co_await answer_next(buffer);
  co_await channel.say_goodbye();
}

/// Reads a request and answers it; false when the connection is to be closed.
awaitable<bool> Session::Impl::answer_next(beast::flat_buffer& buffer) {
  http::request_parser<http::string_body> parser;
  parser.header_limit(shared.options.max_header_bytes);
  parser.body_limit(shared.options.max_body_bytes);

  error_code error;
  busy = false;
  if (buffer.size() == 0) {
    // A client may rest between requests; one that has just come has no reason to.
    channel.expires_after(
        milliseconds(answered ? shared.options.idle_timeout_s : shared.options.header_timeout_s));
    const auto first = buffer.prepare(kFirstReadBytes);
    buffer.commit(
        co_await channel.async_read_some(first, asio::redirect_error(asio::use_awaitable, error)));
    if (error) co_return false;
  }
  answered = true;
  channel.expires_after(milliseconds(shared.options.header_timeout_s));
  co_await http::async_read_header(channel, buffer, parser,
                                   asio::redirect_error(asio::use_awaitable, error));
  busy = true;

  if (!error && !parser.is_done()) {
    channel.expires_after(milliseconds(shared.options.body_timeout_s));
    if (beast::iequals(parser.get()[http::field::expect], "100-continue")) {
      std::string interim = "HTTP/1.1 100 Continue\r\n\r\n";
      const bool sent = co_await flush(interim);
      if (!sent) co_return false;
    }
    co_await http::async_read(channel, buffer, parser,
                              asio::redirect_error(asio::use_awaitable, error));
  }
  if (error) {
    const auto response = unreadable(error, shared.options);
    if (!response) co_return false;
    const bool written = co_await write(*response, false, false);
    if (written) co_await discard_input();
    co_return false;
  }

  auto message = parser.release();
  const bool keep_alive = message.keep_alive() && !shared.stopping;
  Request request;
  request.method = std::string(view(message.method_string()));
  request.target = std::string(view(message.target()));
  for (const auto& field : message)
    request.headers.add(view(field.name_string()), std::string(view(field.value())));
  request.body = std::move(message.body());
  request.peer = peer;
  request.secure = channel.is_secure();
  const bool head = request.method == "HEAD";

  auto handle = [this, request = std::move(request)] { return shared.api.handle(request); };
  Response response = co_await blocking(std::move(handle));
  if (response.follow) {
    if (response.follow->streams) {
      auto begun = head_text(response, false);
      const bool sent = co_await flush(begun);
      if (!sent || head) co_return false;
    }
    const auto waited_for = co_await follow(*response.follow);
    if (!waited_for) co_return false;
    response = *waited_for;
  }
  const bool written = co_await write(response, head, keep_alive);
  co_return written&& keep_alive;
}

/// Goes along with a job; returns the answer that had to wait for it. Nothing when there is none,
/// or nobody to get it.
awaitable<std::shared_ptr<Response>> Session::Impl::follow(const Follow& follow) {
  const auto alarm = std::make_shared<Alarm>(channel.socket());
  const auto changes = shared.jobs.listen([alarm, id = follow.job_id](const Job& job) {
    if (job.id == id) alarm->ring();
  });
  const auto deadline = Clock::now() + milliseconds(follow.longest_s);
  alarm->begin();
  FollowStep step;
  bool left = false;
  for (bool end = false; !end && !left;) {
    alarm->reset();
    const bool last = shared.stopping || Clock::now() >= deadline;
    auto take = [&follow, last] { return follow.step(last); };
    step = co_await blocking(std::move(take));
    end = step.end || last;
    left = alarm->client_left();
    if (!left && !step.bytes.empty()) left = !co_await flush(step.bytes);
    if (!end && !left) co_await alarm->wait(std::min(deadline, Clock::now() + kFollowPoll));
    left = left || alarm->client_left();
  }
  alarm->end();
  if (left && !step.end && follow.client_left) {
    auto leave = [&follow] {
      follow.client_left();
      return true;
    };
    co_await blocking(std::move(leave));
  }
  co_return left ? nullptr : step.answer;
}

awaitable<bool> Session::Impl::flush(std::string& text) {
  error_code error;
  channel.expires_after(milliseconds(shared.options.write_timeout_s));
  co_await asio::async_write(channel, asio::buffer(text),
                             asio::redirect_error(asio::use_awaitable, error));
  text.clear();
  co_return !error;
}

/// False when the connection cannot be used any more: it broke, or a file ended early.
awaitable<bool> Session::Impl::write(const Response& response, bool head, bool keep_alive) {
  auto pending = head_text(response, keep_alive);
  if (head || !may_have_body(response.status)) {
    const bool sent = co_await flush(pending);
    co_return sent;
  }
  bool begun = false;
  for (const auto& piece : response.body) {
    if (const auto* text = std::get_if<std::string>(&piece)) {
      pending += *text;
      continue;
    }
    const auto& file = std::get<FilePiece>(piece);
    for (std::uint64_t offset = 0; offset < file.bytes;) {
      auto read = [&file, offset] {
        return file.read(offset, std::min(kChunkBytes, file.bytes - offset));
      };
      const auto chunk = co_await blocking(std::move(read));
      if (!chunk || chunk->empty()) {
        if (begun) co_return false;  // the header promised more bytes: only closing is honest
        const auto error =
            chunk ? fail(ErrorCode::DataLoss, "the result file is shorter than it should be")
                  : chunk.error();
        auto problem = problem_response(problem_kind(error.code), error.message, {});
        const bool sent = co_await write(problem, false, keep_alive);
        co_return sent;
      }
      offset += chunk->size();
      pending += *chunk;
      const bool sent = co_await flush(pending);
      if (!sent) co_return false;
      begun = true;
    }
  }
  const bool sent = pending.empty() || co_await flush(pending);
  co_return sent;
}

/// Lets a client read the answer before the connection goes, although its request was not read to
/// the end.
awaitable<void> Session::Impl::discard_input() {
  error_code error;
  co_await channel.say_goodbye();
  channel.expires_after(kDiscardTime);
  std::vector<char> nowhere(16 << 10);
  for (std::uint64_t total = 0; !error && total < kMaxDiscardedBytes;)
    total += co_await channel.transport().async_read_some(
        asio::buffer(nowhere), asio::redirect_error(asio::use_awaitable, error));
}

Session::Session(const Shared& shared, int socket, std::shared_ptr<asio::ssl::context> tls)
    : impl_(std::make_shared<Impl>(shared, adopted(shared.io, socket), std::move(tls))) {}
Session::~Session() = default;

const std::string& Session::peer() const { return impl_->peer; }

void Session::serve(std::function<void()> ended) {
  asio::co_spawn(impl_->channel.get_executor(), impl_->serve(),
                 [impl = impl_, ended = std::move(ended)](const std::exception_ptr&) { ended(); });
}

void Session::refuse(std::string why, std::function<void()> ended) {
  asio::co_spawn(impl_->channel.get_executor(), impl_->refuse(std::move(why)),
                 [impl = impl_, ended = std::move(ended)](const std::exception_ptr&) { ended(); });
}

void Session::close(bool idle_only) {
  asio::post(impl_->channel.get_executor(), [impl = impl_, idle_only] {
    if (!idle_only || !impl->busy) impl->channel.transport().close();
  });
}

}  // namespace citymesh
