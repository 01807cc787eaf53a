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
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "services/rest/api.h"
#include "services/rest/session.h"
#include "services/rest/tls.h"

namespace citymesh {
namespace {

namespace asio = boost::asio;
using asio::awaitable;
using asio::ip::tcp;
using boost::system::error_code;

constexpr auto kAcceptRetryTime = std::chrono::milliseconds(100);

std::chrono::milliseconds milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1000.0));
}

const Access& access_of(const RestOptions& options) {
  return options.access != nullptr ? *options.access : Access::for_everybody();
}

ApiOptions api_options(const RestOptions& options) {
  return {options.public_url,  options.cors_allow_origin, options.max_inline_bytes,
          options.sync_wait_s, &access_of(options),       options.log};
}

}  // namespace

struct RestServer::Impl {
  Impl(JobManager& jobs, Metrics& metrics, RestOptions given)
      : options(std::move(given)),
        access(access_of(options)),
        api(jobs, metrics, api_options(options)),
        handlers(std::max(1U, options.handler_threads)),
        shared{options, jobs, api, io, handlers, stopping} {}

  Result<std::uint16_t> start();
  void stop();
  Result<void> reload_tls();

 private:
  awaitable<void> accept_all();
  void serve(int socket);
  std::string lack_of_room(const std::string& peer) const;
  void leave(const std::shared_ptr<Session>& session);
  void close_sessions(bool idle_only);

  const RestOptions options;
  const Access& access;
  const Api api;
  asio::io_context io;
  asio::thread_pool handlers;
  std::optional<tcp::acceptor> acceptor;
  std::vector<std::thread> threads;
  std::atomic<bool> stopping = false;
  const Shared shared;

  std::mutex mutex;
  std::condition_variable all_gone;
  std::set<std::shared_ptr<Session>> sessions;
  TlsContext tls{};  ///< of connections to come
  std::filesystem::file_time_type tls_written{};
};

Result<void> RestServer::Impl::reload_tls() {
  if (options.tls.certificate.empty()) return {};
  const auto written = last_written(options.tls);
  if (written == tls_written) return {};
  auto context = make_tls_context(options.tls);
  if (!context) return context.error();
  const std::scoped_lock lock(mutex);
  tls = *std::move(context);
  tls_written = written;
  return {};
}

Result<std::uint16_t> RestServer::Impl::start() {
  error_code error;
  const auto address =
      asio::ip::make_address(options.host == "localhost" ? "127.0.0.1" : options.host, error);
  if (error)
    return fail(ErrorCode::InvalidArgument,
                fmt::format("cannot listen on '{}': expected an IP address", options.host));

  if (auto loaded = reload_tls(); !loaded) return loaded.error();
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
  handlers.join();
}

/// Why one more connection from there, counted already, is not served; empty: it is.
std::string RestServer::Impl::lack_of_room(const std::string& peer) const {
  if (sessions.size() > options.max_connections)
    return fmt::format("{} connections are open, more are not served; try again later",
                       options.max_connections);
  const auto most = options.max_client_connections;
  if (most == 0 || sessions.size() <= most || is_loopback_address(peer) ||
      access.trusted_proxies().contains(peer))
    return {};
  const auto own = std::ranges::count(sessions, peer, [](const auto& s) { return s->peer(); });
  if (own <= most) return {};
  return fmt::format("{} connections from {} are open, more are not served; try again later", most,
                     peer);
}

void RestServer::Impl::serve(int socket) {
  std::string why_not;
  std::shared_ptr<Session> session;
  {
    const std::scoped_lock lock(mutex);
    session = std::make_shared<Session>(shared, socket, tls);
    sessions.insert(session);
    why_not = lack_of_room(session->peer());
  }
  auto ended = [this, session] { leave(session); };
  if (why_not.empty())
    session->serve(std::move(ended));
  else
    session->refuse(std::move(why_not), std::move(ended));
}

void RestServer::Impl::leave(const std::shared_ptr<Session>& session) {
  const std::scoped_lock lock(mutex);
  sessions.erase(session);
  if (sessions.empty()) all_gone.notify_all();
}

void RestServer::Impl::close_sessions(bool idle_only) {
  const std::scoped_lock lock(mutex);
  for (const auto& session : sessions) session->close(idle_only);
}

awaitable<void> RestServer::Impl::accept_all() {
  while (!stopping) {
    error_code error;
    auto socket = co_await acceptor->async_accept(asio::redirect_error(asio::use_awaitable, error));
    if (stopping) co_return;
    int descriptor = -1;
    if (!error) descriptor = socket.release(error);
    if (error) {  // out of file descriptors: connections under way will give some back
      asio::steady_timer timer(acceptor->get_executor(), kAcceptRetryTime);
      co_await timer.async_wait(asio::redirect_error(asio::use_awaitable, error));
      continue;
    }
    serve(descriptor);
  }
}

RestServer::RestServer(JobManager& jobs, Metrics& metrics, RestOptions options)
    : impl_(std::make_unique<Impl>(jobs, metrics, std::move(options))) {}
RestServer::~RestServer() { stop(); }
Result<std::uint16_t> RestServer::start() { return impl_->start(); }
void RestServer::stop() { impl_->stop(); }
Result<void> RestServer::reload_tls() { return impl_->reload_tls(); }

}  // namespace citymesh
