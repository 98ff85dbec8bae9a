// SPDX-License-Identifier: Apache-2.0
#include "neural/lifter/train_lifter.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <exception>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "geometry/check.h"
#include "neural/lifter/lifter_loss.h"
#include "neural/lifter/lifter_module.h"
#include "neural/muon.h"
#include "neural/runtime.h"
#include "neural/training/schedules.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;
using torch::Tensor;

constexpr uint64_t kValidationSeeds = uint64_t{1} << 62;
constexpr const char* kHeader =
    "step,learning_rate,loss,distance,nll,velocity,up,contact,gradient_norm,validation_distance,"
    "validation_best_distance,seconds\n";

struct Batch {
  Tensor features;  ///< B×inputs×T
  LifterTargets targets;
};

Tensor Stack(const std::vector<LifterExample>& examples, std::vector<float> LifterExample::*field, const char* name,
             int64_t frames, int64_t columns) {
  const auto B = static_cast<int64_t>(examples.size());
  Tensor result = torch::empty({B, frames, columns});
  for (int64_t b = 0; b < B; ++b) {
    const std::vector<float>& values = examples[b].*field;
    BODYLOOM_CHECK(static_cast<int64_t>(values.size()) == frames * columns, "lifter training: an example has ",
                   values.size(), " numbers of ", name, ", expected ", frames, "x", columns);
    std::copy(values.begin(), values.end(), result.data_ptr<float>() + b * frames * columns);
  }
  return result;
}

Batch MakeBatch(const LifterSource& source, uint64_t first_seed, int count, const TrainLifterOptions& options) {
  std::vector<LifterExample> examples(count);
  for (int b = 0; b < count; ++b) source(first_seed + b, &examples[b]);
  const int T = options.num_frames;
  Batch batch;
  batch.features =
      Stack(examples, &LifterExample::features, "features", T, options.num_inputs).transpose(1, 2).contiguous();
  batch.targets.points =
      Stack(examples, &LifterExample::points, "points", T, 3 * LifterOutput::kPoints).reshape({count, T, -1, 3});
  batch.targets.up = Stack(examples, &LifterExample::up, "up", T, 3);
  batch.targets.contact = Stack(examples, &LifterExample::contact, "contact", T, 2);
  return batch;
}

/// Makes the batches of steps first, first + 1, … on a thread of its own, a few ahead.
class BatchQueue {
 public:
  BatchQueue(const LifterSource& source, const TrainLifterOptions& options, int first)
      : thread_([this, &source, &options, first] { Run(source, options, first); }) {}
  ~BatchQueue() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  BatchQueue(const BatchQueue&) = delete;
  BatchQueue& operator=(const BatchQueue&) = delete;

  Batch Take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !batches_.empty() || error_ != nullptr; });
    if (batches_.empty()) std::rethrow_exception(error_);
    Batch batch = std::move(batches_.front());
    batches_.pop_front();
    changed_.notify_all();
    return batch;
  }

 private:
  static constexpr size_t kAhead = 3;
  void Run(const LifterSource& source, const TrainLifterOptions& options, int first) {
    try {
      for (int step = first; step < options.steps; ++step) {
        const uint64_t seed = (options.seed << 40) + uint64_t(step) * uint64_t(options.batch);
        Batch batch = MakeBatch(source, seed, options.batch, options);
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return stop_ || batches_.size() < kAhead; });
        if (stop_) return;
        batches_.push_back(std::move(batch));
        changed_.notify_all();
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      error_ = std::current_exception();
      changed_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Batch> batches_;
  std::exception_ptr error_;
  bool stop_ = false;
  std::thread thread_;
};

double LearningRate(const TrainLifterOptions& options, int step) {
  return CosineWithWarmup(options.learning_rate, step, options.steps, options.warmup_steps);
}

/// metrics.csv, kept up to a step: a run that goes on from a checkpoint writes later lines anew.
std::string MetricsUpTo(const fs::path& path, int step) {
  std::ifstream file(path);
  std::string kept = kHeader, line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    if (std::atoi(line.c_str()) <= step) kept += line + "\n";
  }
  return kept;
}

class Trainer {
 public:
  Trainer(const LifterSource& train, const LifterSource& validation, const TrainLifterOptions& options)
      : train_(train), validation_(validation), options_(options) {
    torch::manual_seed(options.seed);
    module_ = LifterModule(options.num_inputs, options.width, options.dilations);
    average_ = LifterModule(options.num_inputs, options.width, options.dilations);
    ImportLifter(ExportLifter(module_), &average_);
    std::vector<Tensor> matrices, others;
    for (const auto& item : module_->named_parameters()) {
      const bool block = item.key().rfind("block", 0) == 0 && item.value().dim() == 3;
      (block && options.muon ? matrices : others).push_back(item.value());
    }
    optimizer_ = std::make_unique<torch::optim::AdamW>(
        others, torch::optim::AdamWOptions(options.learning_rate).weight_decay(options.weight_decay));
    muon_ = std::make_unique<Muon>(matrices, Muon::Options{0.95, options.weight_decay});
  }

  TrainLifterResult Run() {
    const fs::path metrics_path = fs::path(options_.run_dir) / "metrics.csv";
    if (options_.resume) LoadCheckpoint();
    metrics_ = options_.resume ? MetricsUpTo(metrics_path, step_) : kHeader;
    const auto start = std::chrono::steady_clock::now();
    const auto seconds = [&] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    BatchQueue queue(train_, options_, step_);
    TrainLifterResult result;
    TrainLifterSummary& summary = result.summary;
    summary.status = TrainStatus::kFinished;
    while (step_ < options_.steps) {
      const LifterLoss loss = Step(queue.Take());
      if (!std::isfinite(loss.distance + loss.nll) || !std::isfinite(gradient_norm_)) {
        summary.status = TrainStatus::kNotFinite;
        summary.message = "the loss is not finite at step " + std::to_string(step_) + "; checkpoint.pt holds step " +
                          std::to_string(last_checkpoint_);
        break;
      }
      ++step_;
      const bool last = step_ == options_.steps;
      const bool validates = last || step_ % options_.validate_every == 0;
      if (validates) Validate();
      if (last || step_ % options_.report_every == 0) {
        Report(loss, seconds(), validates);
        WriteText(metrics_path, metrics_);
        const bool go_on = !options_.progress || options_.progress({step_, options_.steps, loss.total.item<double>(),
                                                                    loss.distance, loss.nll, distance_, seconds()});
        if (!go_on) {
          SaveCheckpoint();
          summary.status = TrainStatus::kStopped;
          summary.message = "stopped at step " + std::to_string(step_);
          break;
        }
      }
      if (last || step_ % options_.checkpoint_every == 0) SaveCheckpoint();
    }
    summary.steps = step_;
    summary.seconds = seconds();
    summary.validation_distance = distance_;
    summary.validation_best_distance = best_distance_;
    result.weights = ExportLifter(average_);
    return result;
  }

 private:
  LifterLoss Step(const Batch& batch) {
    const double rate = LearningRate(options_, step_);
    for (auto& group : optimizer_->param_groups()) {
      static_cast<torch::optim::AdamWOptions&>(group.options()).lr(rate);
    }
    module_->zero_grad();  // of all weights: two optimizers share them
    LifterLoss loss =
        ComputeLifterLoss(module_(batch.features), batch.targets, {options_.nll_weight, options_.velocity_weight});
    loss.total.backward();
    gradient_norm_ = torch::nn::utils::clip_grad_norm_(module_->parameters(), options_.clip_norm);
    if (!std::isfinite(gradient_norm_)) return loss;  // a step would spoil the weights
    optimizer_->step();
    muon_->Step(rate);
    const torch::NoGradGuard no_grad;
    // Early steps count less, or the start would stay in the average for long.
    const double keep = std::min(options_.average, (1.0 + step_) / (10.0 + step_));
    const auto from = module_->parameters();
    const auto to = average_->parameters();
    for (size_t i = 0; i < from.size(); ++i) to[i].lerp_(from[i], 1 - keep);
    return loss;
  }

  void Validate() {
    const torch::NoGradGuard no_grad;
    double distance = 0, best = 0;
    int done = 0;
    while (done < options_.validation_windows) {
      const int count = std::min(options_.batch, options_.validation_windows - done);
      const Batch batch = MakeBatch(validation_, kValidationSeeds + done, count, options_);
      const Tensor output = average_(batch.features);
      const auto mean = [&](const Tensor& points) {
        return (points - batch.targets.points).square().sum(-1).sqrt().mean().item<double>() * count;
      };
      distance += mean(LikeliestPoints(output));
      best += mean(NearestPoints(output, batch.targets.points));
      done += count;
    }
    distance_ = distance / std::max(1, done);
    best_distance_ = best / std::max(1, done);
  }

  void Report(const LifterLoss& loss, double seconds, bool validated) {
    std::ostringstream line;
    line.precision(5);
    line << step_ << ',' << LearningRate(options_, step_ - 1) << ',' << loss.total.item<double>() << ','
         << loss.distance << ',' << loss.nll << ',' << loss.velocity << ',' << loss.up << ',' << loss.contact << ','
         << gradient_norm_ << ',';
    if (validated) line << distance_ << ',' << best_distance_;
    if (!validated) line << ',';
    line << ',' << seconds << '\n';
    metrics_ += line.str();
  }

  static void WriteText(const fs::path& path, const std::string& text) {
    const fs::path whole = path.string() + ".part";
    std::ofstream file(whole, std::ios::binary | std::ios::trunc);
    file << text;
    file.close();
    if (!file) throw std::runtime_error(path.string() + ": cannot be written");
    fs::rename(whole, path);
  }

  /// What must agree before a checkpoint's numbers mean anything: LibTorch loads tensors of any size.
  [[nodiscard]] Tensor Shape() const {
    std::vector<int64_t> shape = {options_.num_inputs, options_.width};
    shape.insert(shape.end(), options_.dilations.begin(), options_.dilations.end());
    return torch::tensor(shape);
  }

  [[nodiscard]] fs::path CheckpointPath() const { return fs::path(options_.run_dir) / "checkpoint.pt"; }

  void SaveCheckpoint() {
    torch::serialize::OutputArchive archive, module, average, optimizer, muon;
    module_->save(module);
    average_->save(average);
    optimizer_->save(optimizer);
    muon_->Save(muon);
    archive.write("module", module);
    archive.write("average", average);
    archive.write("optimizer", optimizer);
    archive.write("muon", muon);
    archive.write("step", torch::tensor(int64_t{step_}));
    archive.write("shape", Shape());
    const fs::path whole = CheckpointPath().string() + ".part";
    try {
      archive.save_to(whole.string());
    } catch (const c10::Error& error) {
      throw std::runtime_error(CheckpointPath().string() + ": cannot be written: " + error.what_without_backtrace());
    }
    fs::rename(whole, CheckpointPath());
    last_checkpoint_ = step_;
  }

  void LoadCheckpoint() {
    try {
      torch::serialize::InputArchive archive, module, average, optimizer, muon;
      archive.load_from(CheckpointPath().string());
      archive.read("module", module);
      archive.read("average", average);
      archive.read("optimizer", optimizer);
      archive.read("muon", muon);
      Tensor step, shape;
      archive.read("step", step);
      archive.read("shape", shape);
      if (!torch::equal(shape, Shape())) {
        std::ostringstream text;
        text << CheckpointPath().string() << ": a network of " << shape[0].item<int64_t>() << " inputs, "
             << shape[1].item<int64_t>() << " channels and " << shape.numel() - 2 << " blocks, expected "
             << options_.num_inputs << ", " << options_.width << " and " << options_.dilations.size()
             << " of the same dilations";
        throw std::runtime_error(text.str());
      }
      module_->load(module);
      average_->load(average);
      optimizer_->load(optimizer);
      muon_->Load(muon);
      step_ = last_checkpoint_ = static_cast<int>(step.item<int64_t>());
    } catch (const c10::Error& error) {
      throw std::runtime_error(CheckpointPath().string() +
                               ": not a checkpoint of a lifter: " + error.what_without_backtrace());
    }
  }

  const LifterSource &train_, &validation_;
  const TrainLifterOptions& options_;
  LifterModule module_{nullptr}, average_{nullptr};
  std::unique_ptr<torch::optim::AdamW> optimizer_;
  std::unique_ptr<Muon> muon_;
  int step_ = 0, last_checkpoint_ = 0;
  double gradient_norm_ = 0, distance_ = 0, best_distance_ = 0;
  std::string metrics_;
};

}  // namespace

bool TrainLifterOptions::IsValid(std::string* why) const {
  const auto in_range = [&](const char* name, double value, double low, double high) {
    if (value >= low && value <= high) return true;
    *why = Concatenate(name, " is ", value, ", expected ", low, " to ", high);
    return false;
  };
  return in_range("num_inputs", num_inputs, 1, 4096) && in_range("num_frames", num_frames, 1, 4096) &&
         in_range("width", width, 1, 4096) && in_range("steps", steps, 1, 1e8) && in_range("batch", batch, 1, 4096) &&
         in_range("learning_rate", learning_rate, 0, 1) && in_range("average", average, 0, 1) &&
         in_range("clip_norm", clip_norm, 0, 1e9) && in_range("num_threads", num_threads, 0, 256) &&
         in_range("report_every", report_every, 1, 1e8) && in_range("validate_every", validate_every, 1, 1e8) &&
         in_range("checkpoint_every", checkpoint_every, 1, 1e8) &&
         in_range("validation_windows", validation_windows, 0, 1e6) && in_range("seed", double(seed), 0, 1 << 20);
}

TrainLifterResult TrainLifter(const LifterSource& train, const LifterSource& validation,
                              const TrainLifterOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "lifter training: ", why);
  StartNeuralRuntime(options.num_threads);
  return Trainer(train, validation, options).Run();
}

}  // namespace bodyloom
