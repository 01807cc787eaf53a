#include "services/rest/server.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/status.hpp>
#include <boost/beast/http/string_body.hpp>
#include <chrono>
#include <condition_variable>
#include <ctime>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <type_traits>
#include <vector>

#include "core/base/version.h"
#include "services/rest/api.h"
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

constexpr std::uint64_t kChunkBytes = 256 << 10;
constexpr std::uint64_t kMaxDiscardedBytes = 8 << 20;
constexpr auto kDiscardTime = std::chrono::seconds(2);
constexpr auto kAcceptRetryTime = std::chrono::milliseconds(100);

std::chrono::milliseconds milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1000.0));
}

std::string_view view(boost::string_view text) { return {text.data(), text.size()}; }

std::string http_date() {
  constexpr const char* kDays[] = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  constexpr const char* kMonths[] = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                     "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  return fmt::format("{}, {:02} {} {} {:02}:{:02}:{:02} GMT", kDays[utc.tm_wday], utc.tm_mday,
                     kMonths[utc.tm_mon], utc.tm_year + 1900, utc.tm_hour, utc.tm_min, utc.tm_sec);
}

/// A header value on one line, whatever went into it.
std::string one_line(std::string value) {
  std::ranges::replace_if(
      value, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
  return value;
}

/// 204 and 304 never have a body.
bool may_have_body(int status) { return status != 204 && status != 304; }

std::string head_text(const Response& response, bool keep_alive) {
  std::string text = fmt::format(
      "HTTP/1.1 {} {}\r\nServer: citymesh/{}\r\nDate: {}\r\nConnection: {}\r\n", response.status,
      view(http::obsolete_reason(static_cast<http::status>(response.status))), version(),
      http_date(), keep_alive ? "keep-alive" : "close");
  if (may_have_body(response.status))
    text += fmt::format("Content-Length: {}\r\n", body_bytes(response));
  for (const auto& [name, value] : response.headers.all())
    text += fmt::format("{}: {}\r\n", name, one_line(value));
  return text + "\r\n";
}

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

struct Session {
  explicit Session(tcp::socket socket) : stream(std::move(socket)) {}
  beast::tcp_stream stream;
  bool busy = false;  ///< between a request's header and the end of its response; strand only
};

}  // namespace

struct RestServer::Impl {
  Impl(JobManager& jobs, Metrics& metrics, RestOptions given)
      : options(std::move(given)),
        api(jobs, metrics,
            {options.public_url, options.cors_allow_origin, options.max_inline_bytes}) {}

  Result<std::uint16_t> start();
  void stop();

 private:
  awaitable<void> accept_all();
  awaitable<void> serve(std::shared_ptr<Session> session);
  awaitable<void> refuse(std::shared_ptr<Session> session);
  awaitable<bool> answer_next(Session& session, beast::flat_buffer& buffer);
  awaitable<bool> write(Session& session, const Response& response, bool head, bool keep_alive);
  awaitable<bool> flush(Session& session, std::string& text);
  awaitable<void> discard_input(Session& session);

  /// Runs blocking work on a handler thread; the coroutine goes on where it was.
  template <class Work>
  awaitable<std::invoke_result_t<Work>> blocking(Work work) {
    using Value = std::optional<std::invoke_result_t<Work>>;  // co_spawn wants a default
    auto run = [work = std::move(work)]() mutable -> awaitable<Value> { co_return work(); };
    auto value =
        co_await asio::co_spawn(handlers->get_executor(), std::move(run), asio::use_awaitable);
    co_return *std::move(value);
  }

  bool enter(const std::shared_ptr<Session>& session);
  void leave(const std::shared_ptr<Session>& session);
  void close_sessions(bool idle_only);

  const RestOptions options;
  const Api api;
  asio::io_context io;
  std::optional<asio::thread_pool> handlers;
  std::optional<tcp::acceptor> acceptor;
  std::vector<std::thread> threads;
  std::atomic<bool> stopping = false;

  std::mutex mutex;
  std::condition_variable all_gone;
  std::set<std::shared_ptr<Session>> sessions;
};

Result<std::uint16_t> RestServer::Impl::start() {
  error_code error;
  const auto address =
      asio::ip::make_address(options.host == "localhost" ? "127.0.0.1" : options.host, error);
  if (error)
    return fail(ErrorCode::InvalidArgument,
                fmt::format("cannot listen on '{}': expected an IP address", options.host));

  const tcp::endpoint endpoint(address, options.port);
  acceptor.emplace(asio::make_strand(io));
  acceptor->open(endpoint.protocol(), error);
  if (!error) acceptor->set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor->bind(endpoint, error);
  if (!error) acceptor->listen(asio::socket_base::max_listen_connections, error);
  const auto port = error ? std::uint16_t{0} : acceptor->local_endpoint(error).port();
  if (error) {
    acceptor.reset();
    return fail(ErrorCode::Unavailable, fmt::format("cannot listen on {}:{}: {}", options.host,
                                                    options.port, error.message()));
  }

  handlers.emplace(std::max(1U, options.handler_threads));
  asio::co_spawn(acceptor->get_executor(), accept_all(), [](std::exception_ptr) {});
  for (unsigned i = 0; i < std::max(1U, options.io_threads); ++i)
    threads.emplace_back([this] { io.run(); });
  return port;
}

void RestServer::Impl::stop() {
  if (threads.empty()) return;
  stopping = true;
  asio::post(acceptor->get_executor(), [this] { acceptor->close(); });
  close_sessions(true);
  {
    std::unique_lock lock(mutex);
    all_gone.wait_for(lock, milliseconds(options.drain_timeout_s),
                      [this] { return sessions.empty(); });
  }
  close_sessions(false);
  for (auto& thread : threads) thread.join();  // the last session leaves no work behind
  threads.clear();
  handlers->join();
}

bool RestServer::Impl::enter(const std::shared_ptr<Session>& session) {
  const std::scoped_lock lock(mutex);
  sessions.insert(session);
  return sessions.size() <= options.max_connections;
}

void RestServer::Impl::leave(const std::shared_ptr<Session>& session) {
  const std::scoped_lock lock(mutex);
  sessions.erase(session);
  if (sessions.empty()) all_gone.notify_all();
}

void RestServer::Impl::close_sessions(bool idle_only) {
  const std::scoped_lock lock(mutex);
  for (const auto& session : sessions)
    asio::post(session->stream.get_executor(), [session, idle_only] {
      if (!idle_only || !session->busy) session->stream.close();
    });
}

awaitable<void> RestServer::Impl::accept_all() {
  while (!stopping) {
    error_code error;
    auto socket = co_await acceptor->async_accept(asio::any_io_executor(asio::make_strand(io)),
                                                  asio::redirect_error(asio::use_awaitable, error));
    if (stopping) co_return;
    if (error) {  // out of file descriptors: connections under way will give some back
      asio::steady_timer timer(acceptor->get_executor(), kAcceptRetryTime);
      co_await timer.async_wait(asio::redirect_error(asio::use_awaitable, error));
      continue;
    }
    auto session = std::make_shared<Session>(std::move(socket));
    const bool room = enter(session);
    asio::co_spawn(session->stream.get_executor(), room ? serve(session) : refuse(session),
                   [this, session](std::exception_ptr) { leave(session); });
  }
}

awaitable<void> RestServer::Impl::refuse(std::shared_ptr<Session> session) {
  const auto response =
      problem_response(problems::kTooManyConnections,
                       fmt::format("{} connections are open, more are not served; try again later",
                                   options.max_connections),
                       {});
  session->busy = true;
  const bool written = co_await write(*session, response, false, false);
  if (written) co_await discard_input(*session);
}

awaitable<void> RestServer::Impl::serve(std::shared_ptr<Session> session) {
  error_code ignored;
  session->stream.socket().set_option(tcp::no_delay(true), ignored);
  // What a client sends ahead (pipelining) stays in the buffer until its turn.
  beast::flat_buffer buffer(options.max_header_bytes + kChunkBytes);
  bool keep_alive = true;
  while (keep_alive && !stopping) keep_alive = co_await answer_next(*session, buffer);
  session->stream.socket().shutdown(tcp::socket::shutdown_send, ignored);
}

/// Reads a request and answers it; false when the connection is to be closed.
awaitable<bool> RestServer::Impl::answer_next(Session& session, beast::flat_buffer& buffer) {
  http::request_parser<http::string_body> parser;
  parser.header_limit(options.max_header_bytes);
  parser.body_limit(options.max_body_bytes);

  error_code error;
  session.busy = false;
  session.stream.expires_after(milliseconds(options.header_timeout_s));
  co_await http::async_read_header(session.stream, buffer, parser,
                                   asio::redirect_error(asio::use_awaitable, error));
  session.busy = true;

  if (!error && !parser.is_done()) {
    session.stream.expires_after(milliseconds(options.body_timeout_s));
    if (beast::iequals(parser.get()[http::field::expect], "100-continue")) {
      std::string interim = "HTTP/1.1 100 Continue\r\n\r\n";
      const bool sent = co_await flush(session, interim);
      if (!sent) co_return false;
    }
    co_await http::async_read(session.stream, buffer, parser,
                              asio::redirect_error(asio::use_awaitable, error));
  }
  if (error) {
    const auto response = unreadable(error, options);
    if (!response) co_return false;
    const bool written = co_await write(session, *response, false, false);
    if (written) co_await discard_input(session);
    co_return false;
  }

  auto message = parser.release();
  const bool keep_alive = message.keep_alive() && !stopping;
  Request request;
  request.method = std::string(view(message.method_string()));
  request.target = std::string(view(message.target()));
  for (const auto& field : message)
    request.headers.add(view(field.name_string()), std::string(view(field.value())));
  request.body = std::move(message.body());
  const bool head = request.method == "HEAD";

  auto handle = [this, request = std::move(request)] { return api.handle(request); };
  const Response response = co_await blocking(std::move(handle));
  const bool written = co_await write(session, response, head, keep_alive);
  co_return written&& keep_alive;
}

awaitable<bool> RestServer::Impl::flush(Session& session, std::string& text) {
  error_code error;
  session.stream.expires_after(milliseconds(options.write_timeout_s));
  co_await asio::async_write(session.stream, asio::buffer(text),
                             asio::redirect_error(asio::use_awaitable, error));
  text.clear();
  co_return !error;
}

/// False when the connection cannot be used any more: it broke, or a file ended early.
awaitable<bool> RestServer::Impl::write(Session& session, const Response& response, bool head,
                                        bool keep_alive) {
  auto pending = head_text(response, keep_alive);
  if (head || !may_have_body(response.status)) {
    const bool sent = co_await flush(session, pending);
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
        const bool sent = co_await write(session, problem, false, keep_alive);
        co_return sent;
      }
      offset += chunk->size();
      pending += *chunk;
      const bool sent = co_await flush(session, pending);
      if (!sent) co_return false;
      begun = true;
    }
  }
  const bool sent = pending.empty() || co_await flush(session, pending);
  co_return sent;
}

/// Lets a client read the answer before the connection goes, although its request was not read to
/// the end.
awaitable<void> RestServer::Impl::discard_input(Session& session) {
  error_code error;
  session.stream.socket().shutdown(tcp::socket::shutdown_send, error);
  session.stream.expires_after(kDiscardTime);
  std::vector<char> nowhere(16 << 10);
  for (std::uint64_t total = 0; !error && total < kMaxDiscardedBytes;)
    total += co_await session.stream.async_read_some(
        asio::buffer(nowhere), asio::redirect_error(asio::use_awaitable, error));
}

RestServer::RestServer(JobManager& jobs, Metrics& metrics, RestOptions options)
    : impl_(std::make_unique<Impl>(jobs, metrics, std::move(options))) {}
RestServer::~RestServer() { stop(); }
Result<std::uint16_t> RestServer::start() { return impl_->start(); }
void RestServer::stop() { impl_->stop(); }

}  // namespace citymesh
