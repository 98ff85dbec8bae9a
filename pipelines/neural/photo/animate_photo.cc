// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/photo/animate_photo.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "data_tools/motion/track_io.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_writer.h"
#include "geometry/base/parallel.h"
#include "geometry/base/prefetcher.h"
#include "neural/photo/photo_renderer.h"
#include "neural/training/training_run.h"
#include "pipelines/animate/animation_limits.h"
#include "pipelines/files.h"
#include "pipelines/neural/photo/photo_animation.h"
#include "pipelines/report_json.h"
#include "pipelines/runs/run_config.h"
#include "render/texture/complete/partial_texture.h"
#include "render/texture/planar_image.h"
#include "render/view/contact_sheet.h"

namespace bodyloom {
namespace {

constexpr int kPhotoSheetColumns = 3;

void CheckRequest(const AnimatePhotoRequest& request) {
  RequireReadable(request.photo.image, "image");
  RequireReadable(request.photo.track, "track of the image");
  RequireReadable(request.photo.labels, "part labels");
  RequireReadable(request.track, "track");
  RequireReadable(request.background.path, "background");
  RequireOutputs({request.track, request.photo.image, request.photo.track, request.photo.body, request.background.path},
                 {request.out, request.sheet, request.texture, request.json});
}

/// What is opened once and used by every stage.
class PhotoAnimation {
 public:
  PhotoAnimation(const AnimatePhotoRequest& request, const PipelineCallbacks& callbacks)
      : request_(request), callbacks_(callbacks) {}

  AnimatePhotoSummary Run() {
    clock_.Begin("prepare");
    const std::vector<PhotoRequest> wanted = PhotosWanted(request_);
    CheckRequest(request_);
    run_ = ReadPhotoRun(request_.run);
    OpenPhotos(wanted);
    OpenMotion();
    FindAppearance();
    SayLines(notes_, callbacks_);
    renderer_ = std::make_unique<PhotoRenderer>(
        CheckpointPath(request_.run), run_.config,
        PhotoRendererOptions{request_.whole_window ? -1 : run_.reach, ThreadsFor(request_.threads), request_.device});
    clock_.Begin("encode the photo");
    EncodePhoto();
    clock_.Begin("render");
    RenderFrames();
    clock_.End();
    WriteSheet(request_.sheet, sheet_, kPhotoSheetColumns, Size());
    AnimatePhotoSummary summary = Summarise();
    WriteReport(request_.json, Report(summary));
    summary.total_seconds = clock_.total();
    return summary;
  }

 private:
  [[nodiscard]] int Size() const { return run_.config.profile.image_size; }
  [[nodiscard]] int TextureSize() const { return run_.config.profile.texture_size; }

  void OpenPhotos(const std::vector<PhotoRequest>& wanted) {
    photos_ = LoadPhotos(wanted, Size(), TextureSize());
    for (const Photo& photo : photos_) notes_ += photo.notes;
  }

  void OpenMotion() {
    track_ = ReadTrack(request_.track);
    maps_ = MapsOfMotion(request_, photos_.front(), request_.track, Size(), TextureSize(), &track_);
  }

  void FindAppearance() {
    const BodyModel& body = *photos_.front().body;
    texel_parts_ = PartsOfTexels(body, *maps_->texels());
    texture_ = AppearanceOf(photos_, request_.garment, texel_parts_, &notes_);
    seen_ = PictureOf(texture_.colour, TextureSize(), TextureSize());
    if (run_.config.GuessesUnseen()) {
      GuessTexture({TextureSize(), texel_parts_, PlacesOfTexels(body, *maps_->texels())}, &texture_);
    }
  }

  void EncodePhoto() {
    renderer_->Encode(texture_);
    const Image completed = PictureOf(renderer_->CompletedTexture(), TextureSize(), TextureSize());
    if (!request_.texture.empty()) WriteImage(request_.texture, completed);
    sheet_ = {PictureOf(photos_.front().frame.image, Size(), Size()), seen_, completed};
  }

  void RenderFrames() {
    const int num_frames = track_.num_frames();
    picture_ = SizeOfPictures(maps_->window(), track_.camera, request_.full_size);
    PhotoBackdrop backdrop(request_.background, photos_.front(), picture_);
    VideoWriter video(request_.out, picture_.width, picture_.height, FramesPerSecond(track_, kFpsWithoutTimes));
    const std::vector<int> on_sheet = EvenlySpreadFrames(num_frames, kSheetFrames);
    // Maps of the next frames are made while the network is at work.
    Prefetcher<PhotoFrame> poses(num_frames, [this](int64_t t) { return PoseAt(static_cast<int>(t)); });
    for (int t = 0; t < num_frames; ++t) {
      const PhotoFrame pose = poses.Take();
      Image composed = backdrop.Next();
      if (pose.size > 0) {
        const Stopwatch one;
        const PhotoPicture picture = renderer_->Render(pose);
        if (t > 0) network_ms_.push_back(1e3 * one.seconds());  // the first frame warms up
        Composite(picture.image, picture.alpha, maps_->window(), t, &composed);
      } else {
        ++lost_;
      }
      video.Write(composed);
      if (std::binary_search(on_sheet.begin(), on_sheet.end(), t)) sheet_.push_back(composed);
      callbacks_.Update("rendering", static_cast<double>(t + 1) / num_frames);
    }
    video.Finish();
  }

  /// Of size 0 where the track has no result.
  [[nodiscard]] PhotoFrame PoseAt(int t) const {
    PhotoFrame pose;
    if (track_.HasResult(t)) FillMaps(maps_->At(t), Size(), TextureSize(), &pose);
    return pose;
  }

  [[nodiscard]] AnimatePhotoSummary Summarise() const {
    AnimatePhotoSummary summary;
    summary.frames = track_.num_frames();
    summary.frames_without_fit = lost_;
    summary.picture = picture_;
    summary.network_ms = MedianOf(network_ms_);
    summary.seconds = clock_.seconds();
    summary.written = FilesAmong({request_.out, request_.texture, request_.sheet, request_.json});
    summary.texels_seen = VisibleShare(texture_, texel_parts_);
    summary.frames_per_second = summary.frames / std::max(1e-9, summary.seconds.back().second);
    summary.notes = notes_;
    return summary;
  }

  [[nodiscard]] nlohmann::ordered_json Report(const AnimatePhotoSummary& summary) const {
    return {{"frames", summary.frames},
            {"frames_without_fit", summary.frames_without_fit},
            {"variant", ToText(run_.config.variant)},
            {"texels_seen", summary.texels_seen},
            {"network_ms_median", summary.network_ms},
            {"frames_per_second", summary.frames_per_second},
            {"picture", {summary.picture.width, summary.picture.height}},
            {"notes", summary.notes},
            {"seconds", ToJson(summary.seconds)},
            {"output", request_.out}};
  }

  const AnimatePhotoRequest& request_;
  const PipelineCallbacks& callbacks_;
  StageClock clock_;
  PhotoRun run_;
  std::vector<Photo> photos_;
  std::string notes_;
  Track track_;
  std::unique_ptr<PhotoMaps> maps_;
  std::vector<uint8_t> texel_parts_;
  PartialTexture texture_;
  Image seen_;  ///< what the photos show of the texture
  std::unique_ptr<PhotoRenderer> renderer_;
  PictureSize picture_;
  std::vector<Image> sheet_;
  std::vector<double> network_ms_;
  int lost_ = 0;
};

}  // namespace

AnimatePhotoSummary AnimatePhoto(const AnimatePhotoRequest& request, const PipelineCallbacks& callbacks) {
  return PhotoAnimation(request, callbacks).Run();
}

}  // namespace bodyloom
