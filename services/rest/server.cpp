#include "services/rest/server.h"

#include <fmt/format.h>
#include <sys/socket.h>

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
#include <boost/beast/http/string_body.hpp>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <type_traits>
#include <vector>

#include "services/jobs/job_manager.h"
#include "services/rest/api.h"
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

constexpr std::uint64_t kChunkBytes = 256 << 10;
constexpr std::uint64_t kMaxDiscardedBytes = 8 << 20;
constexpr auto kDiscardTime = std::chrono::seconds(2);
constexpr auto kAcceptRetryTime = std::chrono::milliseconds(100);
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

/// Wakes one answer when its job changes or its client leaves. Used on the session's strand only.
class Alarm : public std::enable_shared_from_this<Alarm> {
 public:
  explicit Alarm(tcp::socket& socket) : socket_(&socket), timer_(socket.get_executor()) {}

  bool client_left() const { return left_; }

  /// From any thread.
  void ring() {
    asio::post(timer_.get_executor(), [self = shared_from_this()] { self->wake(); });
  }

  void begin() {
    socket_->async_wait(tcp::socket::wait_read, [self = shared_from_this()](error_code error) {
      if (error || self->socket_ == nullptr) return;
      // The next request, sent ahead, makes the socket readable too; an end without one is a
      // client that does not want its answer any more.
      char next = 0;
      const auto got = ::recv(self->socket_->native_handle(), &next, 1, MSG_PEEK | MSG_DONTWAIT);
      self->left_ = got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR);
      if (self->left_) self->wake();
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

struct Session {
  explicit Session(tcp::socket socket) : stream(std::move(socket)) {
    error_code gone;
    const auto other_end = stream.socket().remote_endpoint(gone);
    if (!gone) peer = other_end.address().to_string();
  }
  beast::tcp_stream stream;
  std::string peer{};  ///< address of the client
  bool busy = false;   ///< between a request's header and the end of its response; strand only
};

}  // namespace

struct RestServer::Impl {
  Impl(JobManager& jobs_in, Metrics& metrics, RestOptions given)
      : options(std::move(given)),
        jobs(jobs_in),
        api(jobs, metrics,
            {options.public_url, options.cors_allow_origin, options.max_inline_bytes,
             options.sync_wait_s,
             options.access != nullptr ? options.access : &Access::for_everybody()}) {}

  Result<std::uint16_t> start();
  void stop();

 private:
  awaitable<void> accept_all();
  awaitable<void> serve(std::shared_ptr<Session> session);
  awaitable<void> refuse(std::shared_ptr<Session> session);
  awaitable<bool> answer_next(Session& session, beast::flat_buffer& buffer);
  awaitable<std::shared_ptr<Response>> follow(Session& session, const Follow& follow);
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
  JobManager& jobs;
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
  asio::co_spawn(acceptor->get_executor(), accept_all(), [](const std::exception_ptr&) {});
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
                   [this, session](const std::exception_ptr&) { leave(session); });
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
  request.peer = session.peer;
  const bool head = request.method == "HEAD";

  auto handle = [this, request = std::move(request)] { return api.handle(request); };
  Response response = co_await blocking(std::move(handle));
  if (response.follow) {
    if (response.follow->streams) {
      auto begun = head_text(response, false);
      const bool sent = co_await flush(session, begun);
      if (!sent || head) co_return false;
    }
    const auto waited_for = co_await follow(session, *response.follow);
    if (!waited_for) co_return false;
    response = *waited_for;
  }
  const bool written = co_await write(session, response, head, keep_alive);
  co_return written&& keep_alive;
}

/// Goes along with a job; returns the answer that had to wait for it. Nothing when there is none,
/// or nobody to get it.
awaitable<std::shared_ptr<Response>> RestServer::Impl::follow(Session& session,
                                                              const Follow& follow) {
  const auto alarm = std::make_shared<Alarm>(session.stream.socket());
  const auto changes = jobs.listen([alarm, id = follow.job_id](const Job& job) {
    if (job.id == id) alarm->ring();
  });
  const auto deadline = Clock::now() + milliseconds(follow.longest_s);
  alarm->begin();
  FollowStep step;
  bool left = false;
  for (bool end = false; !end && !left;) {
    alarm->reset();
    const bool last = stopping || Clock::now() >= deadline;
    auto take = [&follow, last] { return follow.step(last); };
    step = co_await blocking(std::move(take));
    end = step.end || last;
    left = alarm->client_left();
    if (!left && !step.bytes.empty()) left = !co_await flush(session, step.bytes);
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
