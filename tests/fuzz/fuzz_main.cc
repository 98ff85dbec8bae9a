// SPDX-License-Identifier: Apache-2.0
/// The libFuzzer program of all targets; BODYLOOM_FUZZ_TARGET selects one. It is a single program because compiling the
/// readers' headers 25 times took longer than fuzzing them.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/fuzz/fuzz_array_targets.h"
#include "tests/fuzz/fuzz_file_targets.h"
#include "tests/fuzz/fuzz_network_targets.h"
#include "tests/fuzz/fuzz_run_targets.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/fuzz/fuzz_text_targets.h"

namespace bodyloom::fuzz {
namespace {

struct Target {
  const char* name;  ///< of its seeds too (tests/data_tools/fuzz/fuzz_seeds.h)
  bool (*accepts)(const std::string&);
};

constexpr Target kTargets[] = {{"npz", AcceptsNpz},
                               {"pickle", AcceptsPickle},
                               {"weights", AcceptsWeights},
                               {"body", AcceptsBody},
                               {"track", AcceptsTrack},
                               {"obj", AcceptsObj},
                               {"detections", AcceptsDetections},
                               {"deeplabcut", AcceptsDeepLabCut},
                               {"videopose3d", AcceptsVideoPose3d},
                               {"cameras", AcceptsCameras},
                               {"rig", AcceptsRig},
                               {"camera_path", AcceptsCameraPath},
                               {"bvh", AcceptsBvh},
                               {"asf_amc", AcceptsAsfAmc},
                               {"deepmimic", AcceptsDeepMimic},
                               {"cage", AcceptsCage},
                               {"observations", AcceptsObservations},
                               {"part_labels", AcceptsPartLabels},
                               {"avatar", AcceptsAvatar},
                               {"pose_prior", AcceptsPosePrior},
                               {"lifter", AcceptsLifter},
                               {"parser", AcceptsParser},
                               {"left_half", AcceptsLeftHalf},
                               {"motion", AcceptsMotion},
                               {"detections_file", AcceptsDetectionsFile},
                               {"estimate", AcceptsEstimate},
                               {"video_truth", AcceptsVideoTruth},
                               {"rich", AcceptsRich},
                               {"human36m", AcceptsHuman36m},
                               {"image", AcceptsImage},
                               {"video", AcceptsVideo},
                               {"single_person_dataset", AcceptsSinglePersonDataset},
                               {"split", AcceptsSplit},
                               {"mat", AcceptsMat},
                               {"run_config", AcceptsRunConfig},
                               {"relight", AcceptsRelight},
                               {"manifest", AcceptsManifest},
                               {"clip_record", AcceptsClipRecord},
                               {"tflite", AcceptsTflite},
                               {"onnx", AcceptsOnnx},
                               {"keypoint_outputs", AcceptsKeypointOutputs}};

const Target& Chosen() {
  static const Target& chosen = [&]() -> const Target& {
    const char* name = std::getenv("BODYLOOM_FUZZ_TARGET");
    for (const Target& target : kTargets) {
      if (name != nullptr && std::string(name) == target.name) return target;
    }
    std::fprintf(stderr, "BODYLOOM_FUZZ_TARGET is '%s', expected one of:", name == nullptr ? "" : name);
    for (const Target& target : kTargets) std::fprintf(stderr, " %s", target.name);
    std::fprintf(stderr, "\n");
    std::exit(2);
  }();
  return chosen;
}

}  // namespace
}  // namespace bodyloom::fuzz

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  bodyloom::fuzz::Chosen();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  bodyloom::fuzz::Chosen().accepts(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
