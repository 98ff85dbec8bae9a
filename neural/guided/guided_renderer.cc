// SPDX-License-Identifier: Apache-2.0
#include "neural/guided/guided_renderer.h"

#include "geometry/base/check.h"
#include "neural/guided/guided_model.h"
#include "neural/guided/guided_tensors.h"
#include "neural/training/checkpoint.h"

namespace bodyloom {

class GuidedRenderer::Impl {
 public:
  Impl(const std::string& path, const GuidedConfig& config, const GuidedRendererOptions& options)
      : config_(config), options_(options) {
    std::string why;
    BODYLOOM_CHECK(config.IsValid(&why), "pose-guided renderer: ", why);
    model_ = LoadModel<GuidedModel>(path, config, options.num_threads, options.device);
  }

  void SetSource(std::span<const PhotoFrame> photos, const SourceBody& body) {
    const int size = config_.profile.image_size;
    BODYLOOM_CHECK(!photos.empty(), "pose-guided renderer: no photo");
    BODYLOOM_CHECK(photos[0].size == size, "pose-guided renderer: a photo of ", photos[0].size, " px, expected ", size);
    const torch::NoGradGuard no_grad;
    const GuidedTensors tensors = TensorsOf(photos.first(1));
    BODYLOOM_CHECK(tensors.image.defined(), "pose-guided renderer: the source has no image");
    codes_ = model_->EncodeSource(tensors);
    last_ = {};
    SourceBody known = body;
    known.garments_known = config_.source_labels;
    source_ = MapsOfSource(photos, known, completion(), config_.profile.contour_hints,
                           [&](const PhotoFrame& frame, const PseudoImage& pseudo) { return Draw(frame, pseudo); });
    BODYLOOM_CHECK(source_.texels_seen > 0, "pose-guided renderer: the photos show nothing of the body");
  }

  [[nodiscard]] MapCompletion completion() const { return options_.completion.value_or(config_.Completion()); }

  RenderedPerson Render(const PhotoFrame& frame) {
    BODYLOOM_CHECK(source_.maps.size > 0, "pose-guided renderer: no source yet");
    ++frames_;
    if (last_.size > 0 && frame.uv == last_uv_ && frame.parts == last_parts_) {
      ++frames_kept_;
      return last_;
    }
    last_ = Draw(frame, LookUp(source_.maps, frame));
    last_uv_ = frame.uv;
    last_parts_ = frame.parts;
    return last_;
  }

  SourceMaps source_;
  int64_t frames_ = 0, frames_kept_ = 0;
  double computed_ = 0;  ///< sum over frames, in windows

 private:
  RenderedPerson Draw(const PhotoFrame& frame, const PseudoImage& pseudo) {
    double share = 0;
    RenderedPerson rendered = DrawGuided(&model_, codes_, frame, pseudo, options_.reach, &share);
    computed_ += share;
    ++drawn_;
    return rendered;
  }

  GuidedConfig config_;
  GuidedRendererOptions options_;
  GuidedModel model_{nullptr};
  GuidedSource codes_;
  RenderedPerson last_;
  std::vector<float> last_uv_;
  std::vector<uint8_t> last_parts_;

 public:
  int64_t drawn_ = 0;
};

GuidedRenderer::GuidedRenderer(const std::string& checkpoint_path, const GuidedConfig& config,
                               const GuidedRendererOptions& options)
    : impl_(std::make_unique<Impl>(checkpoint_path, config, options)) {}
GuidedRenderer::~GuidedRenderer() = default;

void GuidedRenderer::SetSource(std::span<const PhotoFrame> photos, const SourceBody& body) {
  impl_->SetSource(photos, body);
}
RenderedPerson GuidedRenderer::Render(const PhotoFrame& frame) { return impl_->Render(frame); }
MapCompletion GuidedRenderer::completion() const { return impl_->completion(); }
const CoherentMaps& GuidedRenderer::maps() const { return impl_->source_.maps; }
const std::vector<RenderedPerson>& GuidedRenderer::virtual_images() const { return impl_->source_.virtual_images; }
int64_t GuidedRenderer::frames_kept() const { return impl_->frames_kept_; }
double GuidedRenderer::computed_share() const {
  return impl_->drawn_ > 0 ? impl_->computed_ / static_cast<double>(impl_->drawn_) : 0;
}

}  // namespace bodyloom
