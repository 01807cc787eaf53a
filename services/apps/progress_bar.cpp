#include "services/apps/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

namespace citymesh {
namespace {

constexpr std::size_t kBarWidth = 30;
constexpr std::chrono::milliseconds kRedraw{100};
constexpr std::chrono::seconds kPlainLine{5};

}  // namespace

std::string progress_line(const Progress& progress, double elapsed_s) {
  if (progress.total == 0)
    return progress.done == 0 ? std::string(progress.stage)
                              : fmt::format("{} {}", progress.stage, progress.done);
  const auto done = std::min(progress.done, progress.total);
  const auto part = static_cast<double>(done) / static_cast<double>(progress.total);
  const auto filled = static_cast<std::size_t>(part * kBarWidth);
  auto line = fmt::format("{:<8} [{}{}] {}/{} {:3.0f} %", progress.stage, std::string(filled, '#'),
                          std::string(kBarWidth - filled, '.'), done, progress.total, 100 * part);
  if (done > 0 && elapsed_s > 0)
    line += fmt::format(", {:.0f}/s", static_cast<double>(done) / elapsed_s);
  return line;
}

ProgressBar::ProgressBar(std::FILE* out) : out_(out), terminal_(isatty(fileno(out)) == 1) {}

ProgressBar::~ProgressBar() {
  if (terminal_) fmt::print(out_, "\r\033[K");
  std::fflush(out_);
}

void ProgressBar::show(const Progress& progress) {
  const auto now = Clock::now();
  const auto fresh = !stages_.contains(progress.stage);
  if (fresh) stages_.emplace(progress.stage);
  const auto pause = terminal_ ? Clock::duration(kRedraw) : Clock::duration(kPlainLine);
  if (!fresh && now - shown_ < pause) return;
  shown_ = now;
  const auto line = progress_line(progress, std::chrono::duration<double>(now - started_).count());
  fmt::print(out_, "{}{}{}", terminal_ ? "\r\033[K" : "", line, terminal_ ? "" : "\n");
  std::fflush(out_);
}

}  // namespace citymesh
