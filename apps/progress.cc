// SPDX-License-Identifier: Apache-2.0
#include "apps/progress.h"

#include <unistd.h>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <iostream>
#include <memory>
#include <optional>

#include "pipelines/report_text.h"

namespace bodyloom {
namespace {

constexpr double kBarInterval = 0.1, kLineInterval = 10;  // seconds
constexpr int kBarCells = 24;
constexpr double kMinFractionForEta = 0.02;  // earlier guesses are noise

/// `done`: by this run, of the whole; less than `fraction` where a run goes on with what an earlier one did.
std::string EtaText(double fraction, double done, double elapsed_seconds) {
  if (done < kMinFractionForEta) {
    return "";
  }
  return ", " + ClockText(elapsed_seconds * (1 - fraction) / done) + " left";
}

}  // namespace

Progress::Style Progress::DefaultStyle() { return isatty(STDERR_FILENO) != 0 ? Style::kBar : Style::kLines; }

Progress::Progress(std::string title, Style style) : Progress(std::move(title), style, std::cerr) {}

Progress::Progress(std::string title, Style style, std::ostream& out)
    : title_(std::move(title)), style_(style), out_(out) {}

Progress::~Progress() { Wipe(); }

void Progress::Wipe() {
  if (style_ == Style::kBar && drawn_width_ > 0) {
    out_ << "\r" << std::string(drawn_width_, ' ') << "\r" << std::flush;
    drawn_width_ = 0;
  }
}

void Progress::Update(const std::string& stage, double fraction) {
  const Clock::time_point now = Clock::now();
  const bool new_stage = stage != stage_;
  const double interval = style_ == Style::kBar ? kBarInterval : kLineInterval;
  if (first_fraction_ < 0) {
    first_fraction_ = std::clamp(fraction, 0.0, 1.0);
    start_ = now;
  }
  fraction_ = std::max(fraction_, std::clamp(fraction, 0.0, 1.0));
  if (style_ == Style::kSilent || (!new_stage && now - last_drawn_ < std::chrono::duration<double>(interval))) {
    return;
  }
  stage_ = stage;
  last_drawn_ = now;
  Draw(stage, fraction_, std::chrono::duration<double>(now - start_).count());
}

void Progress::Draw(const std::string& stage, double fraction, double elapsed_seconds) {
  const int percent = static_cast<int>(std::floor(100 * fraction));
  std::string line = title_ + " ";
  if (style_ == Style::kBar) {
    const int filled = static_cast<int>(std::floor(kBarCells * fraction));
    line += "[" + std::string(filled, '#') + std::string(kBarCells - filled, '.') + "] ";
  }
  line += std::to_string(percent) + " % " + stage + EtaText(fraction, fraction - first_fraction_, elapsed_seconds);
  if (style_ == Style::kBar) {
    out_ << "\r" << line << std::string(std::max(drawn_width_, line.size()) - line.size(), ' ') << std::flush;
    drawn_width_ = line.size();
  } else {
    out_ << line << std::endl;
  }
}

namespace {

volatile std::sig_atomic_t interrupt_flag = 0;

void RaiseFlag(int) { interrupt_flag = 1; }

}  // namespace

void InstallSignalHandlers() {
  struct sigaction action = {};
  action.sa_handler = RaiseFlag;
  // SA_RESETHAND: a second signal has its default effect, for work that does not poll.
  action.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

bool IsInterrupted() { return interrupt_flag != 0; }

PipelineCallbacks CommandCallbacks(bool quiet, std::ostream& messages) {
  const Progress::Style style = quiet ? Progress::Style::kSilent : Progress::DefaultStyle();
  const auto shown = std::make_shared<std::optional<Progress>>();
  PipelineCallbacks callbacks;
  callbacks.begin = [shown, style](const std::string& work) { shown->emplace(work, style); };
  callbacks.progress = [shown](const std::string& stage, double fraction) {
    if (*shown) (*shown)->Update(stage, fraction);
    return !IsInterrupted();
  };
  callbacks.message = [shown, &messages](const std::string& line) {
    if (*shown) (*shown)->Wipe();
    messages << line << std::endl;
  };
  return callbacks;
}

}  // namespace bodyloom
