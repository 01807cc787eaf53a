#include "services/rpc/messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace citymesh {
namespace {

constexpr std::uint32_t kDefaultLimit = 100, kLargestLimit = 1000;

constexpr std::array kStates{
    std::pair{JobState::Accepted, v1::ACCEPTED}, std::pair{JobState::Running, v1::RUNNING},
    std::pair{JobState::Successful, v1::SUCCESSFUL}, std::pair{JobState::Failed, v1::FAILED},
    std::pair{JobState::Dismissed, v1::DISMISSED}};

v1::JobState to_proto(JobState state) {
  for (const auto& [ours, theirs] : kStates)
    if (ours == state) return theirs;
  return v1::JOB_STATE_UNSPECIFIED;
}

}  // namespace

v1::Job to_proto(const Job& job) {
  v1::Job message;
  message.set_job_id(job.id);
  message.set_process(job.spec.process);
  message.set_state(to_proto(job.state));
  message.set_message(job.message);
  message.set_stage(job.progress.stage);
  message.set_done(job.progress.done);
  message.set_total(job.progress.total);
  message.set_percent(job.percent);
  message.set_created_ms(job.created);
  message.set_started_ms(job.started.value_or(0));
  message.set_finished_ms(job.finished.value_or(0));
  message.set_updated_ms(job.updated);
  message.set_cached(job.cached);
  for (const auto& file : job.results) {
    auto& result = *message.add_results();
    result.set_output(file.output);
    result.set_file_name(file.file_name);
    result.set_media_type(file.media_type);
    result.set_bytes(file.bytes);
  }
  if (job.error) {
    message.set_error_code(std::string(to_string(job.error->code)));
    message.set_error_message(job.error->message);
  }
  return message;
}

v1::EstimateReply to_proto(const Estimate& estimate) {
  v1::EstimateReply message;
  message.set_buildings(estimate.buildings);
  message.set_expected_triangles(estimate.triangles);
  message.set_expected_bytes(estimate.bytes);
  for (const auto& expected : estimate.outputs) {
    auto& output = *message.add_outputs();
    output.set_output(expected.output);
    output.set_bytes(expected.bytes);
  }
  message.set_crs(estimate.crs);
  for (const auto& problem : estimate.problems) message.add_problems(problem);
  return message;
}

JobSpec to_spec(const v1::SubmitRequest& request) {
  JobSpec spec;
  spec.process = request.process();
  spec.inputs_json = request.inputs_json();
  for (const auto& output : request.outputs()) spec.outputs[output] = Transmission::Value;
  spec.subscriber.success_uri = request.subscriber().success_uri();
  spec.subscriber.in_progress_uri = request.subscriber().in_progress_uri();
  spec.subscriber.failed_uri = request.subscriber().failed_uri();
  return spec;
}

v1::Process to_proto(const ProcessSpec& process) {
  v1::Process message;
  message.set_id(std::string(process.id));
  message.set_title(std::string(process.title));
  message.set_description(std::string(process.description));
  for (const auto& option : process.inputs) {
    auto& input = *message.add_inputs();
    input.set_name(std::string(option.name));
    input.set_kind(std::string(to_string(option.kind)));
    input.set_default_json(std::string(option.default_json));
    input.set_description(std::string(option.description));
    for (const auto choice : option.choices) input.add_choices(std::string(choice));
    if (option.minimum < option.maximum) {
      input.set_minimum(option.minimum);
      input.set_maximum(option.maximum);
    }
  }
  for (const auto& spec : process.outputs) {
    auto& output = *message.add_outputs();
    output.set_id(std::string(spec.id));
    output.set_media_type(std::string(spec.media_type));
    output.set_title(std::string(spec.title));
  }
  return message;
}

Result<JobFilter> to_filter(const v1::ListRequest& request) {
  JobFilter filter;
  filter.processes.assign(request.processes().begin(), request.processes().end());
  for (const int wanted : request.states()) {
    const auto known =
        std::ranges::find_if(kStates, [&](const auto& pair) { return pair.second == wanted; });
    if (known == kStates.end())
      return fail(ErrorCode::InvalidArgument,
                  fmt::format("states has {}, expected states of a job (1 to 5)", wanted));
    filter.states.push_back(known->first);
  }
  if (request.limit() > kLargestLimit)
    return fail(ErrorCode::InvalidArgument,
                fmt::format("limit is {}, expected 1 to {}", request.limit(), kLargestLimit));
  filter.limit = request.limit() == 0 ? kDefaultLimit : request.limit();
  filter.offset = request.offset();
  return filter;
}

}  // namespace citymesh
