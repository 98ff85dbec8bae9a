// SPDX-License-Identifier: Apache-2.0
// Synthesises, tracks and describes a clip using only the installed files.
#include <iostream>
#include <vector>

#include "bodyloom/data_tools/body/builtin_body.h"
#include "bodyloom/data_tools/synthesis/clips/demo_motion.h"
#include "bodyloom/data_tools/synthesis/clips/synth_clip.h"
#include "bodyloom/render/uv_maps/descriptor_frames.h"
#include "bodyloom/tracking/track_sequence.h"

int main() {
  const bodyloom::BodyModel& body = bodyloom::BuiltinBody();
  const bodyloom::SynthClip clip = bodyloom::MakeSynthClip(body, bodyloom::DemoMotion(body, 12, 30));
  bodyloom::TrackSequenceInput input;
  input.keypoints = &clip.keypoints;
  input.camera = clip.truth.camera;
  const auto [track, summary] = bodyloom::TrackSequence(input);
  bodyloom::DescriptorFrames frames(body, track);
  std::vector<float> planes(frames.frame_size());
  frames.Planes(5, planes);
  std::cout << summary.BriefReport() << "\n" << frames.channels() << " planes of a frame\n";
  return summary.IsUsable() && track.num_frames() == 12 && frames.channels() == 33 ? 0 : 1;
}
