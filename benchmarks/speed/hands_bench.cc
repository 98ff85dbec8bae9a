// SPDX-License-Identifier: Apache-2.0
/// Time of a hand (narrowing its region, two looks) and of a face (two looks), crops included: the least of many runs
/// on one thread, so that other programs of the machine matter little. `bodyloom_bench_hands [MODELS]`: the folder of
/// the networks, when they are not where the build looks. Their errors: benchmarks/accuracy/hands.py.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <functional>
#include <string>

#include "geometry/base/stopwatch.h"
#include "render/image/image.h"
#include "tracking/detection/face_landmarks.h"
#include "tracking/detection/hand_landmarks.h"

namespace bodyloom {
namespace {

double LeastMs(const std::function<void()>& run) {
  constexpr int kRuns = 300;
  double least = 1e9;
  for (int i = 0; i < kRuns; ++i) {
    const Stopwatch watch;
    run();
    least = std::min(least, 1000 * watch.seconds());
  }
  return least;
}

void Measure(const std::string& models) {
  const HandDetector hands(models);
  const FaceDetector faces(models);
  Image image(1920, 1080);
  for (size_t i = 0; i < image.bgr.size(); ++i) image.bgr[i] = uint8_t(i * 2654435761U >> 24);
  const PoseRegion region{.centre = {960, 540}, .side = 200, .rotation = 0.4};
  double presence = 0;
  const double hand = LeastMs([&] {
    const PoseRegion narrowed = hands.Narrowed(image, region).value_or(region);
    presence += hands.HandIn(image, narrowed).presence + hands.HandIn(image, region).presence;
  });
  const double face =
      LeastMs([&] { presence += faces.FaceIn(image, region).presence + faces.FaceIn(image, region).presence; });
  std::printf("hand %.2f ms, face %.2f ms (presence %.3f)\n", hand, face, presence);
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  try {
    bodyloom::Measure(argc > 1 ? argv[1] : "");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
