// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/person/animate_from_photo.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/video/image_file.h"
#include "geometry/base/prefetcher.h"
#include "geometry/scene/rig.h"
#include "pipelines/animate/animation_limits.h"
#include "pipelines/body_of_track.h"
#include "pipelines/files.h"
#include "pipelines/neural/person/person_renderer.h"
#include "pipelines/neural/weights_folder.h"
#include "pipelines/report_json.h"

namespace bodyloom {
namespace {

constexpr int kSmallestCell = 160;

void CheckRequest(const AnimateFromPhotoRequest& request) {
  if (request.track.empty() == request.data.empty()) throw RequestError("one of --track and --data is needed");
  if (!request.data.empty() && !(request.view_yaw.empty() && request.garment.from.empty())) {
    throw RequestError("--data compares with its own images: not with --view-yaw or --garment-from");
  }
  if (request.data.empty() && !request.weights.empty()) throw RequestError("--weights measure the images of --data");
  RequireReadable(request.photo.image, "image");
  RequireReadable(request.photo.track, "track of the image");
  RequireReadable(request.photo.labels, "part labels");
  RequireReadable(request.track, "track");
  RequireReadable(request.data, "data");
  RequireReadable(request.background.path, "background");
  RequireOutputs({request.track, request.photo.image, request.photo.track, request.photo.body, request.background.path},
                 {request.out, request.sheet, request.surface, request.json});
}

/// Resources that are opened once and used by all stages.
class PhotoPersonAnimation : public FramePainter {
 public:
  PhotoPersonAnimation(const AnimateFromPhotoRequest& request, const PipelineCallbacks& callbacks)
      : request_(request), callbacks_(callbacks) {}

  AnimateFromPhotoSummary Run() {
    const std::vector<PhotoRequest> wanted = PhotosWanted(request_);
    CheckRequest(request_);
    renderer_ = OpenPersonRenderer({request_.renderer, request_.run, request_.whole_window, request_.completion,
                                    request_.threads, request_.device});
    OpenPhotos(wanted);
    if (!request_.data.empty()) shown_ = FramesAmong(wanted, request_.data);
    OpenMotion();
    EncodePhotos();
    AnimateFromPhotoSummary summary = RenderFrames();
    WriteSheet(request_.sheet, sheet_, renderer_->sheet_columns(), std::max(kSmallestCell, renderer_->size()));
    WriteReport(request_.json, Report(summary));
    summary.total_seconds = watch_.seconds();
    return summary;
  }

  const Image& NextBackground() override { return backdrop_->Next(); }

  double Paint(int t, Image* composed) override {
    watch_.Lap();
    frame_ = poses_->Take();
    maps_s_ += watch_.Lap();
    rendered_ = renderer_->Render(frame_);
    const double network_s = watch_.Lap();
    networks_s_ += network_s;
    const PersonWindow& window = maps_->window();
    Composite(rendered_.image, rendered_.alpha, window, t, composed);
    if (truth_ && shown_.count(t) == 0) {
      const PersonFrame truth = truth_->Read(t, {true, false, false, false});
      FillImage({CutWindow(truth.rgb, window, t), CutLabels(truth.labels, window, t)}, &frame_);
      scorer_->Add(rendered_, frame_);
    }
    return network_s;
  }

  std::vector<Image> ForSheet(int /*t*/, bool painted, const Image& composed) override {
    return painted ? renderer_->SheetRow(photos_.front(), frame_, rendered_, composed) : std::vector<Image>();
  }

 private:
  [[nodiscard]] const Photo& photo() const { return opened_.front(); }

  void OpenPhotos(const std::vector<PhotoRequest>& wanted) {
    opened_ = LoadPhotos(wanted, renderer_->size(), renderer_->texture_size());
    for (const Photo& photo : opened_) {
      notes_ += photo.notes;
      photos_.push_back(photo.frame);
    }
  }

  void OpenMotion() {
    const bool of_data = !request_.data.empty();
    track_ = of_data ? SinglePersonDataset(request_.data).track() : ReadTrack(request_.track, MovingCamera::kTake);
    track_ = WithStillCamera(*photo().body, TrackOnBody(*photo().body, std::move(track_)));
    maps_ = MapsOfMotion(request_, photo(), of_data ? request_.data : request_.track, renderer_->size(),
                         renderer_->texture_size(), &track_);
  }

  void EncodePhotos() {
    const BodyModel& body = *photo().body;
    const std::vector<uint8_t> texel_parts = PartsOfTexels(body, *maps_->texels());
    const std::vector<int> lent = PartsNamed(request_.garment.parts);
    if (!lent.empty()) NoteLent(request_.garment, opened_.back(), texel_parts, &notes_);
    const TexelNeighbours neighbours(renderer_->texture_size(), texel_parts, PlacesOfTexels(body, *maps_->texels()));
    read_s_ = watch_.Lap();
    try {
      texels_seen_ = renderer_->SetPerson({photos_, lent, texel_parts, &neighbours, &body, photo().track.motion.betas});
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(request_.photo.image + ": " + error.what());
    }
    if (!request_.surface.empty()) WriteImage(request_.surface, renderer_->SurfaceImage());
    if (!request_.sheet.empty()) sheet_ = renderer_->SheetBegin(photos_.front());
    source_s_ = watch_.Lap();
  }

  AnimateFromPhotoSummary RenderFrames() {
    const ImageSize size = SizeOfImages(maps_->window(), track_.camera, request_.full_size);
    if (request_.background.own) notes_ += "background: the photo's, filled in where the person stood\n";
    backdrop_.emplace(request_.background, photo(), size);
    SayLines(notes_, callbacks_);
    if (!request_.data.empty()) {
      truth_ = std::make_unique<SinglePersonDataset>(request_.data);
      scorer_.emplace(LikenessScoring(LikenessWeightsOf(ReadWeightsFolder(request_.weights))));
    }
    std::vector<int> with_result;
    for (int t = 0; t < track_.num_frames(); ++t) {
      if (track_.HasResult(t)) with_result.push_back(t);
    }
    // Maps of the next frames are made while the networks are at work.
    poses_ = std::make_unique<Prefetcher<PhotoFrame>>(with_result.size(), [this, with_result](int64_t i) {
      PhotoFrame pose;
      FillMaps(maps_->At(with_result[i]), renderer_->size(), renderer_->texture_size(), &pose);
      return pose;
    });
    int columns = 0;
    const Stopwatch frames;
    AnimateFromPhotoSummary summary;
    static_cast<AnimationSummary&>(summary) = WriteAnimation(
        request_, track_, size, FramesPerSecond(track_, kFpsWithoutTimes), callbacks_, this, &sheet_, &columns);
    summary.frame_seconds = frames.seconds();
    const PersonRenderer::Stages stages = renderer_->stages();
    summary.seconds = {{stages.read, read_s_},
                       {stages.source, source_s_},
                       {"maps", maps_s_},
                       {"networks", networks_s_},
                       {stages.frames, summary.frame_seconds}};
    summary.written = FilesAmong({request_.out, request_.surface, request_.sheet, request_.json});
    summary.texels_seen = texels_seen_;
    summary.source_seconds = source_s_;
    summary.computed_share = renderer_->computed_share();
    summary.frames_kept = renderer_->frames_kept();
    if (scorer_) summary.scores = scorer_->Scores();
    summary.notes = notes_;
    return summary;
  }

  [[nodiscard]] nlohmann::ordered_json Report(const AnimateFromPhotoSummary& summary) const {
    nlohmann::ordered_json json = ReportOf(summary, request_.out);
    json.update(renderer_->Report());
    json["photos"] = photos_.size();
    json["texels_seen"] = summary.texels_seen;
    json["window"] = renderer_->size();
    json["frames_kept"] = summary.frames_kept;
    if (summary.computed_share) json["computed_share"] = *summary.computed_share;
    json["frames_per_second"] = summary.FramesPerSecond();
    json["notes"] = summary.notes;
    if (summary.scores) json["scores"] = ToJson(*summary.scores);
    return json;
  }

  const AnimateFromPhotoRequest& request_;
  const PipelineCallbacks& callbacks_;
  Stopwatch watch_;
  std::unique_ptr<PersonRenderer> renderer_;
  std::vector<Photo> opened_;
  std::vector<PhotoFrame> photos_;
  std::set<int> shown_;  ///< frames of the data that are photos, and not scored
  std::string notes_;
  Track track_;
  std::unique_ptr<PhotoMaps> maps_;
  std::unique_ptr<SinglePersonDataset> truth_;
  std::optional<PersonScorer> scorer_;
  std::optional<PhotoBackdrop> backdrop_;
  PhotoFrame frame_;         ///< painted last
  RenderedPerson rendered_;  ///< of it
  std::vector<Image> sheet_;
  double texels_seen_ = 0, read_s_ = 0, source_s_ = 0, maps_s_ = 0, networks_s_ = 0;
  std::unique_ptr<Prefetcher<PhotoFrame>> poses_;  ///< last: its thread uses the rest
};

}  // namespace

AnimateFromPhotoSummary AnimateFromPhoto(const AnimateFromPhotoRequest& request, const PipelineCallbacks& callbacks) {
  return PhotoPersonAnimation(request, callbacks).Run();
}

}  // namespace bodyloom
