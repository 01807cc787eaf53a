#include "services/rpc/error_details.h"

#include "citymesh/v1/error_details.pb.h"

namespace citymesh {
namespace {

constexpr int kRetry_s = 5;

template <class Message>
void add_detail(v1::Status& status, const char* name, const Message& detail) {
  auto& any = *status.add_details();
  any.set_type_url(std::string("type.googleapis.com/google.rpc.") + name);
  any.set_value(detail.SerializeAsString());
}

}  // namespace

std::string error_details(int code, std::string_view reason, const std::string& message,
                          bool passes_by_itself) {
  v1::Status status;
  status.set_code(code);
  status.set_message(message);
  v1::ErrorInfo info;
  info.set_reason(std::string(reason));
  info.set_domain("citymesh");
  add_detail(status, "ErrorInfo", info);
  if (passes_by_itself) {
    v1::RetryInfo retry;
    retry.mutable_retry_delay()->set_seconds(kRetry_s);
    add_detail(status, "RetryInfo", retry);
  }
  return status.SerializeAsString();
}

}  // namespace citymesh
