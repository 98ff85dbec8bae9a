// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/pose_detector.h"

#include <utility>

#include "tracking/detection/inference/graph_executor.h"
#include "tracking/detection/inference/tflite_reader.h"
#include "tracking/detection/model_files.h"
#include "tracking/detection/person_detection.h"

namespace bodyloom {
namespace {

/// Indices of the landmark network's outputs.
enum LandmarkOutput { kLandmarks, kPresence, kMask, kHeatmaps, kWorld };

struct NetworkOfSize {
  const char *name, *file;
};
/// In the order of PoseNetworkSize.
constexpr NetworkOfSize kNetworks[] = {
    {"lite", kPoseLandmarkLiteFile}, {"full", kPoseLandmarkFullFile}, {"heavy", kPoseLandmarkHeavyFile}};

const NetworkOfSize& NetworkOf(PoseNetworkSize size) { return kNetworks[static_cast<size_t>(size)]; }

}  // namespace

std::string ToText(PoseNetworkSize size) { return NetworkOf(size).name; }

class PoseModels {
 public:
  PoseModels(OperatorGraph people, OperatorGraph landmarks)
      : people(std::move(people)), landmarks(std::move(landmarks)) {}
  OperatorGraph people, landmarks;
};

std::shared_ptr<const PoseModels> ReadPoseModels(const std::string& folder, PoseNetworkSize size) {
  constexpr size_t n = kPoseNetworkLandmarks;
  return std::make_shared<PoseModels>(ReadImageNetwork(FindModelFile(kPoseDetectorFile, folder), kPersonDetectorSize,
                                                       {size_t(kPersonDetectorAnchors) * 12, kPersonDetectorAnchors}),
                                      ReadImageNetwork(FindModelFile(NetworkOf(size).file, folder), kPoseNetworkSize,
                                                       {n * 5, 1, size_t(kPoseNetworkSize) * kPoseNetworkSize,
                                                        n * kPoseHeatmapSize * kPoseHeatmapSize, n * 3}));
}

class PoseDetector::Networks {
 public:
  Networks(const PoseModels& models, bool with_mask)
      : with_mask_(with_mask),
        people_(models.people),
        landmarks_(models.landmarks, {},
                   with_mask ? std::vector<int>{kLandmarks, kPresence, kHeatmaps, kWorld, kMask}
                             : std::vector<int>{kLandmarks, kPresence, kHeatmaps, kWorld}) {}

  std::vector<PoseRegion> FindPeople(const Image& image, const PoseRegion& square, double min_score) {
    const std::vector<GraphTensor> outputs =
        people_.Run(CropRegion(image, square, kPersonDetectorSize, 2.0F / 255, -1));
    std::vector<PoseRegion> regions;
    for (const PersonDetection& person : DecodePersonDetections(outputs[0].floats, outputs[1].floats, min_score)) {
      const PoseRegion region =
          RegionAroundBody(square.ImageFromFraction(person.points[0]), square.ImageFromFraction(person.points[1]));
      if (region.IsValid()) regions.push_back(region);
    }
    return regions;
  }

  DetectedPose PoseIn(const Image& image, const PoseRegion& region, bool with_mask) {
    with_mask = with_mask && with_mask_;
    const std::vector<GraphTensor> outputs =
        landmarks_.Run(CropRegion(image, region, kPoseNetworkSize, 1.0F / 255, 0), with_mask ? kOutputs : kOutputs - 1);
    return DecodePose({.landmarks = outputs[0].floats,
                       .presence = outputs[1].floats[0],
                       .mask = with_mask ? std::span<const float>(outputs[4].floats) : std::span<const float>(),
                       .heatmaps = outputs[2].floats,
                       .world = outputs[3].floats},
                      region, image.width, image.height);
  }

 private:
  static constexpr int kOutputs = 5;  ///< the mask is the last
  bool with_mask_;
  GraphExecutor people_, landmarks_;
};

PoseDetector::PoseDetector(const std::shared_ptr<const PoseModels>& models, bool with_mask)
    : networks_(std::make_unique<Networks>(*models, with_mask)) {}
PoseDetector::PoseDetector(const PoseDetector& other) : networks_(std::make_unique<Networks>(*other.networks_)) {}
PoseDetector::~PoseDetector() = default;
PoseDetector::PoseDetector(PoseDetector&&) noexcept = default;
PoseDetector& PoseDetector::operator=(PoseDetector&&) noexcept = default;

std::vector<PoseRegion> PoseDetector::FindPeople(const Image& image, const PoseRegion& square, double min_score) {
  return networks_->FindPeople(image, square, min_score);
}

DetectedPose PoseDetector::PoseIn(const Image& image, const PoseRegion& region, bool with_mask) {
  return networks_->PoseIn(image, region, with_mask);
}

}  // namespace bodyloom
