// SPDX-License-Identifier: Apache-2.0
// Tracks beside videos that are stored otherwise than they are to be seen: pixels that are not square, turned pictures,
// slow motion, a part of the clip. Videos of a person are skipped where the recordings or the networks are missing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "data_tools/formats/npz.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/load_detections.h"
#include "data_tools/observations/observations_npz.h"
#include "data_tools/observations/people_npz.h"
#include "pipelines/detect/detect_clip.h"
#include "pipelines/synthesis/synthesize_clip.h"
#include "pipelines/track/track_clip.h"
#include "tests/data_tools/video/clip_maker.h"
#include "tests/support/paths.h"
#include "tests/support/real_video.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::video_playback_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr int kFrames = 12, kFps = 15;

/// A person's joints, and a grey video of the same times in which pixels are `aspect` times as wide as high.
struct Clip {
  explicit Clip(double aspect) {
    SynthesizeClipRequest synth;
    synth.motion = {.name = "demo", .fps = kFps, .num_frames = kFrames};
    synth.out = folder / "clip";
    synth.clip.dense_per_frame = 0;
    const SynthClipFiles files = SynthesizeClip(synth).files;
    truth = files.truth;
    joints = KeypointsFromNpz(ReadNpz(files.observations), files.observations);
    width = joints.image_width, height = joints.image_height;
    stored_width = int(std::lround(width / aspect));
    video = folder / "video.mp4";
    Ffmpeg("-f lavfi -i color=c=gray:s=" + std::to_string(stored_width) + "x" + std::to_string(height) + ":r=" +
           std::to_string(kFps) + " -frames:v " + std::to_string(kFrames) + " -vf setsar=" + std::to_string(width) +
           "/" + std::to_string(stored_width) + " -c:v libx264 -pix_fmt yuv420p " + video);
  }

  /// The joints as a detector sees them that takes stored pixels for square ones; without the image's size on request,
  /// as most files of detectors have it.
  [[nodiscard]] std::string StoredJoints(bool with_size) const {
    KeypointSequence stored = joints;
    const double scale = double(stored_width) / width;
    for (Keypoint& point : stored.points) point.x = float((point.x + 0.5) * scale - 0.5);
    stored.image_width = with_size ? stored_width : 0;
    stored.image_height = with_size ? height : 0;
    const std::string path = folder / (with_size ? "stored.npz" : "stored_sizeless.npz");
    WriteObservations(path, &stored, nullptr);
    return path;
  }

  [[nodiscard]] std::string SquareJoints() const {
    const std::string path = folder / "square.npz";
    WriteObservations(path, &joints, nullptr);
    return path;
  }

  [[nodiscard]] TrackRequest RequestOf(const std::string& detections) const {
    TrackRequest request;
    request.detections = detections;
    request.video = video;
    request.use_lines = false;  // of which a grey video has none
    request.out = folder / "track.npz";
    return request;
  }

  ScratchFolder folder;
  KeypointSequence joints;
  int width = 0, height = 0, stored_width = 0;
  std::string video, truth;
};

double LargestDifference(const Track& a, const Track& b) {
  EXPECT_EQ(a.num_frames(), b.num_frames());
  double largest = 0;
  for (int t = 0; t < std::min(a.num_frames(), b.num_frames()); ++t) {
    largest = std::max(largest, (a.joints[size_t(t)] - b.joints[size_t(t)]).cwiseAbs().maxCoeff());
  }
  return largest;
}

TEST(VideoPlayback, DetectionsInStoredPixelsGiveTheTrackOfThoseInSquareOnes) {
  const Clip clip(4.0 / 3);
  TrackClip(clip.RequestOf(clip.SquareJoints()));
  const Track square = ReadTrack(clip.folder / "track.npz");
  EXPECT_EQ(square.camera.width, clip.width);
  for (const bool with_size : {true, false}) {
    std::vector<std::string> said;
    PipelineCallbacks callbacks;
    callbacks.message = [&](const std::string& text) { said.push_back(text); };
    TrackClip(clip.RequestOf(clip.StoredJoints(with_size)), callbacks);
    const Track stored = ReadTrack(clip.folder / "track.npz");
    EXPECT_EQ(stored.camera.width, clip.width);
    EXPECT_LT(LargestDifference(stored, square), 1e-3) << "metres";
    EXPECT_THAT(said, testing::Contains(HasSubstr("made in pixels that are not square")));
  }
  TrackRequest sized = clip.RequestOf(clip.StoredJoints(false));
  sized.image_width = clip.stored_width, sized.image_height = clip.height;
  TrackClip(sized);
  EXPECT_LT(LargestDifference(ReadTrack(sized.out), square), 1e-3) << "--image-size of the stored pixels";
}

TEST(VideoPlayback, ACalibrationOfStoredPixelsBecomesOneOfSquareOnes) {
  const Clip clip(4.0 / 3);
  const Camera truth = ReadTrack(clip.truth).camera;
  TrackRequest square = clip.RequestOf(clip.SquareJoints()), stored = clip.RequestOf(clip.StoredJoints(false));
  square.focal_px = truth.fx;
  const std::string calibration = clip.folder / "camera.json";
  const double scale = double(clip.stored_width) / clip.width;
  WriteFileAtomically(calibration, "{\"cameras\": [{\"name\": \"a\", \"width\": " + std::to_string(clip.stored_width) +
                                       ", \"height\": " + std::to_string(clip.height) + ", \"K\": [[" +
                                       std::to_string(truth.fx * scale) + ", 0, " +
                                       std::to_string(0.5 * clip.stored_width - 0.5) + "], [0, " +
                                       std::to_string(truth.fx) + ", " + std::to_string(0.5 * clip.height - 0.5) +
                                       "], [0, 0, 1]]}]}");
  stored.cameras = calibration;
  TrackClip(square);
  const Track by_square = ReadTrack(square.out);
  stored.overlay = clip.folder / "overlay.mp4";
  TrackClip(stored);
  const Track by_stored = ReadTrack(stored.out);
  EXPECT_EQ(by_stored.camera.width, clip.width);
  EXPECT_NEAR(by_stored.camera.fx, truth.fx, 1e-3);
  EXPECT_NEAR(by_stored.camera.cx, by_square.camera.cx, 1e-6);
  EXPECT_LT(LargestDifference(by_stored, by_square), 1e-3) << "metres";
  EXPECT_EQ(VideoReader(stored.overlay).info().width, clip.width) << "drawn over square pixels";
  stored.detections = clip.SquareJoints();
  stored.overlay = "";
  TrackClip(stored);
  EXPECT_LT(LargestDifference(ReadTrack(stored.out), by_square), 1e-3) << "square detections, stored calibration";
}

TEST(VideoPlayback, APartOfTheDetectionsIsTracked) {
  const Clip clip(1);
  TrackRequest request = clip.RequestOf(clip.SquareJoints());
  request.from_s = 2.0 / kFps;
  request.to_s = 6.0 / kFps;
  TrackClip(request);
  const Track part = ReadTrack(request.out);
  ASSERT_EQ(part.num_frames(), 5);
  EXPECT_NEAR(part.motion.timestamps.front(), 2.0 / kFps, 1e-9);
  KeypointSequence cut = clip.joints;
  cut.points = {cut.points.begin() + 2 * cut.num_points(), cut.points.begin() + 7 * cut.num_points()};
  cut.timestamps = {cut.timestamps.begin() + 2, cut.timestamps.begin() + 7};
  TrackRequest same = request;
  same.detections = clip.folder / "cut.npz";
  WriteObservations(same.detections, &cut, nullptr);
  same.from_s = 0, same.to_s = -1;
  TrackClip(same);
  EXPECT_EQ(LargestDifference(ReadTrack(same.out), part), 0);

  request.from_s = 5, request.to_s = 6;
  EXPECT_THAT([&] { TrackClip(request); }, ThrowsMessage<RequestError>(HasSubstr("holds none of the detections'")));
}

TEST(VideoPlayback, TheTrackNotesTurnAndSlowMotion) {
  const Clip clip(1);
  TrackRequest request = clip.RequestOf(clip.SquareJoints());
  request.captured_fps = 10.0 * kFps;
  TrackClip(request);
  const Track slow = ReadTrack(request.out);
  EXPECT_EQ(slow.playback, (VideoPlayback{0, 10}));
  request.turn_deg.reset();
  EXPECT_THAT([&] { TrackClip(request); }, ThrowsMessage<RequestError>(HasSubstr("--rotate auto asks the detector")));
  request.turn_deg = 45;
  EXPECT_THAT([&] { TrackClip(request); }, ThrowsMessage<RequestError>(HasSubstr("--rotate 45")));
  request.turn_deg = 180;
  request.video = "";
  EXPECT_THAT([&] { TrackClip(request); }, ThrowsMessage<RequestError>(HasSubstr("give --video")));
}

class PlaybackOfRealVideo : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string why = WhyNoDetection(squats_); !why.empty()) GTEST_SKIP() << why;
  }

  /// Nine frames of a woman who squats, changed by a filter of ffmpeg.
  [[nodiscard]] std::string Changed(const std::string& filter) const {
    const std::string path = folder_ / "changed.mp4";
    Ffmpeg("-i " + squats_ + " -t 1.7 -vf \"scale=-2:720," + filter + "\" -c:v libx264 -qp 12 -pix_fmt yuv420p " +
           path);
    return path;
  }

  [[nodiscard]] DetectClipRequest RequestOf(const std::string& video) const {
    DetectClipRequest request;
    request.detect.video = video;
    request.detect.detector.blazepose.network = PoseNetworkSize::kLite;
    request.out = folder_ / "detections.npz";
    return request;
  }

  const std::string squats_ = SharedDir() + "/data/tfjs_pose/pose_squats.mp4";
  const ScratchFolder folder_;
};

TEST_F(PlaybackOfRealVideo, TheTurnIsFoundByThePeople) {
  for (const auto& [filter, turn] : {std::pair("null", 0), std::pair("transpose=clock", 270),
                                     std::pair("transpose=cclock", 90), std::pair("hflip,vflip", 180)}) {
    DetectClipRequest request = RequestOf(Changed(filter));
    request.find_turn = true;
    std::vector<std::string> said;
    PipelineCallbacks callbacks;
    callbacks.message = [&](const std::string& text) { said.push_back(text); };
    const DetectClipReport report = DetectClip(request, callbacks);
    EXPECT_GT(report.height, report.width) << filter;
    EXPECT_THAT(said, testing::Contains(HasSubstr(turn == 0 ? "upright in it as it is"
                                                            : "clockwise by " + std::to_string(turn) + " degrees")))
        << filter;
  }
}

TEST_F(PlaybackOfRealVideo, SlowMotionHasTheTimesOfItsCapture) {
  DetectClipRequest request = RequestOf(squats_);
  request.detect.span.to_s = 1.9;
  request.detect.span.captured_fps = 50;
  DetectClip(request);
  const KeypointSequence found = LoadDetections(request.out);
  ASSERT_EQ(found.num_frames(), 10) << "the span is on the video's clock";
  EXPECT_NEAR(found.timestamps[9], 9.0 / 50, 1e-6);
}

TEST_F(PlaybackOfRealVideo, SmallPeopleAreLookedForWhenNobodyIsFound) {
  const DetectClipReport report = DetectClip(RequestOf(Changed("scale=-2:60,pad=1080:1080:520:700:0x607060")));
  ASSERT_TRUE(report.landmarks);
  ASSERT_EQ(report.landmarks->people.size(), 1U);
  EXPECT_NEAR(report.landmarks->people[0].height_px, 45, 15);
}

}  // namespace
}  // namespace bodyloom::video_playback_test
