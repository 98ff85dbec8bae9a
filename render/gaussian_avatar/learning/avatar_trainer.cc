// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/learning/avatar_trainer.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"
#include "render/gaussian_avatar/cloth_bones.h"

namespace bodyloom {
namespace {

constexpr float kCopySize = 0.8F;

float OpacityAt(const GaussianBody& body, int row) {
  return 1 / (1 + std::exp(-body.parameters(row, GaussianBody::kOpacityLogit)));
}

/// Offset from a Gaussian's mean, in rest space, sampled from its distribution.
Eigen::Vector3f DrawnOffset(const GaussianBody& body, int row, HashRandom* random) {
  const FloatColumns& p = body.parameters;
  Eigen::Quaternionf turn(p(row, GaussianBody::kQuaternion), p(row, GaussianBody::kQuaternion + 1),
                          p(row, GaussianBody::kQuaternion + 2), p(row, GaussianBody::kQuaternion + 3));
  if (turn.norm() < 1e-6F) turn = Eigen::Quaternionf::Identity();
  Eigen::Vector3f along;
  for (int k = 0; k < 3; ++k) {
    along[k] = static_cast<float>(random->Normal()) * std::exp(p(row, GaussianBody::kLogScale + k));
  }
  return turn.normalized() * along;
}

void CopyRow(int from, int to, GaussianBody* body) {
  for (int c = 0; c < GaussianBody::kNumParameters; ++c) body->parameters(to, c) = body->parameters(from, c);
  std::copy_n(body->joints.begin() + static_cast<int64_t>(from) * GaussianBody::kInfluences, GaussianBody::kInfluences,
              body->joints.begin() + static_cast<int64_t>(to) * GaussianBody::kInfluences);
  body->anchors[to] = body->anchors[from];
  body->kinds[to] = body->kinds[from];
}

enum TrainerStream : uint64_t { kOrderStream = 0x300, kBackgroundStream, kRelocateStream };

/// Normalises columns first to first + count − 1 of a row, unless they are zero.
void Normalise(int row, int first, int count, FloatColumns* table) {
  float square = 0;
  for (int c = first; c < first + count; ++c) square += (*table)(row, c) * (*table)(row, c);
  if (!(square > 1e-12F)) return;
  const float scale = 1 / std::sqrt(square);
  for (int c = first; c < first + count; ++c) (*table)(row, c) *= scale;
}

bool IsUsable(const TrainingView& view) { return !view.window.empty() && view.person_pixels > 0; }

/// Number of pixels that an unoccluded Gaussian covers: the integral of its α.
float PixelsAlone(const FloatColumns& screen, int row) {
  const float xy = screen(row, ScreenGaussians::kConicXy);
  const float determinant = screen(row, ScreenGaussians::kConicXx) * screen(row, ScreenGaussians::kConicYy) - xy * xy;
  return screen(row, ScreenGaussians::kOpacity) * 2 * static_cast<float>(M_PI) /
         std::sqrt(std::max(1e-12F, determinant));
}

}  // namespace

std::vector<int> RelocateGaussians(std::span<const float> pull, const RelocateOptions& options, GaussianBody* body) {
  const int count = body->size();
  BODYLOOM_CHECK(static_cast<int>(pull.size()) == count, "moving Gaussians: ", pull.size(), " pulls for ", count,
                 " rows");
  std::vector<double> until(count);
  std::vector<int> dead;
  double total = 0;
  for (int i = 0; i < count; ++i) {
    const bool lives = OpacityAt(*body, i) >= options.dead_opacity;
    if (lives && std::isfinite(pull[i]) && pull[i] > 0) total += pull[i];
    if (!lives) dead.push_back(i);
    until[i] = total;
  }
  if (!(total > 0)) return {};
  for (const int row : dead) {
    HashRandom random(options.seed, {0x200, static_cast<uint64_t>(row)});
    const double drawn = total * random.Uniform();
    const auto from = static_cast<int>(std::upper_bound(until.begin(), until.end(), drawn) - until.begin());
    if (from >= count) continue;
    const float opacity = std::min(0.999F, OpacityAt(*body, from)), halved = 1 - std::sqrt(1 - opacity);
    body->parameters(from, GaussianBody::kOpacityLogit) = std::log(halved / (1 - halved));
    for (int k = 0; k < 3; ++k) body->parameters(from, GaussianBody::kLogScale + k) += std::log(kCopySize);
    const Eigen::Vector3f offset = DrawnOffset(*body, from, &random);
    CopyRow(from, row, body);
    for (int k = 0; k < 3; ++k) body->parameters(row, GaussianBody::kPosition + k) += offset[k];
  }
  return dead;
}

bool AvatarTrainerOptions::IsValid(std::string* why) const {
  const InRange in_range(why);
  return in_range("steps", static_cast<double>(steps), 1, 1e8) && in_range("seconds", seconds, 0, 1e8) &&
         rates.IsValid(why) && scales.IsValid(why) && held_out.IsValid(why) &&
         in_range("cost by opacity", cost.by_opacity, 0, 1e3) && in_range("cost by scale", cost.by_scale, 0, 1e3) &&
         in_range("cost by distance", cost.by_distance, 0, 1e3) && in_range("relocate_every", relocate_every, 0, 1e8) &&
         in_range("min_seen", min_seen, 0, 1) && in_range("refine_from", refine_from, 0, 1) &&
         in_range("relocate_until", relocate_until, 0, 1) && in_range("dead_opacity", dead_opacity, 0, 0.99) &&
         in_range("num_threads", num_threads, 1, 1024);
}

AvatarTrainingState AvatarTrainingState::Of(GaussianBody body) {
  AvatarTrainingState state;
  state.adam.Reset(body.parameters.columns(), body.size());
  state.light_adam.Reset(1, GaussianBody::kLightValues);
  state.pull.assign(body.size(), 0);
  state.body = std::move(body);
  return state;
}

AvatarTrainer::AvatarTrainer(const MatrixX3i& faces, std::span<const TrainingView> views,
                             const AvatarTrainerOptions& options, const PoseRefiner* refiner)
    : faces_(faces), views_(views), options_(options), refiner_(refiner) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "avatar training: ", why);
  for (size_t i = 0; i < views.size(); ++i) {
    if (IsUsable(views[i])) usable_.push_back(static_cast<int>(i));
    BODYLOOM_CHECK(refiner == nullptr || (views[i].time >= 0 && views[i].time < refiner->num_frames()),
                   "avatar training: a view of frame ", views[i].time, ", poses to refine are of ",
                   refiner == nullptr ? 0 : refiner->num_frames(), " frames");
  }
  BODYLOOM_CHECK(!usable_.empty(), "avatar training: none of the ", views.size(), " frames shows the person");
}

double AvatarTrainer::Progress(const AvatarTrainingState& state) const {
  const double by_steps = static_cast<double>(state.step) / static_cast<double>(options_.steps);
  const double by_time = options_.seconds > 0 ? state.seconds / options_.seconds : 0;
  return std::min(1.0, std::max({by_steps, by_time, state.held_out.Progress(state.step, options_.held_out)}));
}

void AvatarTrainer::SetValidationViews(std::span<const TrainingView> held_out) {
  held_out_.clear();
  for (const TrainingView& view : held_out) {
    if (IsUsable(view)) held_out_.push_back(&view);
  }
}

int AvatarTrainer::ViewAt(int64_t step) {
  const auto count = static_cast<int64_t>(usable_.size()), round = step / count;
  if (std::exchange(order_of_, round) != round) {
    order_ = usable_;
    HashRandom random(options_.seed, {kOrderStream, static_cast<uint64_t>(round)});
    for (size_t i = order_.size(); i > 1; --i) std::swap(order_[i - 1], order_[random.Below(i)]);
  }
  return order_[step % count];
}

const AvatarFrame& AvatarTrainer::FrameOf(const TrainingView& view, const AvatarTrainingState& state) {
  const AvatarFrame* frame = &view.frame;
  const int64_t round = state.step / static_cast<int64_t>(usable_.size());
  if (const auto run = (round + view.time) % static_cast<int64_t>(1 + view.other_cloth.size()); run > 0) {
    in_other_cloth_ = view.frame;
    ReplaceLastBones(view.other_cloth[run - 1], &in_other_cloth_);
    frame = &in_other_cloth_;
  }
  if (refiner_ == nullptr || state.poses.IsZero(view.time)) return *frame;
  refiner_->MakeFrame(view.time, state.poses, options_.num_threads, &corrected_);
  CarryBones(*frame, &corrected_);
  return corrected_;
}

void AvatarTrainer::MovePose(const TrainingView& view, double progress, AvatarTrainingState* state) const {
  if (refiner_ == nullptr || progress < options_.refine_from) return;
  const double since = (progress - options_.refine_from) / std::max(1e-9, 1 - options_.refine_from);
  refiner_->Step(view.time, gradient_.bones, view.person_pixels, since, &state->poses);
}

AvatarStep AvatarTrainer::Step(AvatarTrainingState* state) {
  const Stopwatch watch;
  BODYLOOM_CHECK(static_cast<int>(state->pull.size()) == state->body.size(), "avatar training: ", state->pull.size(),
                 " pulls for ", state->body.size(), " Gaussians");
  const double progress = Progress(*state);
  AvatarStep done;
  done.view = ViewAt(state->step);
  const TrainingView& view = views_[done.view];
  clock_.Begin("drawing");
  const AvatarFrame& frame = FrameOf(view, *state);
  const AvatarView seen = Draw(view, frame, *state);
  clock_.Begin("loss");
  FillTruth(view, &truth_);
  HashRandom random(options_.seed, {kBackgroundStream, static_cast<uint64_t>(state->step)});
  std::array<float, 3> background{};
  for (float& b : background) b = static_cast<float>(random.Uniform());
  done.loss = loss_.Compute(painter_.image().planes(), truth_, background, options_.num_threads, &by_planes_);
  if (std::isfinite(done.loss)) {
    clock_.Begin("derivatives");
    painter_.GoBack(state->body, faces_, frame, seen, by_planes_, &gradient_);
    clock_.Begin("moving");
    MovePose(view, progress, state);
    if (options_.learn_person) LearnPerson(progress, state, &done);
  }
  ++state->step;
  if (options_.learn_person) done.relocated = Relocate(state, progress);
  Validate(state);
  clock_.End();
  state->seconds += watch.seconds();
  return done;
}

AvatarView AvatarTrainer::Draw(const TrainingView& view, const AvatarFrame& frame, const AvatarTrainingState& state) {
  AvatarView seen;
  seen.camera = view.camera, seen.window = view.window, seen.options.num_threads = options_.num_threads;
  painter_.Draw(state.body, faces_, frame, seen);
  return seen;
}

void AvatarTrainer::Validate(AvatarTrainingState* state) {
  const int every = options_.held_out.every;
  if (held_out_.empty() || every == 0 || (state->step % every != 0 && !IsDone(*state))) return;
  clock_.Begin("held-out frames");
  constexpr std::array<float, 3> kGrey = {0.5F, 0.5F, 0.5F};
  double sum = 0;
  for (const TrainingView* view : held_out_) {
    Draw(*view, view->frame, *state);
    FillTruth(*view, &truth_);
    sum += loss_.Compute(painter_.image().planes(), truth_, kGrey, options_.num_threads, &by_planes_);
  }
  const double loss = sum / static_cast<double>(held_out_.size());
  if (!state->kept || loss < state->kept->loss) state->kept = {state->body, state->step, loss};
  if (state->step % every == 0) state->held_out.Add(loss, state->step, Progress(*state), options_.held_out);
}

void AvatarTrainer::LearnPerson(double progress, AvatarTrainingState* state, AvatarStep* done) {
  done->drawn = ChooseMovers(state);
  done->cost = AddGaussianCost(state->body, options_.cost, &gradient_.parameters);
  Move(state, progress);
  MoveLight(state);
}

int AvatarTrainer::ChooseMovers(AvatarTrainingState* state) {
  const FloatColumns& by_screen = painter_.by_screen();
  const auto minimum = static_cast<float>(options_.min_seen * ImageLoss::ByPixel(truth_));
  const FloatColumns& screen = painter_.screen().columns;
  moves_.resize(state->body.size());
  int drawn = 0;
  for (int i = 0; i < state->body.size(); ++i) {
    moves_[i] = painter_.screen().IsDrawn(i) ? 1 : 0;
    drawn += moves_[i];
    const float x = by_screen(i, ScreenGaussians::kMeanX), y = by_screen(i, ScreenGaussians::kMeanY);
    state->pull[i] += std::sqrt(x * x + y * y);
    float by_colour = 0;
    for (int c = ScreenGaussians::kRed; c <= ScreenGaussians::kBlue; ++c) by_colour += std::abs(by_screen(i, c));
    if (moves_[i] != 0 && by_colour >= minimum * PixelsAlone(screen, i)) continue;
    if (state->body.kinds[i] != GaussianKind::kLoose) moves_[i] = 0;
    for (int c = 0; c < GaussianBody::kNumParameters; ++c) gradient_.parameters(i, c) = 0;
  }
  return drawn;
}

void AvatarTrainer::Move(AvatarTrainingState* state, double progress) {
  AdamStep(gradient_.parameters, options_.rates.At(progress, state->step), moves_, options_.num_threads, &state->adam,
           &state->body.parameters);
  LimitScales(options_.scales, &state->body);
  for (int i = 0; i < state->body.size(); ++i) {
    if (moves_[i] == 0) continue;
    Normalise(i, GaussianBody::kQuaternion, 4, &state->body.parameters);
    Normalise(i, GaussianBody::kNormal, 3, &state->body.parameters);
  }
}

void AvatarTrainer::MoveLight(AvatarTrainingState* state) {
  FloatColumns light(1, GaussianBody::kLightValues), by_light(1, GaussianBody::kLightValues);
  std::copy(state->body.light.begin(), state->body.light.end(), light.column(0));
  std::copy(gradient_.light.begin(), gradient_.light.end(), by_light.column(0));
  const std::vector<uint8_t> all(GaussianBody::kLightValues, 1);
  AdamStep(by_light, std::span(&options_.rates.light, 1), all, 1, &state->light_adam, &light);
  std::copy_n(light.column(0), GaussianBody::kLightValues, state->body.light.begin());
}

int AvatarTrainer::Relocate(AvatarTrainingState* state, double progress) {
  if (options_.relocate_every == 0 || state->step % options_.relocate_every != 0) return 0;
  std::vector<int> moved;
  if (progress < options_.relocate_until) {
    const uint64_t seed = HashRandom(options_.seed, {kRelocateStream, static_cast<uint64_t>(state->step)}).Next();
    moved = RelocateGaussians(state->pull, {options_.dead_opacity, seed}, &state->body);
    for (const int row : moved) state->adam.Forget(row);
  }
  std::fill(state->pull.begin(), state->pull.end(), 0.0F);
  return static_cast<int>(moved.size());
}

namespace {

/// Exponential decay from `rate` to rate · at_end.
float Shrunk(double rate, double at_end, double progress) {
  return static_cast<float>(rate * std::pow(at_end, std::clamp(progress, 0.0, 1.0)));
}

}  // namespace

bool AvatarRates::IsValid(std::string* why) const {
  const InRange in_range(why);
  return in_range("rate of position", position, 0, 1) && in_range("position_at_end", position_at_end, 1e-6, 1) &&
         in_range("rate of quaternion", quaternion, 0, 1) && in_range("rate of log_scale", log_scale, 0, 1) &&
         in_range("rate of opacity_logit", opacity_logit, 0, 1) && in_range("rate of albedo", albedo, 0, 1) &&
         in_range("rate of normal", normal, 0, 1) && in_range("rate of weight_logit", weight_logit, 0, 1) &&
         in_range("rate of light", light, 0, 1) && in_range("others_at_end", others_at_end, 1e-6, 1) &&
         in_range("settle_steps", settle_steps, 1, 1e9);
}

std::array<float, GaussianBody::kNumParameters> AvatarRates::At(double progress, int64_t step) const {
  std::array<float, GaussianBody::kNumParameters> rates{};
  const auto set = [&](int first, int count, double rate) {
    std::fill_n(rates.begin() + first, count, static_cast<float>(rate));
  };
  const double settled = Shrunk(1, others_at_end, 2 * progress - 1) / std::sqrt(1 + double(step) / settle_steps);
  set(GaussianBody::kPosition, 3, Shrunk(position, position_at_end, progress));
  set(GaussianBody::kQuaternion, 4, settled * quaternion);
  set(GaussianBody::kLogScale, 3, settled * log_scale);
  set(GaussianBody::kOpacityLogit, 1, settled * opacity_logit);
  set(GaussianBody::kAlbedo, 3, settled * albedo);
  set(GaussianBody::kNormal, 3, settled * normal);
  set(GaussianBody::kWeightLogit, GaussianBody::kInfluences, settled * weight_logit);
  return rates;
}

double AddGaussianCost(const GaussianBody& body, const GaussianCost& cost, FloatColumns* gradient) {
  const FloatColumns& p = body.parameters;
  BODYLOOM_CHECK(gradient->rows() == p.rows() && gradient->columns() == p.columns(), "Gaussians' cost: derivatives of ",
                 gradient->rows(), " rows, expected ", p.rows());
  const int count = body.size();
  if (count == 0) return 0;
  const float by_scale = cost.by_scale / static_cast<float>(count);
  double opacities = 0, scales = 0;
  for (int i = 0; i < count; ++i) {
    const float opacity = 1 / (1 + std::exp(-p(i, GaussianBody::kOpacityLogit)));
    if (body.kinds[i] == GaussianKind::kCloth) continue;
    const float by_opacity =
        (cost.by_opacity + cost.by_distance * (1 - body.anchors[i].corrective_factor)) / static_cast<float>(count);
    opacities += by_opacity * opacity;
    (*gradient)(i, GaussianBody::kOpacityLogit) += by_opacity * opacity * (1 - opacity);
  }
  for (int c = GaussianBody::kLogScale; c < GaussianBody::kLogScale + 3; ++c) {
    for (int i = 0; i < count; ++i) {
      const float scale = std::exp(p(i, c));
      scales += scale;
      (*gradient)(i, c) += by_scale * scale;
    }
  }
  return opacities + by_scale * scales;
}

}  // namespace bodyloom
