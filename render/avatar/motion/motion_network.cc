// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/avatar/motion/motion_network.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/hash_random.h"
#include "bodyloom/geometry/base/in_range.h"

namespace bodyloom {
namespace {

constexpr int kChannelUnit = 16;  ///< of UvConvolution
constexpr int kFineChannels = 16;
constexpr uint64_t kWeightStream = 0x400;

int RoundedUp(int channels) { return (channels + kChannelUnit - 1) / kChannelUnit * kChannelUnit; }

void Rectify(TexelFeatures* features) {
  for (int y = 0; y < features->side(); ++y) {
    float* row = features->at(y, 0);
    for (int i = 0; i < features->side() * features->channels(); ++i) row[i] = std::max(row[i], 0.0F);
  }
}

/// d loss / d what went into Rectify.
void RectifyBack(const TexelFeatures& out, TexelFeatures* by_out) {
  for (int y = 0; y < out.side(); ++y) {
    const float* value = out.at(y, 0);
    float* by = by_out->at(y, 0);
    for (int i = 0; i < out.side() * out.channels(); ++i) by[i] = value[i] > 0 ? by[i] : 0.0F;
  }
}

/// to = up(coarse + everywhere) + skip. `everywhere` may be empty, `skip` null.
void Enlarge(const TexelFeatures& coarse, std::span<const float> everywhere, const TexelFeatures* skip,
             TexelFeatures* to) {
  const int channels = coarse.channels();
  to->Resize(2 * coarse.side(), channels);
  for (int y = 0; y < to->side(); ++y) {
    for (int x = 0; x < to->side(); ++x) {
      const float* from = coarse.at(y / 2, x / 2);
      const float* beside = skip != nullptr ? skip->at(y, x) : nullptr;
      float* value = to->at(y, x);
      for (int k = 0; k < channels; ++k) {
        value[k] = from[k] + (everywhere.empty() ? 0 : everywhere[k]) + (beside != nullptr ? beside[k] : 0);
      }
    }
  }
}

/// by_coarse = the sums of by_to over every 2×2 texels.
void EnlargeBack(const TexelFeatures& by_to, TexelFeatures* by_coarse) {
  const int channels = by_to.channels();
  by_coarse->Resize(by_to.side() / 2, channels);
  for (int y = 0; y < by_coarse->side(); ++y) {
    for (int x = 0; x < by_coarse->side(); ++x) {
      const float *a = by_to.at(2 * y, 2 * x), *b = by_to.at(2 * y + 1, 2 * x);
      float* sum = by_coarse->at(y, x);
      for (int k = 0; k < channels; ++k) sum[k] = (a[k] + a[channels + k]) + (b[k] + b[channels + k]);
    }
  }
}

void AddTo(const TexelFeatures& from, TexelFeatures* to) {
  for (int y = 0; y < to->side(); ++y) {
    const float* add = from.at(y, 0);
    float* sum = to->at(y, 0);
    for (int i = 0; i < to->side() * to->channels(); ++i) sum[i] += add[i];
  }
}

void SumOver(const TexelFeatures& features, std::vector<float>* sum) {
  sum->assign(features.channels(), 0);
  for (int y = 0; y < features.side(); ++y) {
    for (int x = 0; x < features.side(); ++x) {
      const float* value = features.at(y, x);
      for (size_t k = 0; k < sum->size(); ++k) (*sum)[k] += value[k];
    }
  }
}

}  // namespace

bool MotionNetworkOptions::IsValid(std::string* why) const {
  const InRange in_range(why);
  if (!in_range("side", side, 64, 1024) || !in_range("maps", maps, 1, 256) ||
      !in_range("embedding", embedding, 1, 64) || !in_range("width", width, 16, 256) ||
      !in_range("outputs", outputs, 1, 64)) {
    return false;
  }
  if (side % 64 != 0 || width % kChannelUnit != 0) {
    *why = Concatenate("side ", side, " and width ", width, ", expected multiples of 64 and ", kChannelUnit);
    return false;
  }
  return true;
}

MotionNetwork::MotionNetwork(const MotionNetworkOptions& options, std::vector<uint8_t> shows_body)
    : options_(options), shows_body_(std::move(shows_body)) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "motion network: ", why);
  BODYLOOM_CHECK(shows_body_.size() == static_cast<size_t>(options.side) * options.side,
                 "motion network: ", shows_body_.size(), " texels, expected ", options.side, " squared");
  in_channels_ = RoundedUp(options.maps + 1 + options.embedding);
  const int width = options.width;
  layers_[kA] = {in_channels_, width, 3, 2};
  for (const Layer layer : {kB, kD, kF, kH, kI}) layers_[layer] = {width, width, 3, 1};
  for (const Layer layer : {kC, kE}) layers_[layer] = {width, width, 3, 2};
  layers_[kJ] = {width, kFineChannels, 3, 1};
  layers_[kOut] = {kFineChannels, RoundedUp(options.outputs), 1, 1};
  for (int layer = 0; layer < kNumLayers; ++layer) {
    first_parameter_[layer] = num_parameters_;
    num_parameters_ += layers_[layer].num_parameters();
  }
  dense_ = num_parameters_;
  embedding_ = dense_ + width * width + width;
  num_parameters_ = embedding_ + options.embedding * options.side * options.side;
}

FloatColumns MotionNetwork::Initial(uint64_t seed) const {
  FloatColumns parameters(1, num_parameters_);
  parameters.Fill(0);
  float* value = parameters.column(0);
  HashRandom random(seed, {kWeightStream});
  const auto fill = [&](int first, int count, double deviation) {
    for (int i = 0; i < count; ++i) value[first + i] = static_cast<float>(deviation * random.Normal());
  };
  for (int layer = 0; layer < kOut; ++layer) {
    const UvConvolution& c = layers_[layer];
    fill(first_parameter_[layer], c.num_weights(), std::sqrt(2.0 / (c.size * c.size * c.in_channels)));
  }
  fill(dense_, options_.width * options_.width, std::sqrt(2.0 / options_.width));
  fill(embedding_, options_.embedding * options_.side * options_.side, 1);
  return parameters;
}

std::span<const float> MotionNetwork::Of(const FloatColumns& parameters, Layer layer) const {
  return {parameters.column(0) + first_parameter_[layer], static_cast<size_t>(layers_[layer].num_parameters())};
}

void MotionNetwork::Run(Layer layer, const FloatColumns& parameters, const TexelFeatures& in, int num_threads) {
  Convolve(layers_[layer], Of(parameters, layer), in, num_threads, &out_[layer]);
  if (layer != kOut) Rectify(&out_[layer]);
}

const TexelFeatures& MotionNetwork::Forward(const FloatColumns& parameters, std::span<const float> maps,
                                            int num_threads) {
  const int side = options_.side, texels = side * side, width = options_.width;
  BODYLOOM_CHECK(parameters.rows() == num_parameters_ && parameters.columns() == 1,
                 "motion network: ", parameters.rows(), " parameters, expected ", num_parameters_);
  BODYLOOM_CHECK(maps.size() == static_cast<size_t>(options_.maps) * texels, "motion network: ", maps.size(),
                 " values, expected ", options_.maps, " maps of ", side, " squared");
  in_.Resize(side, in_channels_);
  const float* embedding = parameters.column(0) + embedding_;
  for (int t = 0; t < texels; ++t) {
    float* value = in_.at(t / side, t % side);
    for (int k = 0; k < options_.maps; ++k) value[k] = maps[static_cast<size_t>(k) * texels + t];
    value[options_.maps] = shows_body_[t] != 0 ? 1 : 0;
    for (int k = 0; k < options_.embedding; ++k) {
      value[options_.maps + 1 + k] = embedding[static_cast<size_t>(t) * options_.embedding + k];
    }
  }
  Run(kA, parameters, in_, num_threads);
  Run(kB, parameters, out_[kA], num_threads);
  Run(kC, parameters, out_[kB], num_threads);
  Run(kD, parameters, out_[kC], num_threads);
  Run(kE, parameters, out_[kD], num_threads);
  Run(kF, parameters, out_[kE], num_threads);
  SumOver(out_[kF], &mean_);
  for (float& value : mean_) value /= static_cast<float>(out_[kF].side() * out_[kF].side());
  const float* weights = parameters.column(0) + dense_;
  body_.assign(weights + width * width, weights + width * width + width);
  for (int k = 0; k < width; ++k) {
    for (int c = 0; c < width; ++c) body_[c] += mean_[k] * weights[k * width + c];
  }
  for (float& value : body_) value = std::max(value, 0.0F);
  Enlarge(out_[kF], body_, &out_[kD], &to_h_);
  Run(kH, parameters, to_h_, num_threads);
  Enlarge(out_[kH], {}, &out_[kB], &to_i_);
  Run(kI, parameters, to_i_, num_threads);
  Enlarge(out_[kI], {}, nullptr, &to_j_);
  Run(kJ, parameters, to_j_, num_threads);
  Run(kOut, parameters, out_[kJ], num_threads);
  return out_[kOut];
}

void MotionNetwork::GoBack(Layer layer, const FloatColumns& parameters, const TexelFeatures& in, int first_channel,
                           int num_threads, FloatColumns* by_parameters, TexelFeatures* by_in) {
  if (layer != kOut) RectifyBack(out_[layer], &by_out_[layer]);
  const std::span<float> by(by_parameters->column(0) + first_parameter_[layer],
                            static_cast<size_t>(layers_[layer].num_parameters()));
  ConvolveByParameters(layers_[layer], in, by_out_[layer], num_threads, by);
  ConvolveByInput(layers_[layer], Of(parameters, layer), by_out_[layer], first_channel, num_threads, &scratch_, by_in);
}

void MotionNetwork::Backward(const FloatColumns& parameters, const TexelFeatures& by_out, int num_threads,
                             FloatColumns* by_parameters) {
  BODYLOOM_CHECK(by_out.side() == out_[kOut].side() && by_out.channels() == out_[kOut].channels(),
                 "motion network: derivatives of ", by_out.side(), " texels and ", by_out.channels(), " channels");
  by_parameters->Resize(1, num_parameters_);
  const int width = options_.width;
  const auto back = [&](Layer layer, const TexelFeatures& in, TexelFeatures* by_in) {
    GoBack(layer, parameters, in, 0, num_threads, by_parameters, by_in);
  };
  by_out_[kOut].Resize(by_out.side(), by_out.channels());
  for (int y = 0; y < by_out.side(); ++y) {
    std::copy_n(by_out.at(y, 0), static_cast<ptrdiff_t>(by_out.side()) * by_out.channels(), by_out_[kOut].at(y, 0));
  }
  back(kOut, out_[kJ], &by_out_[kJ]);
  back(kJ, to_j_, &by_in_[kJ]);
  EnlargeBack(by_in_[kJ], &by_out_[kI]);
  back(kI, to_i_, &by_in_[kI]);
  EnlargeBack(by_in_[kI], &by_out_[kH]);
  back(kH, to_h_, &by_in_[kH]);
  EnlargeBack(by_in_[kH], &by_out_[kF]);

  // g reaches every texel that f reaches.
  SumOver(by_out_[kF], &by_body_);
  for (int c = 0; c < width; ++c) by_body_[c] = body_[c] > 0 ? by_body_[c] : 0.0F;
  const float* weights = parameters.column(0) + dense_;
  float* by_weights = by_parameters->column(0) + dense_;
  std::copy(by_body_.begin(), by_body_.end(), by_weights + width * width);
  by_mean_.assign(width, 0);
  const auto texels = static_cast<float>(out_[kF].side() * out_[kF].side());
  for (int k = 0; k < width; ++k) {
    for (int c = 0; c < width; ++c) {
      by_weights[k * width + c] = mean_[k] * by_body_[c];
      by_mean_[k] += weights[k * width + c] * by_body_[c];
    }
    by_mean_[k] /= texels;
  }
  for (int y = 0; y < out_[kF].side(); ++y) {
    for (int x = 0; x < out_[kF].side(); ++x) {
      for (int k = 0; k < width; ++k) by_out_[kF].at(y, x)[k] += by_mean_[k];
    }
  }

  back(kF, out_[kE], &by_out_[kE]);
  back(kE, out_[kD], &by_out_[kD]);
  AddTo(by_in_[kH], &by_out_[kD]);
  back(kD, out_[kC], &by_out_[kC]);
  back(kC, out_[kB], &by_out_[kB]);
  AddTo(by_in_[kI], &by_out_[kB]);
  back(kB, out_[kA], &by_out_[kA]);
  const int first = (options_.maps + 1) / kChannelUnit * kChannelUnit;
  GoBack(kA, parameters, in_, first, num_threads, by_parameters, &by_in_[kA]);
  float* by_embedding = by_parameters->column(0) + embedding_;
  for (int t = 0; t < options_.side * options_.side; ++t) {
    const float* by = by_in_[kA].at(t / options_.side, t % options_.side) + options_.maps + 1 - first;
    std::copy_n(by, options_.embedding, by_embedding + static_cast<size_t>(t) * options_.embedding);
  }
}

}  // namespace bodyloom
