#include "services/rpc/server.h"

#include <fmt/format.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/grpcpp.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/security/tls_certificate_provider.h>
#include <grpcpp/security/tls_credentials_options.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <system_error>
#include <utility>

#include "citymesh/v1/jobs.grpc.pb.h"
#include "services/jobs/job_manager.h"
#include "services/offer/offer.h"
#include "services/rpc/caller.h"
#include "services/rpc/error_details.h"
#include "services/rpc/messages.h"
#include "services/telemetry/log.h"
#include "services/telemetry/metrics.h"
#include "services/telemetry/trace.h"

namespace citymesh {
namespace {

/// As the documentation of gRPC writes it.
std::string_view code_name(grpc::StatusCode code) {
  constexpr std::array<std::string_view, 17> kNames{"OK",
                                                    "CANCELLED",
                                                    "UNKNOWN",
                                                    "INVALID_ARGUMENT",
                                                    "DEADLINE_EXCEEDED",
                                                    "NOT_FOUND",
                                                    "ALREADY_EXISTS",
                                                    "PERMISSION_DENIED",
                                                    "RESOURCE_EXHAUSTED",
                                                    "FAILED_PRECONDITION",
                                                    "ABORTED",
                                                    "OUT_OF_RANGE",
                                                    "UNIMPLEMENTED",
                                                    "INTERNAL",
                                                    "UNAVAILABLE",
                                                    "DATA_LOSS",
                                                    "UNAUTHENTICATED"};
  const auto index = static_cast<std::size_t>(code);
  return index < kNames.size() ? kNames[index] : "UNKNOWN";
}

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kChunkBytes = 256 * 1024;
constexpr TimeMs kWatchWaitMs = 200;  // how soon a client that has left is noticed
constexpr int kThreadsForCalls = 32;  // beside those that watches hold

grpc::StatusCode to_grpc(ErrorCode code) {
  switch (code) {
    case ErrorCode::InvalidArgument:
      return grpc::StatusCode::INVALID_ARGUMENT;
    case ErrorCode::FailedPrecondition:
      return grpc::StatusCode::FAILED_PRECONDITION;
    case ErrorCode::NotFound:
      return grpc::StatusCode::NOT_FOUND;
    case ErrorCode::AlreadyExists:
      return grpc::StatusCode::ALREADY_EXISTS;
    case ErrorCode::PermissionDenied:
      return grpc::StatusCode::PERMISSION_DENIED;
    case ErrorCode::ResourceExhausted:
      return grpc::StatusCode::RESOURCE_EXHAUSTED;
    case ErrorCode::Cancelled:
      return grpc::StatusCode::CANCELLED;
    case ErrorCode::DeadlineExceeded:
      return grpc::StatusCode::DEADLINE_EXCEEDED;
    case ErrorCode::Unavailable:
      return grpc::StatusCode::UNAVAILABLE;
    case ErrorCode::Unimplemented:
      return grpc::StatusCode::UNIMPLEMENTED;
    case ErrorCode::DataLoss:
      return grpc::StatusCode::DATA_LOSS;
    case ErrorCode::Internal:
      return grpc::StatusCode::INTERNAL;
  }
  return grpc::StatusCode::INTERNAL;
}

grpc::Status status_of(grpc::StatusCode code, std::string_view reason, const std::string& message) {
  const bool passes_by_itself =
      code == grpc::StatusCode::RESOURCE_EXHAUSTED || code == grpc::StatusCode::UNAVAILABLE;
  return {code, message, error_details(code, reason, message, passes_by_itself)};
}

grpc::Status to_status(const Error& error) {
  return status_of(to_grpc(error.code), to_string(error.code), error.message);
}

using Metadata = std::multimap<grpc::string_ref, grpc::string_ref>;

std::multimap<std::string, std::string> texts(const Metadata& metadata) {
  std::multimap<std::string, std::string> all;
  for (const auto& [name, value] : metadata)
    all.emplace(std::string(name.data(), name.size()), std::string(value.data(), value.size()));
  return all;
}

/// Who makes a call, and in which trace.
struct Caller : Client {
  std::string trace_id{};
};

class JobsService final : public v1::Jobs::Service {
 public:
  JobsService(JobManager& jobs, Metrics& metrics, const RpcOptions& options)
      : jobs_(jobs),
        metrics_(metrics),
        access_(options.access != nullptr ? *options.access : Access::for_everybody()),
        log_(options.log),
        links_base_(options.links_base),
        max_watches_(options.max_watches) {}

  void stop() { stopping_ = true; }

  grpc::Status Submit(grpc::ServerContext* context, const v1::SubmitRequest* request,
                      v1::Job* answer) override {
    return served(*context, "Submit", Role::Submit, [&](const Caller& caller) {
      const auto& key = request->idempotency_key();
      if (!key.empty())
        if (const auto checked = check_idempotency_key(key); !checked)
          return to_status(checked.error());
      auto spec = to_spec(*request);
      spec.subscriber.base = links_base_;
      auto asked = jobs_.check(std::move(spec));
      if (!asked) return to_status(asked.error());
      if (asked->write_back)
        if (const auto allowed = require(caller, Role::WriteBack); !allowed)
          return to_status(allowed.error());
      const auto job = jobs_.accept(*std::move(asked), key, caller.name, caller.trace_id);
      if (job && log_ != nullptr)
        log_->info("job_accepted", {{"job_id", job->id},
                                    {"process", job->spec.process},
                                    {"owner", job->owner},
                                    {"trace_id", caller.trace_id}});
      return reply(job, answer);
    });
  }

  grpc::Status Estimate(grpc::ServerContext* context, const v1::SubmitRequest* request,
                        v1::EstimateReply* answer) override {
    return served(*context, "Estimate", Role::Submit, [&](const Caller&) {
      const auto asked = jobs_.check(to_spec(*request));
      if (!asked) return to_status(asked.error());
      const auto expected = jobs_.estimate(*asked);
      if (!expected) return to_status(expected.error());
      *answer = to_proto(*expected);
      return grpc::Status::OK;
    });
  }

  grpc::Status Get(grpc::ServerContext* context, const v1::GetRequest* request,
                   v1::Job* answer) override {
    return served(*context, "Get", Role::ReadOwn, [&](const Client& client) {
      return reply(job_of(client, request->job_id()), answer);
    });
  }

  grpc::Status Dismiss(grpc::ServerContext* context, const v1::GetRequest* request,
                       v1::Job* answer) override {
    return served(*context, "Dismiss", Role::Submit, [&](const Client& client) {
      const auto job = job_of(client, request->job_id());
      return reply(job ? jobs_.dismiss(request->job_id()) : job, answer);
    });
  }

  grpc::Status List(grpc::ServerContext* context, const v1::ListRequest* request,
                    v1::ListReply* answer) override {
    return served(*context, "List", Role::ReadOwn,
                  [&](const Client& client) { return list(client, *request, *answer); });
  }

  grpc::Status Processes(grpc::ServerContext* context, const v1::ProcessesRequest*,
                         v1::ProcessesReply* answer) override {
    return served(*context, "Processes", Role::None, [&](const Client&) {
      for (const auto& process : offered_processes()) *answer->add_processes() = to_proto(process);
      return grpc::Status::OK;
    });
  }

  grpc::Status Watch(grpc::ServerContext* context, const v1::GetRequest* request,
                     grpc::ServerWriter<v1::Job>* writer) override {
    return served(*context, "Watch", Role::ReadOwn, [&](const Client& client) {
      return watch(*context, client, request->job_id(), *writer);
    });
  }

  grpc::Status FetchResult(grpc::ServerContext* context, const v1::FetchResultRequest* request,
                           grpc::ServerWriter<v1::Chunk>* writer) override {
    return served(*context, "FetchResult", Role::ReadOwn,
                  [&](const Client& client) { return fetch(*context, client, *request, *writer); });
  }

 private:
  /// Makes the call for its client, if that may; counts it and its time.
  template <class Call>
  grpc::Status served(const grpc::ServerContext& context, std::string_view method, Role needed,
                      const Call& call) {
    const auto start = Clock::now();
    const auto metadata = texts(context.client_metadata());
    Caller caller;
    caller.trace_id = trace_id_of(last_of(metadata, "traceparent"));
    auto status = [&]() -> grpc::Status {
      try {
        if (needed == Role::None) return call(caller);
        const auto client =
            access_.identify(credentials_of(context.peer(), metadata, access_.trusted_proxies()));
        if (!client) return unauthenticated(client.error().message);
        if (client->name.empty() && client->role == Role::None)
          return unauthenticated(
              "this needs an API key or a token, expected metadata `authorization: Bearer …` or "
              "(API key) `x-api-key: …`");
        if (const auto allowed = require(*client, needed); !allowed)
          return to_status(allowed.error());
        static_cast<Client&>(caller) = *client;
        return call(caller);
      } catch (const std::exception& error) {
        return to_status(fail(ErrorCode::Internal, error.what()));
      }
    }();
    const auto code = code_name(status.error_code());
    const auto seconds = std::chrono::duration<double>(Clock::now() - start).count();
    metrics_.rpc_request(method, code, seconds);
    if (log_ != nullptr)
      log_->debug("call", {{"method", method},
                           {"code", code},
                           {"seconds", seconds},
                           {"trace_id", caller.trace_id}});
    return status;
  }

  static grpc::Status unauthenticated(const std::string& why) {
    return status_of(grpc::StatusCode::UNAUTHENTICATED, "Unauthenticated", why);
  }
  static grpc::Status shutting_down() {
    return to_status(fail(ErrorCode::Unavailable, "the server is shutting down"));
  }

  /// A job that the client may not see does not exist for it.
  Result<Job> job_of(const Client& client, const std::string& id) {
    auto job = jobs_.get(id);
    if (job && !may_see(client, job->owner))
      return fail(ErrorCode::NotFound, fmt::format("job '{}' does not exist", id));
    return job;
  }

  static grpc::Status reply(const Result<Job>& job, v1::Job* answer) {
    if (!job) return to_status(job.error());
    *answer = to_proto(*job);
    return grpc::Status::OK;
  }

  grpc::Status list(const Client& client, const v1::ListRequest& request, v1::ListReply& answer) {
    auto filter = to_filter(request);
    if (!filter) return to_status(filter.error());
    if (client.role != Role::Admin) filter->owner = client.name;
    const auto jobs = jobs_.list(*filter);
    if (!jobs) return to_status(jobs.error());
    const auto matched = jobs_.count(*filter);
    if (!matched) return to_status(matched.error());
    for (const auto& job : *jobs) *answer.add_jobs() = to_proto(job);
    answer.set_matched(*matched);
    return grpc::Status::OK;
  }

  grpc::Status watch(grpc::ServerContext& context, const Client& client, const std::string& id,
                     grpc::ServerWriter<v1::Job>& writer) {
    struct Slot {
      explicit Slot(std::atomic<std::uint32_t>& count_in) : count(count_in), place(++count) {}
      ~Slot() { --count; }
      std::atomic<std::uint32_t>& count;
      std::uint32_t place;
    } const slot(watches_);
    if (slot.place > max_watches_)
      return to_status(
          fail(ErrorCode::ResourceExhausted,
               fmt::format("{} watches are open and at most {} may be; use Get or try again later",
                           max_watches_, max_watches_)));

    auto job = job_of(client, id);
    if (!job) return to_status(job.error());
    if (!writer.Write(to_proto(*job))) return grpc::Status::CANCELLED;
    auto seen = job->updated;
    while (!is_final(job->state)) {
      if (context.IsCancelled()) return grpc::Status::CANCELLED;
      if (stopping_) return shutting_down();
      job = jobs_.wait_for_change(id, seen, kWatchWaitMs);
      if (!job) return to_status(job.error());
      if (job->updated == seen) continue;
      seen = job->updated;
      if (!writer.Write(to_proto(*job))) return grpc::Status::CANCELLED;
    }
    return grpc::Status::OK;
  }

  grpc::Status fetch(grpc::ServerContext& context, const Client& client,
                     const v1::FetchResultRequest& request, grpc::ServerWriter<v1::Chunk>& writer) {
    if (const auto job = job_of(client, request.job_id()); !job) return to_status(job.error());
    const auto files = jobs_.results(request.job_id());
    if (!files) return to_status(files.error());
    const auto file = std::ranges::find_if(*files, [&](const ResultFile& candidate) {
      return candidate.file_name == request.output() || candidate.output == request.output();
    });
    if (file == files->end()) {
      std::string available;
      for (const auto& candidate : *files)
        available += (available.empty() ? "" : ", ") + candidate.file_name;
      return to_status(
          fail(ErrorCode::NotFound, fmt::format("job {} has no result '{}'; available: {}",
                                                request.job_id(), request.output(), available)));
    }
    if (request.offset() > file->bytes)
      return status_of(grpc::StatusCode::OUT_OF_RANGE, "OutOfRange",
                       fmt::format("offset is {}, expected at most {}, the size of {}",
                                   request.offset(), file->bytes, file->file_name));
    for (std::uint64_t offset = request.offset();;) {
      if (context.IsCancelled()) return grpc::Status::CANCELLED;
      if (stopping_) return shutting_down();
      auto bytes = jobs_.read_result(request.job_id(), file->file_name, offset, kChunkBytes);
      if (!bytes) return to_status(bytes.error());
      if (bytes->empty()) return grpc::Status::OK;
      offset += bytes->size();
      v1::Chunk chunk;
      chunk.set_data(*std::move(bytes));
      if (!writer.Write(chunk)) return grpc::Status::CANCELLED;
    }
  }

  JobManager& jobs_;
  Metrics& metrics_;
  const Access& access_;
  Log* const log_;
  const std::string links_base_;
  const std::uint32_t max_watches_;
  std::atomic<std::uint32_t> watches_ = 0;
  std::atomic<bool> stopping_ = false;
};

std::shared_ptr<grpc::ServerCredentials> credentials(const RpcOptions& options) {
  namespace tls = grpc::experimental;  // the only one that takes renewed certificates
  constexpr unsigned kLookAgain_s = 5;
  if (options.tls_certificate.empty()) return grpc::InsecureServerCredentials();
  tls::TlsServerCredentialsOptions secure(std::make_shared<tls::FileWatcherCertificateProvider>(
      options.tls_key.string(), options.tls_certificate.string(), kLookAgain_s));
  secure.watch_identity_key_cert_pairs();
  secure.set_cert_request_type(GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE);
  return tls::TlsServerCredentials(secure);
}

std::string address(const std::string& host, std::uint16_t port) {
  const auto ipv6 = host.find(':') != std::string::npos;
  return ipv6 ? fmt::format("[{}]:{}", host, port) : fmt::format("{}:{}", host, port);
}

}  // namespace

struct RpcServer::Impl {
  Impl(JobManager& jobs, Metrics& metrics, RpcOptions options_in)
      : options(std::move(options_in)), service(jobs, metrics, options) {}

  RpcOptions options;
  JobsService service;
  std::unique_ptr<grpc::Server> server{};
};

RpcServer::RpcServer(JobManager& jobs, Metrics& metrics, RpcOptions options)
    : impl_(std::make_unique<Impl>(jobs, metrics, std::move(options))) {}

RpcServer::~RpcServer() { stop(); }

Result<std::uint16_t> RpcServer::start() {
  const auto& options = impl_->options;
  grpc::EnableDefaultHealthCheckService(true);
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();

  int port = 0;
  grpc::ServerBuilder builder;
  const auto where = address(options.host, options.port);
  for (const auto& file : {options.tls_certificate, options.tls_key})
    if (std::error_code ignored; !file.empty() && !std::filesystem::is_regular_file(file, ignored))
      return fail(ErrorCode::InvalidArgument,
                  fmt::format("TLS file '{}' does not exist, expected PEM", file.string()));
  builder.AddListeningPort(where, credentials(options), &port);
  builder.RegisterService(&impl_->service);
  builder.SetMaxReceiveMessageSize(options.max_message_bytes);
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);  // a taken port is an error
  grpc::ResourceQuota quota("citymesh");
  quota.SetMaxThreads(static_cast<int>(options.max_watches) + kThreadsForCalls);
  builder.SetResourceQuota(quota);
  impl_->server = builder.BuildAndStart();
  if (!impl_->server || port == 0) {
    impl_->server.reset();
    return fail(
        ErrorCode::Unavailable,
        fmt::format("cannot listen for gRPC on {}: address in use or not of this machine", where));
  }
  return static_cast<std::uint16_t>(port);
}

void RpcServer::stop() {
  if (!impl_->server) return;
  impl_->service.stop();
  impl_->server->Shutdown(std::chrono::system_clock::now() + std::chrono::seconds(2));
  impl_->server->Wait();
  impl_->server.reset();
}

}  // namespace citymesh
