// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/guided/animate_guided.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_writer.h"
#include "geometry/base/parallel.h"
#include "neural/guided/guided_renderer.h"
#include "neural/training/training_run.h"
#include "pipelines/animate/animation_limits.h"
#include "pipelines/files.h"
#include "pipelines/neural/guided/guided_people.h"
#include "pipelines/neural/guided/guided_preview.h"
#include "pipelines/neural/guided/guided_scores.h"
#include "pipelines/neural/photo/photo_animation.h"
#include "pipelines/report_json.h"
#include "pipelines/runs/run_config.h"
#include "render/texture/planar_image.h"
#include "render/view/contact_sheet.h"

namespace bodyloom {
namespace {

constexpr int kSheetColumns = 5, kSmallestCell = 160;

void CheckRequest(const AnimateGuidedRequest& request) {
  if (request.track.empty() == request.data.empty()) throw RequestError("one of --track and --data is needed");
  if (!request.data.empty() && !(request.view_yaw.empty() && request.garment.from.empty())) {
    throw RequestError("--data compares with its own pictures: not with --view-yaw or --garment-from");
  }
  if (request.data.empty() && !request.weights.empty()) throw RequestError("--weights measure the pictures of --data");
  RequireReadable(request.photo.image, "image");
  RequireReadable(request.track, "track");
  RequireReadable(request.data, "data");
  RequireReadable(request.background.path, "background");
  RequireOutputs({request.photo.image, request.track, request.photo.track, request.background.path},
                 {request.out, request.sheet, request.uv_maps, request.json});
}

/// What is opened once and used by every stage.
class GuidedAnimation {
 public:
  GuidedAnimation(const AnimateGuidedRequest& request, const PipelineCallbacks& callbacks)
      : request_(request), callbacks_(callbacks) {}

  AnimateGuidedSummary Run() {
    const std::vector<PhotoRequest> wanted = PhotosWanted(request_);
    CheckRequest(request_);
    OpenRun();
    OpenPhotos(wanted);
    if (!request_.data.empty()) shown_ = FramesAmong(wanted, request_.data);
    OpenMotion();
    EncodePhotos();
    RenderFrames();
    WriteSheet(request_.sheet, sheet_, kSheetColumns, std::max(kSmallestCell, Size()));
    if (!request_.uv_maps.empty()) {
      WriteImage(request_.uv_maps, GuidedMapsSheet(renderer_->maps(), renderer_->virtual_pictures(),
                                                   static_cast<int>(frames_of_photos_.size())));
    }
    AnimateGuidedSummary summary = Summarise();
    WriteReport(request_.json, Report(summary));
    summary.total_seconds = watch_.seconds();
    return summary;
  }

 private:
  [[nodiscard]] int Size() const { return run_.config.profile.image_size; }
  [[nodiscard]] int TextureSize() const { return run_.config.profile.texture_size; }
  /// What the motion was read from.
  [[nodiscard]] const std::string& MotionPath() const { return request_.data.empty() ? request_.track : request_.data; }

  void OpenRun() {
    run_ = ReadGuidedRun(request_.run);
    renderer_ =
        std::make_unique<GuidedRenderer>(CheckpointPath(request_.run), run_.config,
                                         GuidedRendererOptions{request_.anywhere ? 0 : run_.reach, request_.completion,
                                                               ThreadsFor(request_.threads), request_.device});
  }

  void OpenPhotos(const std::vector<PhotoRequest>& wanted) {
    photos_ = LoadPhotos(wanted, Size(), TextureSize());
    for (const Photo& photo : photos_) {
      notes_ += photo.notes;
      frames_of_photos_.push_back(photo.frame);
    }
  }

  void OpenMotion() {
    track_ = request_.data.empty() ? ReadTrack(request_.track) : SinglePersonDataset(request_.data).track();
    maps_ = MapsOfMotion(request_, photos_.front(), MotionPath(), Size(), TextureSize(), &track_);
  }

  void EncodePhotos() {
    const Photo& photo = photos_.front();
    const std::vector<uint8_t> texel_parts = PartsOfTexels(*photo.body, *maps_->texels());
    std::vector<uint8_t> lent;
    if (!request_.garment.from.empty()) lent = LentTexels(request_.garment, photos_.back(), texel_parts, &notes_);
    std::vector<PhotoFrame> virtual_views;
    if (renderer_->completion() == MapCompletion::kVirtualViews) {
      virtual_views = VirtualViews(*photo.body, photo.track.motion.betas, Size(), TextureSize());
    }
    const TexelNeighbours neighbours(TextureSize(), texel_parts, PlacesOfTexels(*photo.body, *maps_->texels()));
    read_s_ = watch_.Lap();
    try {
      renderer_->SetSource(frames_of_photos_, {texel_parts, virtual_views, &neighbours, lent});
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(request_.photo.image + ": " + error.what());
    }
    source_s_ = watch_.Lap();
  }

  void RenderFrames() {
    const int num_frames = track_.num_frames();
    picture_ = SizeOfPictures(maps_->window(), track_.camera, request_.full_size);
    if (request_.background.own) notes_ += "background: the photo's, filled in where the person stood\n";
    PhotoBackdrop backdrop(request_.background, photos_.front(), picture_);
    SayLines(notes_, callbacks_);
    if (!request_.data.empty()) {
      truth_ = std::make_unique<SinglePersonDataset>(request_.data);
      scorer_ = std::make_unique<GuidedScorer>(true, GuidedScoreWeightsOf(ReadWeightsFolder(request_.weights)));
    }
    VideoWriter video(request_.out, picture_.width, picture_.height, FramesPerSecond(track_, kFpsWithoutTimes));
    const std::vector<int> on_sheet = EvenlySpreadFrames(num_frames, kSheetFrames);
    const Stopwatch frames_watch;
    for (int t = 0; t < num_frames; ++t) {
      Image composed = backdrop.Next();
      if (track_.HasResult(t)) {
        const bool to_sheet = !request_.sheet.empty() && std::binary_search(on_sheet.begin(), on_sheet.end(), t);
        RenderFrame(t, to_sheet, &composed);
      } else {
        ++lost_;
      }
      video.Write(composed);
      callbacks_.Update("rendering", static_cast<double>(t + 1) / num_frames);
    }
    video.Finish();
    frames_s_ = frames_watch.seconds();
  }

  /// Lays the picture of frame t into `composed`.
  void RenderFrame(int t, bool to_sheet, Image* composed) {
    const PersonWindow& window = maps_->window();
    Stopwatch watch;
    PhotoFrame frame;
    FillMaps(maps_->At(t), Size(), TextureSize(), &frame);
    maps_s_ += watch.Lap();
    const GuidedPicture picture = renderer_->Render(frame);
    const double network_s = watch.Lap();
    networks_s_ += network_s;
    network_ms_.push_back(1e3 * network_s);
    Composite(picture.image, picture.alpha, window, t, composed);
    if (truth_ && shown_.count(t) == 0) {
      const PersonFrame truth = truth_->Read(t, {true, false, false, false});
      FillPicture({CutWindow(truth.rgb, window, t), CutLabels(truth.labels, window, t)}, &frame);
      scorer_->Add(picture, frame);
    }
    if (!to_sheet) return;
    const int size = Size();
    sheet_.push_back(PictureOf(frames_of_photos_.front().image, size, size));
    sheet_.push_back(PictureOf(LookUp(renderer_->maps(), frame).image, size, size));
    sheet_.push_back(LabelsPicture(picture.labels, size, size));
    sheet_.push_back(PictureOf(picture.image, size, size));
    sheet_.push_back(frame.image.empty() ? *composed : PictureOf(frame.image, size, size));
  }

  [[nodiscard]] AnimateGuidedSummary Summarise() const {
    AnimateGuidedSummary summary;
    summary.frames = track_.num_frames();
    summary.frames_without_fit = lost_;
    summary.picture = picture_;
    summary.network_ms = MedianOf(network_ms_);
    summary.seconds = {
        {"read", read_s_}, {"source", source_s_}, {"maps", maps_s_}, {"networks", networks_s_}, {"frames", frames_s_}};
    summary.written = FilesAmong({request_.out, request_.sheet, request_.uv_maps, request_.json});
    summary.source_seconds = source_s_;
    summary.frame_seconds = frames_s_;
    summary.computed_share = renderer_->computed_share();
    summary.frames_kept = renderer_->frames_kept();
    if (scorer_) summary.scores = scorer_->Scores();
    summary.notes = notes_;
    return summary;
  }

  [[nodiscard]] nlohmann::ordered_json Report(const AnimateGuidedSummary& summary) const {
    nlohmann::ordered_json json = {{"frames", summary.frames},
                                   {"frames_without_fit", summary.frames_without_fit},
                                   {"frames_kept", summary.frames_kept},
                                   {"photos", photos_.size()},
                                   {"completion", ToText(renderer_->completion())},
                                   {"window", Size()},
                                   {"picture", {summary.picture.width, summary.picture.height}},
                                   {"computed_share", summary.computed_share},
                                   {"network_ms_median", summary.network_ms},
                                   {"notes", summary.notes},
                                   {"seconds", ToJson(summary.seconds)},
                                   {"output", request_.out}};
    if (summary.scores) json["scores"] = ToJson(*summary.scores);
    return json;
  }

  const AnimateGuidedRequest& request_;
  const PipelineCallbacks& callbacks_;
  Stopwatch watch_;
  GuidedRun run_;
  std::unique_ptr<GuidedRenderer> renderer_;
  std::vector<Photo> photos_;
  std::vector<PhotoFrame> frames_of_photos_;
  std::set<int> shown_;  ///< frames of the data that are photos, and not scored
  std::string notes_;
  Track track_;
  std::unique_ptr<PhotoMaps> maps_;
  std::unique_ptr<SinglePersonDataset> truth_;
  std::unique_ptr<GuidedScorer> scorer_;
  PictureSize picture_;
  std::vector<Image> sheet_;
  std::vector<double> network_ms_;
  double read_s_ = 0, source_s_ = 0, maps_s_ = 0, networks_s_ = 0, frames_s_ = 0;
  int lost_ = 0;
};

}  // namespace

AnimateGuidedSummary AnimateGuided(const AnimateGuidedRequest& request, const PipelineCallbacks& callbacks) {
  return GuidedAnimation(request, callbacks).Run();
}

}  // namespace bodyloom
