// SPDX-License-Identifier: Apache-2.0
#include "pipelines/live/run_live.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "data_tools/body/body_io.h"
#include "data_tools/export/export_scene.h"
#include "data_tools/export/vmc_sender.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/video/video_reader.h"
#include "data_tools/video/video_writer.h"
#include "geometry/base/check.h"
#include "pipelines/track/track_request.h"
#include "tests/data_tools/export/osc_twin.h"
#include "tests/data_tools/video/tcp_source.h"
#include "tests/pipelines/live/live_states.h"
#include "tests/support/scratch_folder.h"
#include "tracking/live/live_tracker.h"

namespace bodyloom::run_live_test {
namespace {

using Json = nlohmann::json;

constexpr int kWidth = 96, kHeight = 128, kFrames = 40;

/// A clip of grey frames, in which the detector of the request sees the waving toy body all the same.
class RunLiveTest : public ::testing::Test {
 protected:
  RunLiveTest() {
    VideoWriter writer(folder_ / "clip.mp4", kWidth, kHeight, 30);
    for (int t = 0; t < kFrames; ++t) writer.Write(Image(kWidth, kHeight, {uint8_t(4 * t), 90, 90}));
    writer.Finish();
    SaveBodyCompact(folder_ / "toy.npz", ToyBodyData());
    request_.track.video = folder_ / "clip.mp4";
    request_.track.body = folder_ / "toy.npz";
    request_.make_detector = [] { return std::make_unique<KnowingDetector>(); };
    request_.video.pace = 0;
  }

  /// The frames of LiveTracker fed directly.
  [[nodiscard]] std::vector<LiveFrame> Direct() const {
    const BodyModel body = LoadBody(request_.track.body);
    const PosePrior prior = BuiltinPosePrior();
    const LifterWeights lifter = BuiltinLifter();
    LiveTrackerInput input;
    input.body = &body;
    input.prior = &prior;
    input.lifter = &lifter;
    input.camera.width = kWidth;
    input.camera.height = kHeight;
    input.landmarks = Coco17().names;
    LiveTrackerOptions options;
    options.lag = request_.lag;
    options.solve.num_threads = 1;
    options.solve.camera_knowledge = CameraKnowledge::kUnknownFocal;
    options.solve.straight_knees_weight = kStraightKnees;
    LiveTracker tracker(input, options);
    VideoReader reader(request_.track.video);
    std::vector<LiveFrame> frames;
    Image image;
    for (int t = 0; reader.Read(&image); ++t) {
      LiveObservations seen;
      seen.timestamp = reader.frame_time();
      seen.keypoints = WavingLandmarks(t, kWidth, kHeight);
      if (auto frame = tracker.Push(seen)) frames.push_back(std::move(*frame));
    }
    for (LiveFrame& frame : tracker.Finish()) frames.push_back(std::move(frame));
    return frames;
  }
  ScratchFolder folder_;
  RunLiveRequest request_;
};

TEST_F(RunLiveTest, GivesThePosesOfTheTracker) {
  std::vector<LiveState> states;
  request_.on_frame = [&](const LiveState& state) { states.push_back(state); };
  const RunLiveReport report = RunLive(request_);
  const std::vector<LiveFrame> expected = Direct();
  ASSERT_EQ(expected.size(), size_t(kFrames));
  ASSERT_EQ(states.size(), expected.size());
  int tracked = 0;
  for (size_t t = 0; t < expected.size(); ++t) {
    const LiveFrame& frame = states[t].frame;
    EXPECT_EQ(frame.index, expected[t].index);
    EXPECT_EQ(frame.timestamp, expected[t].timestamp);
    EXPECT_EQ(frame.status, expected[t].status);
    if (frame.status == FrameStatus::kLost) continue;
    EXPECT_EQ(frame.state.translation, expected[t].state.translation) << t;
    EXPECT_EQ(frame.state.rotations, expected[t].state.rotations) << t;
    EXPECT_EQ(frame.betas, expected[t].betas) << t;
    EXPECT_GT(states[t].delay_ms, 0);
    tracked += frame.status == FrameStatus::kTracked;
  }
  EXPECT_GT(tracked, kFrames / 2);
  EXPECT_EQ(report.frames, kFrames);
  EXPECT_EQ(report.poses, kFrames);
  EXPECT_EQ(report.dropped + report.late, 0);
  EXPECT_EQ(report.tracked + report.interpolated + report.lost, kFrames);
  EXPECT_EQ(report.width, kWidth);
  EXPECT_LE(report.delay.median, report.delay.most);
}

TEST_F(RunLiveTest, WritesALineOfJsonForEachFrame) {
  std::vector<LiveState> states;
  request_.on_frame = [&](const LiveState& state) { states.push_back(state); };
  request_.jsonl = folder_ / "poses.jsonl";
  RunLive(request_);
  std::istringstream lines(ReadFileBytes(request_.jsonl));
  std::string line;
  size_t t = 0;
  for (; std::getline(lines, line); ++t) {
    ASSERT_LT(t, states.size());
    EXPECT_EQ(line, LiveJson(states[t])) << t;
    EXPECT_EQ(Json::parse(line)["frame"], t);
  }
  EXPECT_EQ(t, size_t(kFrames));
}

TEST_F(RunLiveTest, SendsVmcFromWhereThePersonWasFirst) {
  const UdpReceiver receiver;
  request_.osc = receiver.address();
  std::vector<LiveState> states;
  std::vector<OscMessage> messages;
  request_.on_frame = [&](const LiveState& state) {
    states.push_back(state);
    for (OscMessage& message : receiver.Receive()) messages.push_back(std::move(message));
  };
  RunLive(request_);
  for (OscMessage& message : receiver.Receive()) messages.push_back(std::move(message));
  std::vector<OscMessage> hips;
  for (const OscMessage& message : messages) {
    if (!message.strings.empty() && message.strings[0] == "Hips") hips.push_back(message);
  }
  size_t posed = 0;
  std::optional<Eigen::Vector3d> first;
  for (const LiveState& state : states) {
    if (!state.HasPose()) continue;
    ASSERT_LT(posed, hips.size());
    const Eigen::Vector3d pelvis = state.world.PointFromCamera(state.joints.row(0).transpose());
    if (!first) first = Eigen::Vector3d(pelvis.x(), 0, pelvis.z());
    const Eigen::Vector3d expected = UnityPosition(pelvis - *first);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(hips[posed].numbers[k], expected[k], 1e-5);
    ++posed;
  }
  EXPECT_EQ(posed, hips.size());
  EXPECT_GT(posed, size_t(kFrames / 2));
}

TEST_F(RunLiveTest, EndsWhenItIsToldTo) {
  request_.video.pace = 1e-6;  // the second frame is hours away
  std::atomic<int> calls = 0;
  PipelineCallbacks callbacks;
  callbacks.progress = [&](const std::string&, double) { return ++calls < 2; };
  const RunLiveReport report = RunLive(request_, callbacks);
  EXPECT_EQ(report.poses, report.frames);
  EXPECT_LE(report.frames, 1);
}

TEST_F(RunLiveTest, EndsAfterTheSecondsAskedFor) {
  request_.max_seconds = 0.5;
  EXPECT_EQ(RunLive(request_).poses, 16);  // at 0, 1/30, … 15/30
}

TEST_F(RunLiveTest, PassesFramesOverRatherThanFallBehind) {
  // A detector that lets the clip arrive while it looks at its first frame.
  class WaitingDetector : public KnowingDetector {
   public:
    WaitingDetector(const std::atomic<bool>* go, std::vector<int>* reds) : go_(go), reds_(reds) {}
    std::vector<std::vector<FramePerson>> Detect(std::span<const Image> frames,
                                                 std::span<const FrameParts> /*parts*/) override {
      while (!*go_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      reds_->push_back(frames[0].at(kWidth / 2, kHeight / 2).red);  // four times the frame's number
      return KnowingDetector::Detect(frames, {});
    }

   private:
    const std::atomic<bool>* go_;
    std::vector<int>* reds_;
  };
  std::atomic<bool> go = false;
  std::vector<int> reds;
  request_.make_detector = [&] { return std::make_unique<WaitingDetector>(&go, &reds); };
  request_.video.pace = 30;  // the clip takes a twentieth of a second, and the detector two with its first frame
  PipelineCallbacks callbacks;
  std::atomic<int> polls = 0;
  callbacks.progress = [&](const std::string&, double) {
    if (++polls > 40) go = true;
    return true;
  };
  std::vector<int64_t> indices;
  std::vector<double> seconds;
  request_.on_frame = [&](const LiveState& state) {
    indices.push_back(state.frame.index);
    seconds.push_back(state.frame.timestamp);
  };
  const RunLiveReport report = RunLive(request_, callbacks);
  EXPECT_EQ(report.frames, kFrames);
  EXPECT_EQ(report.poses + report.dropped + report.late, kFrames);
  EXPECT_GT(report.dropped + report.late, 0);
  EXPECT_TRUE(std::is_sorted(seconds.begin(), seconds.end()));
  // After the first frame the newest is looked at, not the second.
  ASSERT_GE(reds.size(), 1u);
  EXPECT_TRUE(reds.size() == 1 || reds[1] > 20) << reds[1];
  for (size_t i = 0; i < indices.size(); ++i) EXPECT_EQ(indices[i], int64_t(i));
}

TEST_F(RunLiveTest, GoesOnWhenALostStreamIsFoundAgain) {
  ASSERT_EQ(std::system(
                ("ffmpeg -nostdin -v error -y -i " + request_.track.video + " -c:v mpeg2video " + (folder_ / "clip.ts"))
                    .c_str()),
            0);
  const TcpSource source(ReadFileBytes(folder_ / "clip.ts"));
  request_.track.video = source.url();
  request_.video.pace = 1;
  request_.video.retry_s = 0.01;
  std::atomic<int> found = 0;
  PipelineCallbacks callbacks;
  std::vector<std::string> messages;
  callbacks.message = [&](const std::string& line) {
    messages.push_back(line);
    if (line.ends_with("found again")) ++found;
  };
  callbacks.progress = [&](const std::string&, double) { return found < 2; };
  double last = -1;
  request_.on_frame = [&](const LiveState& state) {
    EXPECT_GT(state.frame.timestamp, last);
    last = state.frame.timestamp;
  };
  const RunLiveReport report = RunLive(request_, callbacks);
  EXPECT_GE(report.losses, 2);
  EXPECT_EQ(report.poses + report.dropped + report.late, report.frames);
  EXPECT_GT(report.poses, 0);
  ASSERT_GE(messages.size(), 4u);
  EXPECT_EQ(messages[0], source.url() + ": the source ended; looking for it");
  EXPECT_EQ(messages[1], source.url() + ": found again");
}

TEST_F(RunLiveTest, RefusesWhatItCannotDo) {
  const auto refuses = [&](const char* words) {
    EXPECT_THAT([&] { RunLive(request_); }, testing::ThrowsMessage<RequestError>(testing::HasSubstr(words)));
  };
  request_.lag = 61;
  refuses("a lag of 61 frames");
  request_.lag = 2;
  request_.track.stature_m = 1.8;
  refuses("--stature");
  request_.track.stature_m = 0;
  request_.jsonl = request_.track.video;
  EXPECT_THROW(RunLive(request_), RequestError);
  request_.jsonl = "";
  request_.track.turn_deg.reset();
  refuses("--rotate auto");
  request_.track.turn_deg = 0;
  request_.track.video = "";
  refuses("the source is required");
  request_.track.video = folder_ / "toy.npz";
  EXPECT_THROW(RunLive(request_), std::runtime_error);
}

TEST(LiveJson, SaysWhatIsKnown) {
  const LiveState state = ToyState(7);
  const Json json = Json::parse(LiveJson(state));
  EXPECT_EQ(json["frame"], 7);
  EXPECT_EQ(json["status"], "tracked");
  EXPECT_EQ(json["delay_ms"], 100);
  EXPECT_EQ(json["dropped"], 3);
  ASSERT_EQ(json["poses"].size(), 72u);
  Eigen::VectorXd poses(72);
  for (int i = 0; i < 72; ++i) poses[i] = json["poses"][i].get<double>();
  const BodyPose again = PoseFromAxisAngle(
      *state.body, poses,
      {json["trans"][0].get<double>(), json["trans"][1].get<double>(), json["trans"][2].get<double>()});
  const MatrixX3d joints = PoseSkeleton(*state.body, state.rest_joints, again).joints;
  for (int j = 0; j < 24; ++j) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(json["joints"][j][k].get<double>(), state.joints(j, k), 1e-5);
      EXPECT_NEAR(joints(j, k), state.joints(j, k), 2e-4);
    }
  }
  EXPECT_EQ(json["camera"]["fx"], 600);
  EXPECT_EQ(json["world"]["source"], "level camera assumed");
  EXPECT_EQ(json["world"]["translation"], Json::parse("[0, 1.5, 0]"));
  EXPECT_EQ(json["world"]["rotation"], Json::parse("[[1,0,0],[0,-1,0],[0,0,-1]]"));
}

TEST(LiveJson, OfSomebodyLostHasNoPose) {
  const std::string line = LiveJson(ToyState(7, true));
  const Json json = Json::parse(line);
  EXPECT_EQ(json["status"], "lost");
  for (const char* name : {"poses", "trans", "betas", "joints", "joint_sigma"})
    EXPECT_TRUE(json[name].is_null()) << name;
  EXPECT_EQ(line.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace bodyloom::run_live_test
