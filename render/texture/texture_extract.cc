// SPDX-License-Identifier: Apache-2.0
#include "render/texture/texture_extract.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"

namespace bodyloom {

bool TextureExtractOptions::IsValid(std::string* why) const {
  if (keep < 1 || keep > 64) {
    *why = Concatenate("keep is ", keep, ", expected 1..64 samples");
    return false;
  }
  if (edge_margin_px < 0 || edge_margin_px > 64 || step_margin_px < -1 || step_margin_px > 64 || !(edge_step_m > 0)) {
    *why = Concatenate("edge_margin_px is ", edge_margin_px, ", step_margin_px ", step_margin_px, ", edge_step_m ",
                       edge_step_m, "; expected 0..64, -1..64 and more than 0");
    return false;
  }
  return texels.IsValid(why) && sight.IsValid(why);
}

void SampleImage(const Image& image, double x_px, double y_px, float bgr[3]) {
  const double x = std::clamp(x_px, 0.0, image.width - 1.0), y = std::clamp(y_px, 0.0, image.height - 1.0);
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, image.width - 1), y1 = std::min(y0 + 1, image.height - 1);
  const double fx = x - x0, fy = y - y0;
  for (int c = 0; c < 3; ++c) {
    const double top = (1 - fx) * image.pixel(x0, y0)[c] + fx * image.pixel(x1, y0)[c];
    const double bottom = (1 - fx) * image.pixel(x0, y1)[c] + fx * image.pixel(x1, y1)[c];
    bgr[c] = static_cast<float>(((1 - fy) * top + fy * bottom) / 255);
  }
}

TextureExtractor::TextureExtractor(const BodyModel& body, const TextureExtractOptions& options)
    : body_(body), options_(options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "texture: ", why);
  table_ = BuildUvTexelTable(body, options.texels);
  samples_.resize(table_.size() * options.keep);
}

void TextureExtractor::FindEdges(std::span<const uint8_t> person, int image_width) {
  const PixelBox& box = buffer_.box();
  const int width = box.width(), height = box.height();
  const int margin = person.empty() ? options_.edge_margin_px : std::max(1, options_.edge_margin_px);
  const int step_margin = options_.step_margin_px;
  near_edge_.assign(box.area(), 0);
  if (margin == 0 && step_margin <= 0) return;
  std::vector<uint8_t> edge(box.area(), 0), limb(step_margin > 0 ? box.area() : 0, 0);
  std::vector<double> depth(box.area());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) depth[size_t(y) * width + x] = buffer_.DepthAt(box.x_begin + x, box.y_begin + y);
  }
  const auto is_step = [&](double a, double b) { return !(std::abs(a - b) <= options_.edge_step_m); };
  const auto is_limb = [&](size_t p, size_t q) { return std::isfinite(depth[p]) && std::isfinite(depth[q]); };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const size_t p = size_t(y) * width + x;
      const bool right = x + 1 < width && is_step(depth[p], depth[p + 1]);
      const bool below = y + 1 < height && is_step(depth[p], depth[p + width]);
      const bool border = x == 0 || y == 0 || x + 1 == width || y + 1 == height;  // outside the box is background
      const bool other = !person.empty() && person[size_t(box.y_begin + y) * image_width + box.x_begin + x] == 0;
      edge[p] |= border || right || below || other || !std::isfinite(depth[p]);
      if (right) edge[p + 1] = 1;
      if (below) edge[p + width] = 1;
      if (limb.empty()) continue;
      if (right && is_limb(p, p + 1)) limb[p] = limb[p + 1] = 1;
      if (below && is_limb(p, p + width)) limb[p] = limb[p + width] = 1;
    }
  }
  // Dilated by margin − 1 along rows, then along columns: the pixel at a step is already marked.
  const auto spread = [](const std::vector<uint8_t>& from, int reach, std::vector<uint8_t>* to, int count, size_t start,
                         size_t step) {
    int last = -(1 << 20);
    for (int i = 0; i < count; ++i) {  // from the left, then from the right
      if (from[start + i * step]) last = i;
      if (i - last <= reach) (*to)[start + i * step] = 1;
    }
    last = 1 << 20;
    for (int i = count - 1; i >= 0; --i) {
      if (from[start + i * step]) last = i;
      if (last - i <= reach) (*to)[start + i * step] = 1;
    }
  };
  const auto spread_both = [&](const std::vector<uint8_t>& from, int by) {
    std::vector<uint8_t> rows(box.area(), 0);
    for (int y = 0; y < height; ++y) spread(from, by - 1, &rows, width, size_t(y) * width, 1);
    for (int x = 0; x < width; ++x) spread(rows, by - 1, &near_edge_, height, x, width);
  };
  if (margin > 0) spread_both(edge, margin);
  if (step_margin > 0) spread_both(limb, step_margin);
}

bool TextureExtractor::IsNearEdge(float x_px, float y_px) const {
  const int x = static_cast<int>(std::lround(x_px)), y = static_cast<int>(std::lround(y_px));
  return !buffer_.box().Contains(x, y) || near_edge_[buffer_.box().IndexOf(x, y)] != 0;
}

int TextureExtractor::Add(const Image& image, const MatrixX3d& vertices_in_camera, const Camera& camera, int frame,
                          std::span<const uint8_t> person) {
  BODYLOOM_CHECK(image.width == camera.width && image.height == camera.height, "texture: frame ", frame, " is ",
                 image.width, "x", image.height, ", the camera is for ", camera.width, "x", camera.height);
  BODYLOOM_CHECK(person.empty() || person.size() == size_t(image.width) * image.height, "texture: frame ", frame,
                 ": a mask of ", person.size(), " pixels for ", image.width, "x", image.height);
  buffer_.Render(vertices_in_camera, body_.data().faces, camera);
  const std::vector<TexelVisibility> sights =
      ComputeTexelVisibility(table_, body_, vertices_in_camera, camera, buffer_, options_.sight);
  FindEdges(person, image.width);
  int num_seen = 0;
  for (size_t i = 0; i < sights.size(); ++i) {
    const TexelVisibility& sight = sights[i];
    if (!(sight.cosine > 0) || IsNearEdge(sight.x_px, sight.y_px)) continue;
    ++num_seen;
    Sample sample;
    sample.weight = sight.cosine * sight.cosine / std::max(1.0F, sight.texels_per_pixel);
    // Replaces the kept sample of lowest weight; of equals the earlier frame stays.
    Sample* own = &samples_[i * options_.keep];
    Sample* worst = std::min_element(own, own + options_.keep,
                                     [](const Sample& a, const Sample& b) { return a.weight < b.weight; });
    if (!(sample.weight > worst->weight)) continue;
    SampleImage(image, sight.x_px, sight.y_px, sample.bgr);
    sample.frame = frame;
    sample.x_px = sight.x_px;
    sample.y_px = sight.y_px;
    *worst = sample;
  }
  return num_seen;
}

Texture TextureExtractor::Merge() const {
  Texture texture;
  texture.width = table_.width;
  texture.height = table_.height;
  const size_t pixels = size_t(table_.width) * table_.height;
  texture.bgr.assign(3 * pixels, 0.0F);
  texture.confidence.assign(pixels, 0.0F);
  texture.source_frame.assign(pixels, -1);
  texture.source_x_px.assign(pixels, 0.0F);
  texture.source_y_px.assign(pixels, 0.0F);
  std::vector<Sample> samples;
  for (size_t i = 0; i < table_.size(); ++i) {
    samples.clear();
    for (int k = 0; k < options_.keep; ++k) {
      const Sample& sample = samples_[i * options_.keep + k];
      if (sample.frame >= 0) samples.push_back(sample);
    }
    if (samples.empty()) continue;
    ++texture.num_seen;
    const size_t p = static_cast<size_t>(table_.pixel[i]);
    const Sample& best = *std::max_element(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) {
      return a.weight < b.weight || (a.weight == b.weight && a.frame > b.frame);
    });
    texture.confidence[p] = std::min(1.0F, best.weight);
    texture.source_frame[p] = best.frame;
    texture.source_x_px[p] = best.x_px;
    texture.source_y_px[p] = best.y_px;
    float total = 0;
    for (const Sample& sample : samples) total += sample.weight;
    for (int c = 0; c < 3; ++c) {
      float value = 0;
      if (options_.merge == TextureExtractOptions::Merge::kMean) {
        for (const Sample& sample : samples) value += sample.weight * sample.bgr[c] / total;
      } else {
        std::sort(samples.begin(), samples.end(),
                  [c](const Sample& a, const Sample& b) { return a.bgr[c] < b.bgr[c]; });
        float sum = 0;
        for (size_t k = 0; k < samples.size(); ++k) {
          sum += samples[k].weight;
          if (2 * sum < total) continue;
          // Exactly half on both sides: the mean of the two.
          value = 2 * sum == total && k + 1 < samples.size() ? 0.5F * (samples[k].bgr[c] + samples[k + 1].bgr[c])
                                                             : samples[k].bgr[c];
          break;
        }
      }
      texture.bgr[c * pixels + p] = value;
    }
  }
  return texture;
}

}  // namespace bodyloom
